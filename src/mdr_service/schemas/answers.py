"""Responses: the members that queries compute, in this order, and OpenAPI documents."""

from functools import partial
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from mdr_core.errors import Remedy
from mdr_service.schemas.load_paths import HistoryState, Regime
from mdr_service.schemas.quantities import left_out, optional, quantity

_number = partial(quantity, "1")
_length = partial(quantity, "length")
_force = partial(quantity, "force")
_pressure = partial(quantity, "pressure")
_stiffness = partial(quantity, "force/length")
_energy = partial(quantity, "force*length")
_velocity = partial(quantity, "length/time")
_limit = partial(quantity, "as the quantity")

_Field = list[list[float | None]]
_Map = list[list[list[float | None]]]
_Regime = Annotated[
    list[Literal["stick", "partial_slip", "full_slip"]],
    Field(description="Slip regime: `stick`, `partial_slip` or `full_slip`."),
]
_NULL = "null where infinite, with a warning `singular`"
_ROUND = "under a given force by the model, for round bodies or a given thickness"
_UNBOUNDED = "null if wear is unbounded"


class Answer(BaseModel):
    """Part of a response; tests validate every response with it."""

    model_config = ConfigDict(strict=True, extra="forbid", allow_inf_nan=False)


class AnswerWarning(Answer):
    """Warning about a response, for example that a limit of validity is exceeded."""

    code: str = Field(description="Stable name of the warning.")
    message: str = Field(description="Explanation for this case.")
    value: float | None = Field(description="Value compared with `limit`, or null.")
    limit: float | None = Field(
        description="Limit beyond which the warning is raised (below it for probabilities and "
        "`jkr_range`), or null."
    )
    instead: Remedy | None = Field(description="Remedy, null where there is none.")


class HoldsWhile(Answer):
    """Limit within which the model may leave out an effect; `below` or `above`, one per load."""

    effect: Literal["adhesion", "slip", "thickness", "yield", "shape"] = Field(
        description="Effect that the model leaves out."
    )
    quantity: str = Field(description="Quantity that is limited.")
    below: list[float] = _limit("Largest value", default=None)
    above: list[float] = _limit("Smallest value", default=None)
    changes: str = Field(description="Result that changes by `holds_within` at the limit.")
    instead: str = Field(description="Model beyond the limit, or simplest kind within it.")


class SolvedAnswer(Answer):
    """Method, accuracy and warnings of every response."""

    method: str = Field(
        description="Most expensive method among the results: `closed_form`, `quadrature` "
        "(numerical integration) or `piecewise_moments` (sums over the pieces of a table)."
    )
    sources: list[str] = Field(
        description="Keys of the manual's list of sources, with equations, behind the results."
    )
    error_estimate: float = _number(
        "Bound on the numerical error: of scalars relative to their values, of fields, histories "
        "and stresses to the largest value; for impacts and wear over the cycles an estimate"
    )
    model_error: list[float] = _number(
        "Estimate, not a bound, of the relative error of depth, force and displacements by the "
        "model: half-space, coupling and transverse slip; 1 for 100 % and more; by load or sample"
    )
    model_error_radius: list[float] = _number(
        f"Estimated error of the radius {_ROUND}", default=None
    )
    model_error_pressure: list[float] = _number(
        f"Estimated error of the pressure {_ROUND}", default=None
    )
    warnings: list[AnswerWarning] = Field(description="Warnings, each with a stable code.")


class PressedAnswer(SolvedAnswer):
    """Response about a contact under loads, or about its fields."""

    holds_while: list[HoldsWhile] = left_out(
        "Limits within which an effect that the model leaves out changes a result by no more than "
        "`holds_within`, if that is given."
    )
    pressure_data_error: list[float | None] = _number(
        "Pressure error due to the points of a table, an estimate relative to the largest "
        "pressure; null where that is infinite",
        default=None,
    )


class ContactAnswer(PressedAnswer):
    """One entry per load in every list."""

    indentation_depth: list[float] = _length("Indentation depth d")
    normal_force: list[float] = _force("Normal force F_N, positive in compression")
    contact_radius: list[float] = _length("Contact radius a")
    mean_pressure: list[float | None] = _pressure(f"Mean pressure, F_N/(π a²); {_NULL}")
    maximum_pressure: list[float | None] = _pressure(f"Maximum pressure, the largest p(r); {_NULL}")
    normal_stiffness: list[float | None] = _stiffness(
        "Normal stiffness, dF_N/dd = 2 E* a; of an adhesive contact at constant w, null at "
        "pull-off under a prescribed depth, where it is infinite"
    )
    elastic_energy: list[float] = _energy("Elastic energy, of the contact")
    data_error: list[float] = _number(
        "Error due to the points of a table, an estimate relative to depth and force",
        default=None,
    )


