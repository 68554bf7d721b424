"""What the wire accepts and returns: names, bounds, dimensions, examples."""
