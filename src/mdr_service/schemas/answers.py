"""Responses: the members that queries compute, in this order, and OpenAPI documents."""

from typing import Annotated, Literal

from pydantic import Field

from mdr_core.errors import Remedy
from mdr_service.schemas.load_paths import HistoryState, Regime
from mdr_service.schemas.quantities import ABSENT, Strict

_Field = list[list[float | None]]
_Map = list[list[list[float | None]]]
_Regime = Annotated[
    list[Literal["stick", "partial_slip", "full_slip"]],
    Field(description="Slip regime: `stick`, `partial_slip` or `full_slip`."),
]


class Answer(Strict):
    """Part of a response; tests validate every response with it."""


class AnswerWarning(Answer):
    """Warning about a response, for example that a limit of validity is exceeded."""

    code: str
    """Stable name of the warning."""
    message: str
    """Explanation for this case."""
    value: float | None
    """Value compared with `limit`, or null."""
    limit: float | None
    """Limit beyond which the warning is raised (below it for probabilities and `jkr_range`), or
    null."""
    instead: Remedy | None
    """Remedy, null where there is none."""


class HoldsWhile(Answer):
    """Limit within which the model may leave out an effect; `below` or `above`, one per load."""

    effect: Literal["adhesion", "slip", "thickness", "yield", "shape"]
    """Effect that the model leaves out."""
    quantity: str
    """Quantity that is limited."""
    below: list[float] = ABSENT
    """Largest value [as the quantity]"""
    above: list[float] = ABSENT
    """Smallest value [as the quantity]"""
    changes: str
    """Result that changes by `holds_within` at the limit."""
    instead: str
    """Model beyond the limit, or simplest kind within it."""


class SolvedAnswer(Answer):
    """Method, accuracy and warnings of every response."""

    method: str
    """Most expensive method among the results: `closed_form`, `quadrature` (numerical integration)
    or `piecewise_moments` (sums over the pieces of a table)."""
    sources: list[str]
    """Keys of the manual's list of sources, with equations, behind the results."""
    error_estimate: float
    """Bound on the numerical error: of scalars relative to their values, of fields, histories and
    stresses to the largest value; for impacts and wear over the cycles an estimate [1]"""
    model_error: list[float]
    """Estimate, not a bound, of the relative error of depth, force and displacements by the model:
    half-space, coupling and transverse slip; 1 for 100 % and more; by load or sample [1]"""
    model_error_radius: list[float] = ABSENT
    """Estimated error of the radius under a given force by the model, for round bodies or a given
    thickness [1]"""
    model_error_pressure: list[float] = ABSENT
    """Estimated error of the pressure under a given force by the model, for round bodies or a given
    thickness [1]"""
    warnings: list[AnswerWarning]
    """Warnings, each with a stable code."""


class PressedAnswer(SolvedAnswer):
    """Response about a contact under loads, or about its fields."""

    holds_while: list[HoldsWhile] = ABSENT
    """Limits within which an effect that the model leaves out changes a result by no more than
    `holds_within`, if that is given."""
    pressure_data_error: list[float | None] = ABSENT
    """Pressure error due to the points of a table, an estimate relative to the largest pressure;
    null where that is infinite [1]"""


class ContactAnswer(PressedAnswer):
    """One entry per load in every list."""

    indentation_depth: list[float]
    """Indentation depth d [length]"""
    normal_force: list[float]
    """Normal force F_N, positive in compression [force]"""
    contact_radius: list[float]
    """Contact radius a [length]"""
    mean_pressure: list[float | None]
    """Mean pressure, F_N/(π a²); null where infinite, with a warning `singular` [pressure]"""
    maximum_pressure: list[float | None]
    """Maximum pressure, the largest p(r); null where infinite, with a warning `singular`
    [pressure]"""
    normal_stiffness: list[float | None]
    """Normal stiffness, dF_N/dd = 2 E* a; of an adhesive contact at constant w, null at pull-off
    under a prescribed depth, where it is infinite [force/length]"""
    elastic_energy: list[float]
    """Elastic energy, of the contact [force*length]"""
    data_error: list[float] = ABSENT
    """Error due to the points of a table, an estimate relative to depth and force [1]"""


class NormalAnswer(ContactAnswer):
    """One entry per load in every list; pull-off and retraction only with `work_of_adhesion`."""

    pull_off_force: list[float] = ABSENT
    """Pull-off force, the lowest normal force of a contact [force]"""
    pull_off_depth: list[float] = ABSENT
    """Pull-off depth, the lowest depth of a contact [length]"""
    retraction: list[float] = ABSENT
    """Retraction Δℓ by adhesion, from the contact without adhesion of the same radius [length]"""
    pull_off_data_error: list[float] = ABSENT
    """Pull-off error due to the points of a table, an estimate relative to the pull-off force
    [1]"""


