"""Columns of the vertices of a polyline."""

# Normal coordinate.
NORMAL = 2
# Slope of the anchor on the segment below the vertex.
SLOPE = 3
# Number of columns, of which the first are the sums normal + anchor and normal - anchor.
COLUMNS = 4
