"""Endpoints, one short function each."""