class LeastSquaresAnswer(SolvedAnswer):
    """Fitted parameters with their errors, and residuals."""

    fit: list[str]
    """Fitted parameters, in the order of their errors."""
    force_offset: list[float]
    """Force offset, without contact or in the middle of a loop [force]"""
    standard_errors: list[float]
    """Standard errors of the fitted parameters [as the parameter]"""
    correlation: list[list[float]]
    """Correlation of the fitted parameters [1]"""
    noise: list[float]
    """Standard deviation of the forces [force]"""
    misfit: list[float]
    """Probability that the right model leaves residuals at least as far from noise; below 0.01 a
    warning names the likeliest fault [1]"""
    residual: list[float]
    """Measured less fitted forces [force]"""


class FitAnswer(LeastSquaresAnswer):
    """Parameters in lists of one entry, and the curve."""

    e_star: list[float]
    """Effective modulus E* [pressure]"""
    contact_point: list[float]
    """Contact point, the depth of first contact in the curve [length]"""
    work_of_adhesion: list[float]
    """Work of adhesion, an energy per area [force/length]"""
    youngs_modulus: list[float] = ABSENT
    """Young's modulus of the sample [pressure]"""
    youngs_modulus_error: list[float] = ABSENT
    """Standard error of Young's modulus, from the error of E* [pressure]"""
    drift_rate: list[float] = ABSENT
    """Subtracted drift rate of the depths [length/time]"""
    drift_rate_error: list[float] = ABSENT
    """Standard error of the drift rate [length/time]"""
    indentation_depth: list[float]
    """Measured depths after subtraction of a drift; with adhesion, without the points between the
    least force and the pull-off [length]"""
    normal_force: list[float]
    """Fitted forces [force]"""


class LoopAnswer(LeastSquaresAnswer):
    """Parameters in lists of one entry, and the loop."""

    g_star: list[float]
    """Effective shear modulus G* [pressure]"""
    friction_coefficient: list[float]
    """Coefficient of friction µ [1]"""
    rig_compliance: list[float]
    """Compliance of the rig, given or fitted [length/force]"""
    displacement_offset: list[float]
    """Displacement offset, in the middle of the loop [length]"""
    dissipated_energy: list[float]
    """Energy dissipated in a cycle of the fitted loop [force*length]"""
    dissipated_energy_error: list[float]
    """Standard error of the dissipated energy [force*length]"""
    tangential_displacement: list[float]
    """Measured displacements [length]"""
    tangential_force: list[float]
    """Fitted forces [force]"""


class HistoryAnswer(SolvedAnswer):
    """One entry per sample in every list, except `slip_fronts` and the lists over the cycles."""

    step: list[int]
    """Index of the load step, from 0 [1]"""
    indentation_depth: list[float]
    """Indentation depth d; below 0 a separation [length]"""
    normal_force: list[float]
    """Normal force F_N, positive in compression [force]"""
    contact_radius: list[float]
    """Contact radius a, 0 in separation [length]"""
    tangential_displacement: list[float]
    """Tangential displacement u_x, of the bodies [length]"""
    tangential_force: list[float]
    """Tangential force F_x [force]"""
    dissipated_energy: list[float]
    """Dissipated energy, by slip since the start [force*length]"""
    elastic_energy: list[float]
    """Elastic energy, of the normal load [force*length]"""
    tangential_energy: list[float]
    """Elastic energy of the tangential load [force*length]"""
    regime: list[Regime]
    """Slip regime, by sample."""
    slip_fronts: list[float]
    """Radii of the slip fronts at the end, ascending; `error_estimate` does not cover them
    [length]"""
    energy_per_cycle: list[float] = ABSENT
    """Energy dissipated in each cycle, the area of its loop [force*length]"""
    secant_stiffness: list[float] = ABSENT
    """Secant stiffness of each cycle, the range of F_x over the range of u_x [force/length]"""
    final_state: HistoryState = ABSENT
    """State at the end, with `return_state`."""


