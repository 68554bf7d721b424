"""Singular integrals: the two-root rule, the transforms of tables and the displacements."""
