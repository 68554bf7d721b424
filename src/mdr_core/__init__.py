"""The physics of MDR: contact of axisymmetric bodies by their one-dimensional image."""
