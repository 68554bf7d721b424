"""HTTP service for :mod:`mdr_core`, which contains all physics."""
