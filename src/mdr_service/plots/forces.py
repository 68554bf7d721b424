"""Force over depth or displacement."""

from dataclasses import replace
from typing import Final

import numpy as np

from mdr_core import tangential as tangential_contact
from mdr_core.history import LoadHistory
from mdr_core.normal import NormalContact
from mdr_core.tangential import TangentialContact
from mdr_core.typing import Array
from mdr_service.plots.plot import (
    LABELS,
    MAX_CURVES,
    POINTS,
    VISIBLE,
    Curve,
    Mark,
    Panel,
    Plot,
    subset_note,
    symbol,
)
from mdr_service.queries.load_paths import solve_path
from mdr_service.results import Result
from mdr_service.schemas.contacts import NormalQuery, TangentialQuery
from mdr_service.schemas.load_paths import HistoryQuery

# Samples of all steps of a history, at an accuracy that paper does not show.
_MAX_SAMPLES: Final = 2_000
# Relative difference of forces that are drawn as one.
_COINCIDE: Final = 0.01
# The limiting force is drawn where the force exceeds this share of it.
_NEAR_LIMIT: Final = 0.6
# The curve ends at this multiple of the displacement at which full slip begins.
_INTO_SLIP: Final = 1.1


def normal(_query: NormalQuery, contact: NormalContact, result: Result) -> Plot:
    """Return force over depth from first contact to the largest load."""
    first = float(np.ravel(contact.profile.first_coordinate)[0])
    coordinate = np.linspace(first, float(np.max(contact.coordinate)), POINTS)
    dense = replace(contact, coordinate=coordinate)
    curve = Curve(
        np.append(0.0, dense.indentation_depth),
        np.append(0.0, dense.normal_force),
        point_x=np.ravel(result["indentation_depth"]),
        point_y=np.ravel(result["normal_force"]),
    )
    panel = Panel(LABELS["normal_force"], [curve])
    return Plot(LABELS["indentation_depth"], [panel], points_label="requested loads")


def tangential(_query: TangentialQuery, contact: TangentialContact, result: Result) -> Plot:
    """Return force over displacement into full slip, for each normal force."""
    x, y, normal_force = (
        np.ravel(result[name])
        for name in ("tangential_displacement", "tangential_force", "normal_force")
    )
    coordinates = np.broadcast_to(np.ravel(contact.normal.coordinate), x.shape)
    forces, first = np.unique(normal_force, return_index=True)
    curves, marks = [], []
    for index, (force, at) in enumerate(zip(forces[:MAX_CURVES], first, strict=False)):
        own = normal_force == force
        dense = _into_full_slip(contact, float(coordinates[at]), x[own])
        label = f"{symbol('normal_force')} = {force:.4g}"
        curve = Curve(dense.tangential_displacement, dense.tangential_force, label, x[own], y[own])
        curves.append(curve)
        marks += _friction_limits(float(np.max(dense.limiting_force)), curve.y, index)
    return Plot(
        LABELS["tangential_displacement"],
        [Panel(LABELS["tangential_force"], curves, marks=marks)],
        points_label="requested loads",
        note=subset_note(len(curves), forces.size, "normal forces"),
    )


def history(query: HistoryQuery, path: LoadHistory, result: Result) -> Plot:
    """Return force over displacement from first contact to the end, with the turning points."""
    given = query.path
    ends = slice(given.samples_per_step - 1, None, given.samples_per_step)
    x, y, normal_force = (
        result[name][ends]
        for name in ("tangential_displacement", "tangential_force", "normal_force")
    )
    dense = _dense_path(query, path)
    curve = Curve(
        np.append(0.0, dense.tangential_displacement),
        np.append(0.0, dense.tangential_force),
        point_x=x,
        point_y=y,
    )
    marks: list[Mark] = []
    if np.ptp(normal_force) <= _COINCIDE * normal_force.max():
        marks = _friction_limits(query.friction_coefficient * float(normal_force[-1]), curve.y)
    panel = Panel(LABELS["tangential_force"], [curve], marks=marks)
    return Plot(LABELS["tangential_displacement"], [panel], points_label="turning points")


def _into_full_slip(
    contact: TangentialContact, coordinate: float, requested: Array
) -> TangentialContact:
    """Return the contact of one normal load at displacements that reach full slip.

    They go to both sides if the requested ones do. A displacement, unlike a force, has a solution
    wherever it ends.
    """
    one = replace(contact.normal, coordinate=np.array([coordinate]))
    full = _INTO_SLIP * float(np.max(contact.displacement_ratio * one.indentation_depth))
    start = min(float(requested.min()), -full if requested.min() < 0 else 0.0)
    stop = max(float(requested.max()), full if requested.max() > 0 or start == 0 else 0.0)
    return tangential_contact.solve(
        one,
        contact.g_star,
        contact.friction_coefficient,
        tangential_displacement=np.linspace(start, stop, POINTS),
    )


def _dense_path(query: HistoryQuery, path: LoadHistory) -> LoadHistory:
    """Return the load history with enough samples for smooth curves."""
    samples = min(-(-_MAX_SAMPLES // query.path.steps), POINTS)
    if samples <= query.path.samples_per_step:
        return path
    dense = query.path.model_copy(update={"samples_per_step": samples})
    name = "cycles" if query.has("cycles") else "history"
    changes = {name: dense, "rtol": max(query.rtol, VISIBLE)}
    return solve_path(query.model_copy(update=changes))


def _friction_limits(limit: float, force: Array, curve: int | None = None) -> list[Mark]:
    """Return marks at the limiting forces that the force comes near."""
    signs = {"µ F_N": 1, "−µ F_N": -1}
    return [
        Mark(sign * limit, symbol, curve)
        for symbol, sign in signs.items()
        if (sign * force).max(initial=0.0) > _NEAR_LIMIT * limit
    ]
