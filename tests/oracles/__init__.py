"""Reference values in high precision, computed from the definitions without the product."""
