"""Torsion: twist of a contact with slip, and its cycles."""

from mdr_core.torsion.contact import TorsionalContact, solve
from mdr_core.torsion.cycle import TorsionCycle, cycle

__all__ = ["TorsionCycle", "TorsionalContact", "cycle", "solve"]
