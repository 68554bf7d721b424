"""Expected values in high precision, computed from the definitions and never from the product."""
