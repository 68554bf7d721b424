"""Fretting wear: the shape that a partially slipping contact wears down to, and the way there."""