class NormalAnswer(ContactAnswer):
    """One entry per load in every list; pull-off and retraction only with `work_of_adhesion`."""

    pull_off_force: list[float] = _force(
        "Pull-off force, the lowest normal force of a contact", default=None
    )
    pull_off_depth: list[float] = _length(
        "Pull-off depth, the lowest depth of a contact", default=None
    )
    retraction: list[float] = _length(
        "Retraction Δℓ by adhesion, from the contact without adhesion of the same radius",
        default=None,
    )
    pull_off_data_error: list[float] = _number(
        "Pull-off error due to the points of a table, an estimate relative to the pull-off force",
        default=None,
    )


class LeastSquaresAnswer(SolvedAnswer):
    """Fitted parameters with their errors, and residuals."""

    fit: list[str] = Field(description="Fitted parameters, in the order of their errors.")
    force_offset: list[float] = _force("Force offset, without contact or in the middle of a loop")
    standard_errors: list[float] = quantity(
        "as the parameter", "Standard errors of the fitted parameters"
    )
    correlation: list[list[float]] = _number("Correlation of the fitted parameters")
    noise: list[float] = _force("Standard deviation of the forces")
    misfit: list[float] = _number(
        "Probability that the right model leaves residuals at least as far from noise; below 0.01 "
        "a warning names the likeliest fault"
    )
    residual: list[float] = _force("Measured less fitted forces")


class FitAnswer(LeastSquaresAnswer):
    """Parameters in lists of one entry, and the curve."""

    e_star: list[float] = _pressure("Effective modulus E*")
    contact_point: list[float] = _length("Contact point, the depth of first contact in the curve")
    work_of_adhesion: list[float] = quantity("force/length", "Work of adhesion, an energy per area")
    youngs_modulus: list[float] = _pressure("Young's modulus of the sample", default=None)
    youngs_modulus_error: list[float] = _pressure(
        "Standard error of Young's modulus, from the error of E*", default=None
    )
    drift_rate: list[float] = optional("length/time", "Subtracted drift rate of the depths")
    drift_rate_error: list[float] = optional("length/time", "Standard error of the drift rate")
    indentation_depth: list[float] = _length(
        "Measured depths after subtraction of a drift; with adhesion, without the points between "
        "the least force and the pull-off"
    )
    normal_force: list[float] = _force("Fitted forces")


class LoopAnswer(LeastSquaresAnswer):
    """Parameters in lists of one entry, and the loop."""

    g_star: list[float] = _pressure("Effective shear modulus G*")
    friction_coefficient: list[float] = _number("Coefficient of friction µ")
    rig_compliance: list[float] = quantity("length/force", "Compliance of the rig, given or fitted")
    displacement_offset: list[float] = _length("Displacement offset, in the middle of the loop")
    dissipated_energy: list[float] = _energy("Energy dissipated in a cycle of the fitted loop")
    dissipated_energy_error: list[float] = _energy("Standard error of the dissipated energy")
    tangential_displacement: list[float] = _length("Measured displacements")
    tangential_force: list[float] = _force("Fitted forces")


class HistoryAnswer(SolvedAnswer):
    """One entry per sample in every list, except `slip_fronts` and the lists over the cycles."""

    step: list[int] = _number("Index of the load step, from 0")
    indentation_depth: list[float] = _length("Indentation depth d; below 0 a separation")
    normal_force: list[float] = _force("Normal force F_N, positive in compression")
    contact_radius: list[float] = _length("Contact radius a, 0 in separation")
    tangential_displacement: list[float] = _length("Tangential displacement u_x, of the bodies")
    tangential_force: list[float] = _force("Tangential force F_x")
    dissipated_energy: list[float] = _energy("Dissipated energy, by slip since the start")
    elastic_energy: list[float] = _energy("Elastic energy, of the normal load")
    tangential_energy: list[float] = _energy("Elastic energy of the tangential load")
    regime: list[Regime] = Field(description="Slip regime, by sample.")
    slip_fronts: list[float] = _length(
        "Radii of the slip fronts at the end, ascending; `error_estimate` does not cover them"
    )
    energy_per_cycle: list[float] = _energy(
        "Energy dissipated in each cycle, the area of its loop", default=None
    )
    secant_stiffness: list[float] = _stiffness(
        "Secant stiffness of each cycle, the range of F_x over the range of u_x", default=None
    )
    final_state: HistoryState = left_out("State at the end, with `return_state`.")


