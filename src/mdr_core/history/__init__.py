"""Load histories of normal and tangential load, with the slip memory of the contact."""

from mdr_core.history.contact_state import ContactState, advance, unloaded
from mdr_core.history.contact_states import ContactStates, advance_many, join, unloaded_many
from mdr_core.history.cycles import LoadCycles, cycles
from mdr_core.history.solver import LoadHistory, solve

__all__ = [
    "ContactState",
    "ContactStates",
    "LoadCycles",
    "LoadHistory",
    "advance",
    "advance_many",
    "cycles",
    "join",
    "solve",
    "unloaded",
    "unloaded_many",
]
