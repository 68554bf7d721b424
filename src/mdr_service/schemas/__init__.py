"""Requests and responses: names, bounds, dimensions and examples."""