class ImpactAnswer(SolvedAnswer):
    """One entry per impact in every list."""

    normal_velocity: list[float] = _velocity("Velocity of approach")
    tangential_velocity: list[float] = _velocity("Tangential velocity before the impact")
    normal_rebound_velocity: list[float] = _velocity(
        "Velocity of separation; the motion is elastic"
    )
    tangential_rebound_velocity: list[float] = _velocity(
        "Tangential velocity after the impact, of the contact point"
    )
    duration: list[float] = quantity("time", "Duration of contact")
    maximum_indentation_depth: list[float] = _length("Largest indentation depth")
    maximum_normal_force: list[float] = _force("Largest normal force")
    tangential_impulse: list[float] = quantity("force*time", "Tangential momentum lost, ∫ F_x dt")
    dissipated_energy: list[float] = _energy("Dissipated energy, by friction")
    regime: list[Literal["stick", "partial_slip", "full_slip"]] = Field(
        description="`full_slip` if the contact slides throughout, `stick` without tangential "
        "velocity, else `partial_slip`."
    )


class SlipAnswer(ContactAnswer):
    """Contact with friction: one entry per pair of normal and other load in every list."""

    stick_radius: list[float] = _length("Stick radius c, 0 in full slip")
    slip_width: list[float] = _length("Slip width a − c")
    dissipated_energy: list[float] = _energy(
        "Dissipated energy, by slip on first loading; a cycle between ± the load dissipates four "
        "times as much"
    )
    regime: _Regime


class TangentialAnswer(SlipAnswer):
    """One entry per pair of normal and tangential load in every list."""

    tangential_force: list[float] = _force("Tangential force F_x")
    tangential_displacement: list[float] = _length("Tangential displacement u_x, of the bodies")
    tangential_stiffness: list[float] = _stiffness(
        "Tangential stiffness on further loading, 2 G* c"
    )


class OverRadius(Answer):
    """Radii and pressures of a response that has fields only if they are requested."""

    radius: list[float] = _length("Radius r, requested or chosen", default=None)
    pressure: _Field = _pressure(f"Pressure p(r), by load and radius; {_NULL}", default=None)


class TorsionAnswer(SlipAnswer, OverRadius):
    """One entry per pair of normal load and twist in every list; fields only if requested."""

    torque: list[float] = _energy("Torque M")
    rotation: list[float] = _number("Rotation φ, of the bodies in radians")
    torsional_stiffness: list[float] = _energy(
        "Torsional stiffness, dM/dφ = (16/3) G c³ on further rotation, torque per radian"
    )
    torsion_arm: list[float] = _length("Torsion arm, the limit of the torque over µ F_N")
    shear_stress: _Field = _pressure(
        "Shear stress τ(r), circumferential, by load and radius, positive in the direction of a "
        f"positive torque; {_NULL}",
        default=None,
    )


class StressAnswer(PressedAnswer):
    """Requested fields by load and radius; the others are absent."""

    radius: list[float] = _length("Radius r, requested or chosen")
    pressure: _Field = _pressure(f"Pressure p(r), by load and radius; {_NULL}", default=None)
    shear_stress: _Field = _pressure(
        "Shear stress τ(r), by load and radius, positive in the direction of a positive "
        f"tangential force; {_NULL}",
        default=None,
    )
    slip: _Field = _length(
        "Slip s(r), by load and radius: tangential displacement of the surface in the slip zone "
        "relative to the stick zone, negative for a positive displacement of the bodies",
        default=None,
    )
    normal_displacement: _Field = _length(
        "Displacement u_z(r), of the surface into the half-space, by load and radius", default=None
    )
    foundation_load: _Field = _stiffness(
        "Load q of the equivalent foundation at x = r, by load and radius", default=None
    )
    foundation_shear: _Field = _stiffness(
        "Tangential load q_x of the equivalent foundation at x = r, by load and radius",
        default=None,
    )


class LargestStress(Answer):
    """Largest value of a stress in the whole body and its place, one entry per load."""

    value: list[float | None] = _pressure(f"Largest value; {_NULL}")
    x: list[float] = _length("Coordinate along the tangential force")
    y: list[float] = _length("Transverse coordinate, ≥ 0: the field is symmetric in y")
    z: list[float] = _length("Depth")


