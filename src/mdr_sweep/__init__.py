"""Sweeps over millions of scenes: the service's answers, on one machine or many."""
