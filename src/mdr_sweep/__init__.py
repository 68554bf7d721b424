"""Parameter studies over millions of cases, on one machine or on a cluster."""
