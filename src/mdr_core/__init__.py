"""The physics of MDR: contact of axisymmetric bodies by their one-dimensional image."""

from typing import Final

__version__: Final = "0.1.0"
