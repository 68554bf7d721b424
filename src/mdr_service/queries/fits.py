"""Queries about measured curves."""

import numpy as np

from mdr_core import fit
from mdr_core.errors import InputError
from mdr_core.fit import Fit
from mdr_service.queries.contacts import ADHESION, Result, checked, profile
from mdr_service.schemas.fits import FitQuery


def solve_fit(query: FitQuery) -> Fit:
    """Fit F = E* F̂(d − d₀) + F₀ to a measured curve by least squares.

    The standard errors hold for independent errors of the forces of equal size. A warning `misfit`
    means that the residuals are not such noise: the shape or the model is wrong. `error_estimate`
    is the numerical error of the parameters.
    """
    if ("e_star" in query.fit) == query.has("material"):
        reason = "e_star is fitted: leave it out" if query.has("material") else "is needed"
        raise InputError(("material",), f"{reason}, or change `fit`")
    if query.has("material") and query.material.model_fields_set & ADHESION:
        detail = "is not an input of a fit: add work_of_adhesion to fit to determine it"
        raise InputError(("material", "work_of_adhesion"), detail)
    known = query.material if query.has("material") else None
    return fit.solve(
        profile(query.profile),
        indentation_depth=query.indentation_depth,
        normal_force=query.normal_force,
        fit=query.fit,
        e_star=known.effective.e_star if known else None,
        noise=query.noise,
        body_thickness=query.body_thickness or (known.body_thickness if known else None),
    )


def fit_result(query: FitQuery, source: Fit) -> Result:
    """Return the parameters, their standard errors, and the residuals of a curve."""
    names = source.quantities[1:]
    values = {name: np.atleast_1d(getattr(source, name)) for name in names}
    return {
        "fit": query.fit,
        **checked(query, values),
        "method": source.method,
        "error_estimate": source.error_estimate,
        "model_error": np.atleast_1d(source.model_error),
        "warnings": [vars(notice) for notice in source.warnings if notice.code != "singular"],
    }
