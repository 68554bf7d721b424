"""Queries about oblique impacts."""

from mdr_core import impact
from mdr_core.impact import Impact
from mdr_service.queries.contacts import body, friction
from mdr_service.schemas.impacts import ImpactQuery


def solve_impact(query: ImpactQuery) -> Impact:
    """Compute the rebound of bodies that hit each other with normal and tangential velocities.

    The normal motion is elastic, and the tangential force follows from the slip memory of the
    whole contact. Masses are effective masses of the contact point: m and 2/7 m for a solid sphere.
    Every list of the response has one entry per impact. Samples are doubled until `error_estimate`
    is below `rtol`; it is an estimate, relative to the larger tangential velocity, before or after
    the impact, and its energy.
    """
    motion = query.model_dump(exclude={"profile", "material", "friction_coefficient"})
    return impact.solve(**body(query), **friction(query), **motion)
