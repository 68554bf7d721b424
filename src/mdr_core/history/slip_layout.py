"""Columns of the vertices of a polyline, and places on the stack of `slip_kernel`."""

# The first columns are the sums normal + anchor and normal - anchor, as unevaluated sums high + low
# of two doubles; from this one on, their low parts.
LOW = 2
# Normal coordinate.
NORMAL = 4
# Growth of both sums over the segment below the vertex.
GROWTH = 5
# Growth of the anchor, which a difference of both would lose where it is small.
ANCHOR = 7
# Load step that laid the segment.
STEP = 8
# Number of columns.
COLUMNS = 9
# Place of the load point's mirror image.
MIRROR = 2
# Place of the vertex on the axis.
AXIS = 3