class ImpactAnswer(SolvedAnswer):
    """One entry per impact in every list."""

    normal_velocity: list[float]
    """Velocity of approach [length/time]"""
    tangential_velocity: list[float]
    """Tangential velocity before the impact [length/time]"""
    normal_rebound_velocity: list[float]
    """Velocity of separation; the motion is elastic [length/time]"""
    tangential_rebound_velocity: list[float]
    """Tangential velocity after the impact, of the contact point [length/time]"""
    duration: list[float]
    """Duration of contact [time]"""
    maximum_indentation_depth: list[float]
    """Largest indentation depth [length]"""
    maximum_normal_force: list[float]
    """Largest normal force [force]"""
    tangential_impulse: list[float]
    """Tangential momentum lost, ∫ F_x dt [force*time]"""
    dissipated_energy: list[float]
    """Dissipated energy, by friction [force*length]"""
    regime: list[Literal["stick", "partial_slip", "full_slip"]]
    """`full_slip` if the contact slides throughout, `stick` without tangential velocity, else
    `partial_slip`."""


class SlipAnswer(ContactAnswer):
    """Contact with friction: one entry per pair of normal and other load in every list."""

    stick_radius: list[float]
    """Stick radius c, 0 in full slip [length]"""
    slip_width: list[float]
    """Slip width a − c [length]"""
    dissipated_energy: list[float]
    """Dissipated energy, by slip on first loading; a cycle between ± the load dissipates four times
    as much [force*length]"""
    regime: _Regime


class TangentialAnswer(SlipAnswer):
    """One entry per pair of normal and tangential load in every list."""

    tangential_force: list[float]
    """Tangential force F_x [force]"""
    tangential_displacement: list[float]
    """Tangential displacement u_x, of the bodies [length]"""
    tangential_stiffness: list[float]
    """Tangential stiffness on further loading, 2 G* c [force/length]"""


class OverRadius(Answer):
    """Radii and pressures of a response that has fields only if they are requested."""

    radius: list[float] = ABSENT
    """Radius r, requested or chosen [length]"""
    pressure: _Field = ABSENT
    """Pressure p(r), by load and radius; null where infinite, with a warning `singular`
    [pressure]"""


class TorsionAnswer(SlipAnswer, OverRadius):
    """One entry per pair of normal load and twist in every list; fields only if requested."""

    torque: list[float]
    """Torque M [force*length]"""
    rotation: list[float]
    """Rotation φ, of the bodies in radians [1]"""
    torsional_stiffness: list[float]
    """Torsional stiffness, dM/dφ = (16/3) G c³ on further rotation, torque per radian
    [force*length]"""
    torsion_arm: list[float]
    """Torsion arm, the limit of the torque over µ F_N [length]"""
    shear_stress: _Field = ABSENT
    """Shear stress τ(r), circumferential, by load and radius, positive in the direction of a
    positive torque; null where infinite, with a warning `singular` [pressure]"""


class StressAnswer(PressedAnswer):
    """Requested fields by load and radius; the others are absent."""

    radius: list[float]
    """Radius r, requested or chosen [length]"""
    pressure: _Field = ABSENT
    """Pressure p(r), by load and radius; null where infinite, with a warning `singular`
    [pressure]"""
    shear_stress: _Field = ABSENT
    """Shear stress τ(r), by load and radius, positive in the direction of a positive tangential
    force; null where infinite, with a warning `singular` [pressure]"""
    slip: _Field = ABSENT
    """Slip s(r), by load and radius: tangential displacement of the surface in the slip zone
    relative to the stick zone, negative for a positive displacement of the bodies [length]"""
    normal_displacement: _Field = ABSENT
    """Displacement u_z(r), of the surface into the half-space, by load and radius [length]"""
    foundation_load: _Field = ABSENT
    """Load q of the equivalent foundation at x = r, by load and radius [force/length]"""
    foundation_shear: _Field = ABSENT
    """Tangential load q_x of the equivalent foundation at x = r, by load and radius
    [force/length]"""


class LargestStress(Answer):
    """Largest value of a stress in the whole body and its place, one entry per load."""

    value: list[float | None]
    """Largest value; null where infinite, with a warning `singular` [pressure]"""
    x: list[float]
    """Coordinate along the tangential force [length]"""
    y: list[float]
    """Transverse coordinate, ≥ 0: the field is symmetric in y [length]"""
    z: list[float]
    """Depth [length]"""


class LargestStresses(Answer):
    """Largest stresses; their places are accurate to about a thousandth of the contact radius."""

    von_mises: LargestStress
    """Von Mises' equivalent stress."""
    maximum_shear: LargestStress
    """Maximum shear stress ½(σ₁ − σ₃)."""


