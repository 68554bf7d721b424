"""Answers as pictures (SVG), for people who look rather than read."""

from mdr_service.pictures.canvas import MEDIA_TYPE
from mdr_service.pictures.fields import stress
from mdr_service.pictures.loops import history
from mdr_service.pictures.push import tangential
from mdr_service.pictures.wear import evolution, wear

__all__ = ["MEDIA_TYPE", "evolution", "history", "stress", "tangential", "wear"]
