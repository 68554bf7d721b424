"""HTTP service for :mod:`mdr_core`, without physics of its own."""
