"""Two bodies' elastic constants reduced to the effective moduli of the contact."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf
from typing import Final, Literal

from mdr_core.errors import InputError, Notice

RIGID: Final = "rigid"

# Above this |beta| the normal and tangential problems couple noticeably: the coupling error
# is of order beta. The threshold is a judgement, not a theorem.
_SIMILARITY_LIMIT: Final = 0.05


@dataclass(frozen=True)
class Body:
    """One elastic body: `youngs_modulus` [pressure] > 0, -1 < `poissons_ratio` <= 1/2 [1]."""

    youngs_modulus: float
    poissons_ratio: float

    @property
    def shear_modulus(self) -> float:
        """G = E / (2 (1 + nu)) [pressure]."""
        return self.youngs_modulus / (2 * (1 + self.poissons_ratio))


@dataclass(frozen=True)
class Material:
    """The effective moduli `e_star`, `g_star` [pressure] and Dundurs' `dundurs_beta` [1].

    `g_star` is None where it was not given, `dundurs_beta` where the bodies are unknown.
    """

    e_star: float
    g_star: float | None = None
    dundurs_beta: float | None = None

    def __post_init__(self) -> None:
        for name, value in (("e_star", self.e_star), ("g_star", self.g_star)):
            if value is not None and not 0 < value < inf:
                raise InputError(("material", name), "must be positive and finite")

    @property
    def warnings(self) -> tuple[Notice, ...]:
        """`elastic_similarity` where Eq. (5.3) is missed by more than a small beta."""
        if self.dundurs_beta is None or abs(self.dundurs_beta) <= _SIMILARITY_LIMIT:
            return ()
        return (
            Notice(
                "elastic_similarity",
                f"the bodies are not elastically similar (Dundurs beta = {self.dundurs_beta:.3g}): "
                "normal and tangential contact are coupled, an effect of this relative order "
                "that the model leaves out",
            ),
        )


def from_bodies(bodies: Sequence[Body | Literal["rigid"]]) -> Material:
    """Return the effective moduli and the similarity mismatch of two bodies in contact.

    1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2 and 1/G* = (2 - nu1)/(4 G1) + (2 - nu2)/(4 G2);
    a rigid body's terms are dropped. The mismatch is Dundurs'
    beta = (m1 - m2) / (2 [(1 - nu1)/G1 + (1 - nu2)/G2]), m = (1 - 2 nu)/G, which is zero
    exactly where the bodies are elastically similar, Eq. (5.3).

    Source: mdr-5, Eqs. (5.2), (5.3); dundurs.

    Parameters
    ----------
    bodies : two of `Body` or "rigid", at least one of them elastic.

    Raises
    ------
    InputError : not two bodies, both rigid, or constants outside 0 < E, -1 < nu <= 1/2.

    Examples
    --------
    >>> steel = Body(210e9, 0.3)
    >>> round(from_bodies([steel, RIGID]).e_star / 1e9, 3)
    230.769
    """
    if len(bodies) != 2:
        raise InputError(("material", "bodies"), "exactly two bodies are needed")
    elastic = [(i, body) for i, body in enumerate(bodies) if isinstance(body, Body)]
    if not elastic:
        raise InputError(("material", "bodies"), "two rigid bodies have no contact mechanics")
    for i, body in elastic:
        _check_body(i, body)
    parts = [body for _, body in elastic]
    normal = sum(_normal_compliance(body) for body in parts)
    shear = sum((2 - body.poissons_ratio) / (4 * body.shear_modulus) for body in parts)
    return Material(1 / normal, 1 / shear, _dundurs_beta(bodies))


def _normal_compliance(body: Body) -> float:
    """(1 - nu^2)/E, in the factors that keep their digits as nu -> -1."""
    return (1 - body.poissons_ratio) * (1 + body.poissons_ratio) / body.youngs_modulus


def _check_body(i: int, body: Body) -> None:
    if not 0 < body.youngs_modulus < inf:
        raise InputError(("material", "bodies", i, "youngs_modulus"), "must be positive and finite")
    if not -1 < body.poissons_ratio <= 0.5:
        raise InputError(("material", "bodies", i, "poissons_ratio"), "must lie in -1 < nu <= 1/2")


def _dundurs_beta(bodies: Sequence[Body | Literal["rigid"]]) -> float:
    """Dundurs' beta, signed as first body minus second. Source: dundurs."""
    mismatch, total = 0.0, 0.0
    for sign, body in zip((1, -1), bodies, strict=True):
        if isinstance(body, Body):
            mismatch += sign * (1 - 2 * body.poissons_ratio) / body.shear_modulus
            total += (1 - body.poissons_ratio) / body.shear_modulus
    return mismatch / (2 * total)
