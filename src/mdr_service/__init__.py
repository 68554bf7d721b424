"""The wire: HTTP in front of :mod:`mdr_core`; no physics and no arithmetic live here."""
