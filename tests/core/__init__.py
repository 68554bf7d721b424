"""Tests of the core against the reference banks and against general laws."""
