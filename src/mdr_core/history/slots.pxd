# The numbers of slots.py, as constants for the compiler.

cdef enum:
    FORWARD = 0
    BACKWARD = 1
    LOW = 2
    GROWTH = 4
    STILL = 0
    NUMBER = 1
    NEITHER = 2
    POINT = 0
    CORNER = 1
    MIRROR = 2
    AXIS = 3
    LEVEL = 0
    SPAN = 1
    SLIP = 2
    UPPER_GAP = 3
    LOWER_GAP = 4