class LargestStresses(Answer):
    """Largest stresses; their places are accurate to about a thousandth of the contact radius."""

    von_mises: LargestStress = Field(description="Von Mises' equivalent stress.")
    maximum_shear: LargestStress = Field(description="Maximum shear stress ½(σ₁ − σ₃).")


class YieldOnsetForce(Answer):
    """Normal force at which yield begins, at the ratio of forces of each load.

    Zero where a stress is infinite under any load, null where no load reaches the yield strength.
    """

    tresca: list[float | None] = _force("By Tresca's criterion")
    von_mises: list[float | None] = _force("By von Mises' criterion")


class SubsurfaceAnswer(SolvedAnswer):
    """Requested stresses by load, z and x; tension is positive."""

    x: list[float] = _length("x, along the tangential force, requested or chosen")
    z: list[float] = _length("z, the depth, requested or chosen")
    stress_xx: _Map = _pressure(f"Normal stress σ_xx; {_NULL}", default=None)
    stress_yy: _Map = _pressure(f"Normal stress σ_yy; {_NULL}", default=None)
    stress_zz: _Map = _pressure(f"Normal stress σ_zz; {_NULL}", default=None)
    stress_xy: _Map = _pressure(f"Shear stress τ_xy; {_NULL}", default=None)
    stress_xz: _Map = _pressure(f"Shear stress τ_xz; {_NULL}", default=None)
    stress_yz: _Map = _pressure(f"Shear stress τ_yz; {_NULL}", default=None)
    von_mises: _Map = _pressure(f"Von Mises' equivalent stress; {_NULL}", default=None)
    maximum_shear: _Map = _pressure(f"Maximum shear stress ½(σ₁ − σ₃); {_NULL}", default=None)
    principal_1: _Map = _pressure(f"Largest principal stress; {_NULL}", default=None)
    principal_2: _Map = _pressure(f"Middle principal stress; {_NULL}", default=None)
    principal_3: _Map = _pressure(f"Smallest principal stress; {_NULL}", default=None)
    mean_stress: _Map = _pressure(f"Mean stress; {_NULL}", default=None)
    largest: LargestStresses = left_out("Largest stresses of the whole body, if requested.")
    yield_onset_force: YieldOnsetForce = left_out(
        "Normal force at the onset of yield [force], with `yield_strength`."
    )
    search_error_estimate: float = _number(
        "Estimate of the relative error of `largest` and `yield_onset_force`, which are searched",
        default=None,
    )


class WearAnswer(SolvedAnswer, OverRadius):
    """One entry per pair of load and amplitude in every list; fields only if requested.

    In full slip under a constant force wear is unbounded: quantities that grow with it are null,
    with a warning `endless_wear`.
    """

    stick_radius: list[float] = _length("Stick radius c, inside which there is no wear")
    wear_radius: list[float | None] = _length(f"Outer radius ã of the worn annulus; {_UNBOUNDED}")
    indentation_depth: list[float | None] = _length(f"Limiting indentation depth d; {_UNBOUNDED}")
    normal_force: list[float] = _force("Normal force F_N in the limiting state")
    worn_volume: list[float | None] = quantity("length^3", f"Worn volume V; {_UNBOUNDED}")
    regime: _Regime
    initial_profile: list[float | None] = _length(
        f"Initial profile f₀(r) by radius, the same for all loads; {_NULL}, outside a flat punch",
        default=None,
    )
    limiting_profile: _Field = _length(
        f"Limiting profile f(r), by load and radius; {_UNBOUNDED}, and outside a flat punch",
        default=None,
    )
    worn_depth: _Field = _length(
        f"Worn depth, f(r) − f₀(r), by load and radius; {_UNBOUNDED}", default=None
    )
    pressure: _Field = _pressure(
        f"Pressure p(r) in the limiting state, by load and radius; {_NULL}, at c", default=None
    )


