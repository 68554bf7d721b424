"""Queries about measured curves."""

from mdr_core import adhesion, fit, hysteresis, normal
from mdr_core.errors import InputError
from mdr_core.fit import Fit
from mdr_core.hysteresis import LoopFit
from mdr_core.layer import LayerContact
from mdr_service.queries.contacts import ADHESION, body, pointing, profile, require_one_of
from mdr_service.schemas.contacts import as_body
from mdr_service.schemas.fits import FitQuery, LoopQuery


def solve_fit(query: FitQuery) -> Fit:
    """Fit F = E* F̂(d − d₀) + F₀ to a measured curve by least squares.

    The standard errors hold for independent errors of equal size in the forces. Warnings report
    residuals that are not such noise: `two_branches` (give a `segment`), `noise_grows`,
    `correlated_noise`, or `misfit` where the shape or the model is wrong. Other warnings report a
    single decisive point (`one_point`), a lopsided interval of the contact point or an offset that
    compensates adhesion (`undetermined`), or a curve without adhesion (`bound`). With
    `poissons_ratio` the response contains Young's modulus of the sample. With `time` a drift can be
    subtracted from the depths: `drift` takes it from the last hold in the lower half of the forces,
    `drift_rate` prescribes it. The standard errors include the error of the rate.

    `error_estimate` is the numerical error of the parameters.
    """
    if ("e_star" in query.fit) == query.has("material"):
        reason = "e_star is fitted: leave it out" if query.has("material") else "is needed"
        raise InputError(("material",), f"{reason}, or change `fit`")
    if query.has("material") and query.material.model_fields_set & ADHESION:
        detail = "is not an input of a fit: add work_of_adhesion to fit to determine it"
        raise InputError(("material", "work_of_adhesion"), detail)
    known = query.material if query.has("material") else None
    if known and known.has("yield_strength"):
        if query.has("layer") or known.has("layer"):
            raise InputError(("material", "yield_strength"), LayerContact.unusable)
        if "work_of_adhesion" in query.fit:
            raise InputError(("material", "yield_strength"), adhesion.AdhesiveContact.unusable)
    return fit.solve(
        profile(query.profile),
        e_star=known.effective.e_star if known else None,
        body_thickness=query.body_thickness or (known.body_thickness if known else None),
        indenter=as_body(query.indenter),
        layer=query.on_base or (known.effective.layer if known else None),
        **query.model_dump(exclude={"profile", "material", "body_thickness", "indenter", "layer"}),
    )


def solve_loop(query: LoopQuery) -> LoopFit:
    """Fit G*, µ and the compliance of the rig to a steady loop by least squares.

    A rig in series with the contact makes it look softer: `rig_compliance` is given, 0 included, or
    fitted. A loop far below full slip hardly separates the rig from the contact, and is rejected
    without `rig_compliance`. The standard errors hold for independent errors of equal size in
    the forces; the warnings `misfit` and `correlated_noise` report residuals that are not such
    noise, in the order of time, of the displacement and on both branches. `error_estimate` is the
    numerical error of the parameters.
    """
    loads = "indentation_depth", "normal_force"
    require_one_of(query, *loads)
    if query.material.model_fields_set & ADHESION:
        raise InputError(("material", "work_of_adhesion"), adhesion.AdhesiveContact.unusable)
    # Bodies always have a shear modulus; it gives G* of the contact only if that is not fitted.
    is_known = query.material.has("g_star") or "g_star" not in (query.fit or ["g_star"])
    # The load is a member of the request itself.
    with pointing({"load": (), "g_star": ("material", "g_star")}):
        contact = normal.solve(**body(query), **query.model_dump(include={*loads}))
        return hysteresis.solve(
            contact,
            g_star=query.material.effective.g_star if is_known else None,
            **query.model_dump(exclude={"profile", "material", *loads}),
        )
