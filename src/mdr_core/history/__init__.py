"""Any history of normal and tangential load, exactly: memory in the depth coordinate."""

from mdr_core.history.cycles import Cycles, cycles
from mdr_core.history.solution import History, solve
from mdr_core.history.state import State, advance, unloaded

__all__ = ["Cycles", "History", "State", "advance", "cycles", "solve", "unloaded"]
