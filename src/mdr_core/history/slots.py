"""Where `walk` keeps its numbers; the same stands in slots.pxd, for the compiler."""

# Numbers of a vertex on the stack, which has eight: both sums, their lower parts, and what each
# sum grows by from the vertex below.
FORWARD = 0
BACKWARD = 1
LOW = 2
GROWTH = 4
# Marks of a vertex, which has two: which sum stands still on the piece below it, and its number.
STILL = 0
NUMBER = 1
NEITHER = 2
# Places on the stack: the load point of the step, the corner that is noted, and below the axis
# the load point's mirror image, on whose face the polyline begins where everything slips.
POINT = 0
CORNER = 1
MIRROR = 2
AXIS = 3
# Rows of the pieces.
LEVEL = 0
SPAN = 1
SLIP = 2
UPPER_GAP = 3
LOWER_GAP = 4
