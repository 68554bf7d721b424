"""Numbers that sources print."""

from typing import Final

# Pastewka, Sanner et al., ContactMechanics: test_Hertz_refVals, E* = 5, R = 4, F = 7.
HERTZ_STORED: Final = {
    "indentation_depth": 0.6507879989531481,
    "contact_radius": 1.6134286460245437,
    "maximum_pressure": 1.2839257217043503,
}