class EvolutionAnswer(SolvedAnswer, OverRadius):
    """One entry per number of cycles in every list; fields only if requested.

    `error_estimate` estimates the error of the quantities without a radius, by comparison with a
    coarser run. In full slip the error of the normal force is relative to the force before wear.
    """

    cycles: list[float] = _number("Number of cycles, as requested")
    worn_volume: list[float] = quantity("length^3", "Worn volume V")
    indentation_depth: list[float] = _length("Indentation depth d; it grows if F_N is constant")
    normal_force: list[float] = _force("Normal force F_N; it falls if d is constant")
    stick_radius: list[float] = _length("Stick radius c")
    contact_radius: list[float] = _length(
        "Contact radius a, the outer radius of the worn annulus; it tends to `wear_radius` of "
        "`/v1/wear`, unless that response has the warning `path_dependent`"
    )
    dissipated_energy: list[float] = _energy("Dissipated energy, by slip in all cycles, V/K")
    field_error_estimate: float = _number(
        "Estimated error of each field, relative to its largest value or the mean in the contact; "
        "absent without fields",
        default=None,
    )
    profile: _Field = _length(
        "Profile f(r), worn, by number of cycles and radius; it tends to `limiting_profile` of "
        "`/v1/wear`, unless that response has the warning `path_dependent`; "
        f"{_NULL}, outside a flat punch",
        default=None,
    )
    worn_depth: list[list[float]] = _length(
        "Worn depth, f(r) − f₀(r), by number of cycles and radius", default=None
    )
    pressure: _Field = _pressure(
        f"Pressure p(r), by number of cycles and radius; {_NULL}", default=None
    )


class ProfileField(Answer):
    """Field of a kind of profile."""

    name: str = Field(description="Name of the field in a request.")
    dimension: str = Field(description="Dimension, in the caller's units.")
    description: str = Field(description="Meaning of the field.")
    required: bool = Field(description="True if the field is required.")


class ProfileKind(Answer):
    """Kind of profile."""

    kind: str = Field(description="Value of `kind` in a request.")
    formula: str = Field(description="Shape f(r), a length as a function of the radius.")
    fields: list[ProfileField] = Field(description="Fields of the kind.")
    closed_forms: list[str] = Field(description="Quantities that have a closed form.")


class Catalogue(Answer):
    """All kinds of profile."""

    profiles: list[ProfileKind] = Field(description="The kinds.")


class Health(Answer):
    """State of the service."""

    status: Literal["ok"] = Field(description="State: `ok`.")
    version: str = Field(description="Version of the service.")
    compiled: bool = Field(
        description="True if the module for load histories is compiled; if not, they take about "
        "100 times longer."
    )


class TableColumn(Answer):
    """Column of a file."""

    name: str = Field(description="Name without the unit, empty without a heading.")
    unit: str | None = Field(description="Unit, of an area the unit of its root; null without one.")
    quantity: str | None = Field(
        description="`radius`, `area`, `height`, `depth` or `force`; null if it is not taken."
    )


class TableSegment(Answer):
    """Branch of a curve."""

    kind: Literal["loading", "hold", "unloading"] = Field(
        description="`loading`, `unloading`, or `hold` at a constant force or depth."
    )
    first: int = Field(description="First row, from 0.")
    last: int = Field(description="Last row.")


class TableAnswer(Answer):
    """Columns of a file, and the two that are taken, in the units of the file."""

    columns: list[TableColumn] = Field(description="All columns, in their order.")
    r: list[float] = left_out("Radii of a profile.")
    f: list[float] = left_out("Heights of a profile.")
    indentation_depth: list[float] = left_out("Depths of a curve.")
    normal_force: list[float] = left_out("Forces of a curve.")
    units: list[str | None] = Field(description="Units of the two lists, null if not named.")
    scales: list[float | None] = Field(description="Each of the two units in metres or newtons.")
    lines: list[int] = Field(description="Line of each point in the file, from 1.")
    notes: list[str] = Field(description="Notes on the columns that are taken.")
    segments: list[TableSegment] = left_out(
        "Segments of a curve, by a column that names them, else by the direction of the depth."
    )
    time: list[float] = left_out(
        "Times of a curve from its first point in seconds, if a column has a unit of time."
    )
    drift_rate: list[float] = left_out(
        "Drift rate in the last hold at a constant low force, in units of the depths per second, "
        "as a list of one entry."
    )
    drift_rate_error: list[float] = left_out("Standard error of `drift_rate`.")


class ProblemError(Answer):
    """Invalid value of a request."""

    pointer: str = Field(description="JSON pointer to the value (RFC 6901).")
    detail: str = Field(description="Reason, and what to change.")


class Problem(Answer):
    """Problem document (RFC 9457)."""

    type: str = Field(description="Stable name of the type of problem, a URI.")
    title: str = Field(description="Title of the type of problem.")
    status: int = Field(description="The HTTP status.")
    detail: str = Field(description="Fault and remedy: the first of `errors`, with its place.")
    instance: str = Field(
        default="",
        description="URI of the request with its `X-Request-Id`, if the service is at fault.",
    )
    errors: list[ProblemError] = Field(
        default=[], max_length=20, description="Invalid values of the request, at most twenty."
    )