class YieldOnsetForce(Answer):
    """Normal force at which yield begins, at the ratio of forces of each load.

    Zero where a stress is infinite under any load, null where no load reaches the yield strength.
    """

    tresca: list[float | None]
    """By Tresca's criterion [force]"""
    von_mises: list[float | None]
    """By von Mises' criterion [force]"""


class SubsurfaceAnswer(SolvedAnswer):
    """Requested stresses by load, z and x; tension is positive."""

    x: list[float]
    """x, along the tangential force, requested or chosen [length]"""
    z: list[float]
    """z, the depth, requested or chosen [length]"""
    stress_xx: _Map = ABSENT
    """Normal stress σ_xx; null where infinite, with a warning `singular` [pressure]"""
    stress_yy: _Map = ABSENT
    """Normal stress σ_yy; null where infinite, with a warning `singular` [pressure]"""
    stress_zz: _Map = ABSENT
    """Normal stress σ_zz; null where infinite, with a warning `singular` [pressure]"""
    stress_xy: _Map = ABSENT
    """Shear stress τ_xy; null where infinite, with a warning `singular` [pressure]"""
    stress_xz: _Map = ABSENT
    """Shear stress τ_xz; null where infinite, with a warning `singular` [pressure]"""
    stress_yz: _Map = ABSENT
    """Shear stress τ_yz; null where infinite, with a warning `singular` [pressure]"""
    von_mises: _Map = ABSENT
    """Von Mises' equivalent stress; null where infinite, with a warning `singular` [pressure]"""
    maximum_shear: _Map = ABSENT
    """Maximum shear stress ½(σ₁ − σ₃); null where infinite, with a warning `singular` [pressure]"""
    principal_1: _Map = ABSENT
    """Largest principal stress; null where infinite, with a warning `singular` [pressure]"""
    principal_2: _Map = ABSENT
    """Middle principal stress; null where infinite, with a warning `singular` [pressure]"""
    principal_3: _Map = ABSENT
    """Smallest principal stress; null where infinite, with a warning `singular` [pressure]"""
    mean_stress: _Map = ABSENT
    """Mean stress; null where infinite, with a warning `singular` [pressure]"""
    largest: LargestStresses = ABSENT
    """Largest stresses of the whole body, if requested."""
    yield_onset_force: YieldOnsetForce = ABSENT
    """Normal force at the onset of yield [force], with `yield_strength`."""
    search_error_estimate: float = ABSENT
    """Estimate of the relative error of `largest` and `yield_onset_force`, which are searched
    [1]"""


class WearAnswer(SolvedAnswer, OverRadius):
    """One entry per pair of load and amplitude in every list; fields only if requested.

    In full slip under a constant force wear is unbounded: quantities that grow with it are null,
    with a warning `endless_wear`.
    """

    stick_radius: list[float]
    """Stick radius c, inside which there is no wear [length]"""
    wear_radius: list[float | None]
    """Outer radius ã of the worn annulus; null if wear is unbounded [length]"""
    indentation_depth: list[float | None]
    """Limiting indentation depth d; null if wear is unbounded [length]"""
    normal_force: list[float]
    """Normal force F_N in the limiting state [force]"""
    worn_volume: list[float | None]
    """Worn volume V; null if wear is unbounded [length^3]"""
    regime: _Regime
    initial_profile: list[float | None] = ABSENT
    """Initial profile f₀(r) by radius, the same for all loads; null where infinite, with a warning
    `singular`, outside a flat punch [length]"""
    limiting_profile: _Field = ABSENT
    """Limiting profile f(r), by load and radius; null if wear is unbounded, and outside a flat
    punch [length]"""
    worn_depth: _Field = ABSENT
    """Worn depth, f(r) − f₀(r), by load and radius; null if wear is unbounded [length]"""
    pressure: _Field = ABSENT
    """Pressure p(r) in the limiting state, by load and radius; null where infinite, with a warning
    `singular`, at c [pressure]"""


