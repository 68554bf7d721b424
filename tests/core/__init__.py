"""The core against the bank of expected answers, and against the laws every answer obeys."""
