"""Load histories of normal and tangential load, with the slip memory of the contact."""

from mdr_core.history.contact_state import ContactState, advance, unloaded
from mdr_core.history.cycles import LoadCycles, cycles
from mdr_core.history.solver import LoadHistory, solve

__all__ = ["ContactState", "LoadCycles", "LoadHistory", "advance", "cycles", "solve", "unloaded"]