class EvolutionAnswer(SolvedAnswer, OverRadius):
    """One entry per number of cycles in every list; fields only if requested.

    `error_estimate` estimates the error of the quantities without a radius, by comparison with a
    coarser run. In full slip the error of the normal force is relative to the force before wear.
    """

    cycles: list[float]
    """Number of cycles, as requested [1]"""
    worn_volume: list[float]
    """Worn volume V [length^3]"""
    indentation_depth: list[float]
    """Indentation depth d; it grows if F_N is constant [length]"""
    normal_force: list[float]
    """Normal force F_N; it falls if d is constant [force]"""
    stick_radius: list[float]
    """Stick radius c [length]"""
    contact_radius: list[float]
    """Contact radius a, the outer radius of the worn annulus; it tends to `wear_radius` of
    `/v1/wear`, unless that response has the warning `path_dependent` [length]"""
    dissipated_energy: list[float]
    """Dissipated energy, by slip in all cycles, V/K [force*length]"""
    field_error_estimate: float = ABSENT
    """Estimated error of each field, relative to its largest value or the mean in the contact;
    absent without fields [1]"""
    profile: _Field = ABSENT
    """Profile f(r), worn, by number of cycles and radius; it tends to `limiting_profile` of
    `/v1/wear`, unless that response has the warning `path_dependent`; null where infinite, with a
    warning `singular`, outside a flat punch [length]"""
    worn_depth: list[list[float]] = ABSENT
    """Worn depth, f(r) − f₀(r), by number of cycles and radius [length]"""
    pressure: _Field = ABSENT
    """Pressure p(r), by number of cycles and radius; null where infinite, with a warning `singular`
    [pressure]"""


class ProfileField(Answer):
    """Field of a kind of profile."""

    name: str
    """Name of the field in a request."""
    dimension: str
    """Dimension, in the caller's units."""
    description: str
    """Meaning of the field."""
    required: bool
    """True if the field is required."""


class ProfileKind(Answer):
    """Kind of profile."""

    kind: str
    """Value of `kind` in a request."""
    formula: str
    """Shape f(r), a length as a function of the radius."""
    fields: list[ProfileField]
    """Fields of the kind."""
    closed_forms: list[str]
    """Quantities that have a closed form."""


class Catalogue(Answer):
    """All kinds of profile."""

    profiles: list[ProfileKind]
    """The kinds."""


class Health(Answer):
    """State of the service."""

    status: Literal["ok"]
    """State: `ok`."""
    version: str
    """Version of the service."""
    compiled: bool
    """True if the module for load histories is compiled; if not, they take about 100 times
    longer."""


class TableColumn(Answer):
    """Column of a file."""

    name: str
    """Name without the unit, empty without a heading."""
    unit: str | None
    """Unit; null without one."""
    quantity: str | None
    """`radius`, `area`, `height`, `depth` or `force`; null if it is not taken."""


class TableSegment(Answer):
    """Branch of a curve."""

    kind: Literal["loading", "hold", "unloading"]
    """`loading`, `unloading`, or `hold` at a constant force or depth."""
    first: int
    """First row, from 0."""
    last: int
    """Last row."""


class TableAnswer(Answer):
    """Columns of a file, and the two that are taken, in the units of the file."""

    columns: list[TableColumn]
    """All columns, in their order."""
    r: list[float] = ABSENT
    """Radii of a profile."""
    f: list[float] = ABSENT
    """Heights of a profile."""
    axis: float | None = ABSENT
    """Radius of the axis of a profile, null if the points lie on one side of it."""
    indentation_depth: list[float] = ABSENT
    """Depths of a curve."""
    normal_force: list[float] = ABSENT
    """Forces of a curve."""
    units: list[str | None]
    """Units of the two lists, null if not named."""
    scales: list[float | None]
    """Each of the two units in metres or newtons."""
    lines: list[int]
    """Line of each point in the file, from 1."""
    notes: list[str]
    """Notes on the columns that are taken, and on those with the sign reversed."""
    segments: list[TableSegment] = ABSENT
    """Segments of a curve, if the file names them, else by the direction of the depth."""
    time: list[float] = ABSENT
    """Times of a curve from its first point in seconds, if a column has a unit of time."""
    drift_rate: list[float] = ABSENT
    """Drift rate in the last hold at a constant low force, in units of the depths per second, as a
    list of one entry."""
    drift_rate_error: list[float] = ABSENT
    """Standard error of `drift_rate`."""


class ProblemError(Answer):
    """Invalid value of a request."""

    pointer: str
    """JSON pointer to the value (RFC 6901)."""
    detail: str
    """Reason, and what to change."""


class Problem(Answer):
    """Problem document (RFC 9457)."""

    type: str
    """Stable name of the type of problem, a URI."""
    title: str
    """Title of the type of problem."""
    status: int
    """The HTTP status."""
    detail: str
    """Fault and remedy: the first of `errors`, with its place."""
    instance: str = ABSENT
    """URI of the request with its `X-Request-Id`, if the service is at fault."""
    errors: Annotated[list[ProblemError], Field(max_length=20)] = ABSENT
    """Invalid values of the request, at most twenty."""
