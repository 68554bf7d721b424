"""Response formats: each writes a complete result and computes nothing."""
