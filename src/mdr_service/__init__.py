"""HTTP service for :mod:`mdr_core`, which holds all physics."""
