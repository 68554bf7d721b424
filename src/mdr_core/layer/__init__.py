"""Normal and adhesive contact of any profile with an elastic layer on a rigid base."""

from mdr_core.layer.contact import LayerContact
from mdr_core.layer.curve import DepthCurve
from mdr_core.layer.solver import solve
from mdr_core.materials import Layer

__all__ = ["DepthCurve", "Layer", "LayerContact", "solve"]
