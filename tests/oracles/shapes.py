"""Profiles of the catalogue in mpmath: f, the equivalent profile g and the force, at ``mp.dps``.

``f`` and ``df`` define each kind. ``inner_*`` and ``outer_*`` are closed forms of g, g' and N =
F_N/E*, used for speed; ``test_proofs`` compares each with the quadrature of f' on both sides of
every break.

Every kind has at most one break b (0 if none). Beyond it the closed forms take s = sqrt(x^2 - b^2)
as a second argument, which avoids cancellation as x -> b (s > 0 means beyond the break even where x
rounds to b).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from mpmath import mp, mpf

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence


class Shape:
    """A profile; the defaults are those of a profile that is smooth everywhere."""

    #: Radius of a jump in f' or f''.
    b: mpf
    #: True if the tip is flat up to ``b``, so that the contact radius is at least ``b``.
    blunt = False
    #: True if f' jumps upward at ``b`` (g' and p are infinite there).
    jump = False
    #: Supremum of the contact radii.
    limit: mpf = mp.inf
    #: Smallest exponent of f at the tip, for the substitution that removes its singularity.
    tip_exponent: mpf = mpf(2)

    def __init__(self) -> None:
        self.b = mpf(0)

    def f(self, r: mpf) -> mpf:
        raise NotImplementedError

    def df(self, r: mpf) -> mpf:
        raise NotImplementedError

    def inner_g(self, x: mpf) -> mpf:
        return mpf(0)

    def inner_dg(self, x: mpf) -> mpf:
        return mpf(0)

    def inner_force(self, a: mpf) -> mpf:
        return mpf(0)

    def outer_g(self, x: mpf, s: mpf) -> mpf:
        raise NotImplementedError

    def outer_dg(self, x: mpf, s: mpf) -> mpf:
        raise NotImplementedError

    def outer_force(self, a: mpf, s: mpf) -> mpf:
        raise NotImplementedError

    def beyond(self, x: mpf) -> mpf:
        """s = sqrt(x^2 - b^2), for x >= b."""
        return mp.sqrt((x - self.b) * (x + self.b))

    def g(self, x: mpf, s: mpf | None = None) -> mpf:
        if s is None and x <= self.b:
            return self.inner_g(x)
        return self.outer_g(x, self.beyond(x) if s is None else s)

    def dg(self, x: mpf, s: mpf | None = None) -> mpf:
        if s is None and x <= self.b:
            return self.inner_dg(x)
        return self.outer_dg(x, self.beyond(x) if s is None else s)

    def force(self, a: mpf, s: mpf | None = None) -> mpf:
        if s is None and a <= self.b:
            return self.inner_force(a)
        return self.outer_force(a, self.beyond(a) if s is None else s)

    def radius_of(self, w: mpf) -> tuple[mpf, mpf | None]:
        """Contact radius (and s) as a function of an unbounded, well-conditioned unknown."""
        if self.blunt:
            s = mp.exp(w)
            return mp.sqrt(self.b**2 + s**2), s
        return mp.exp(w), None


def kappa(n: mpf) -> mpf:
    """Factor of Eq. (5.27) that turns C r^n into g = kappa C x^n."""
    return mp.sqrt(mp.pi) * mp.gamma(n / 2 + 1) / mp.gamma((n + 1) / 2)


class Monomials(Shape):
    """Sum of terms C r^n: power, series, cone and paraboloid."""

    def __init__(self, terms: Sequence[tuple[mpf, mpf]]) -> None:
        super().__init__()
        self.terms = tuple(terms)
        self.equivalent_terms = tuple((c * kappa(n), n) for c, n in self.terms)
        self.tip_exponent = min(n for _, n in self.terms)

    def f(self, r: mpf) -> mpf:
        return mp.fsum(c * r**n for c, n in self.terms)

    def df(self, r: mpf) -> mpf:
        return mp.fsum(c * n * r ** (n - 1) for c, n in self.terms)

    def outer_g(self, x: mpf, s: mpf) -> mpf:
        return mp.fsum(c * x**n for c, n in self.equivalent_terms)

    def outer_dg(self, x: mpf, s: mpf) -> mpf:
        return mp.fsum(c * n * x ** (n - 1) for c, n in self.equivalent_terms)

    def outer_force(self, a: mpf, s: mpf) -> mpf:
        return mp.fsum(2 * n / (n + 1) * c * a ** (n + 1) for c, n in self.equivalent_terms)


class Ellipsoid(Shape):
    """height (1 - sqrt(1 - r^2/radius^2)); the sphere has height = radius."""

    def __init__(self, radius: mpf, height: mpf) -> None:
        super().__init__()
        self.radius, self.ratio = radius, height / radius
        self.limit = radius

    def f(self, r: mpf) -> mpf:
        return self.ratio * (self.radius - mp.sqrt((self.radius - r) * (self.radius + r)))

    def df(self, r: mpf) -> mpf:
        return self.ratio * r / mp.sqrt((self.radius - r) * (self.radius + r))

    def outer_g(self, x: mpf, s: mpf) -> mpf:
        return self.ratio * x * mp.atanh(x / self.radius)

    def outer_dg(self, x: mpf, s: mpf) -> mpf:
        rest = x * self.radius / ((self.radius - x) * (self.radius + x))
        return self.ratio * (mp.atanh(x / self.radius) + rest)

    def outer_force(self, a: mpf, s: mpf) -> mpf:
        big = self.radius
        return self.ratio * ((a**2 + big**2) * mp.atanh(a / big) - a * big)

    def radius_of(self, w: mpf) -> tuple[mpf, mpf | None]:
        return self.radius * mp.tanh(mp.exp(w)), None


class TwoSpheres(Shape):
    """Sum of the spheres of both radii, less the sphere of a socket."""

    def __init__(self, radii: Sequence[mpf]) -> None:
        super().__init__()
        self.parts = [(mp.sign(radius), Ellipsoid(abs(radius), abs(radius))) for radius in radii]
        self.limit = min(abs(radius) for radius in radii)

    def f(self, r: mpf) -> mpf:
        return mp.fsum(sign * part.f(r) for sign, part in self.parts)

    def df(self, r: mpf) -> mpf:
        return mp.fsum(sign * part.df(r) for sign, part in self.parts)

    def outer_g(self, x: mpf, s: mpf) -> mpf:
        return mp.fsum(sign * part.outer_g(x, s) for sign, part in self.parts)

    def outer_dg(self, x: mpf, s: mpf) -> mpf:
        return mp.fsum(sign * part.outer_dg(x, s) for sign, part in self.parts)

    def outer_force(self, a: mpf, s: mpf) -> mpf:
        return mp.fsum(sign * part.outer_force(a, s) for sign, part in self.parts)

    def radius_of(self, w: mpf) -> tuple[mpf, mpf | None]:
        return self.limit * mp.tanh(mp.exp(w)), None


class RoundedPunch(Shape):
    """Flat up to b, then (r - b)^2/(2R): Eqs. (5.55)-(5.61)."""

    blunt = True

    def __init__(self, b: mpf, big: mpf) -> None:
        super().__init__()
        self.b, self.big = b, big

    def f(self, r: mpf) -> mpf:
        return (r - self.b) ** 2 / (2 * self.big) if r > self.b else mpf(0)

    def df(self, r: mpf) -> mpf:
        return (r - self.b) / self.big if r > self.b else mpf(0)

    def outer_g(self, x: mpf, s: mpf) -> mpf:
        return x * (s - self.b * mp.atan2(s, self.b)) / self.big

    def outer_dg(self, x: mpf, s: mpf) -> mpf:
        return (2 * s - self.b * mp.atan2(s, self.b)) / self.big

    def outer_force(self, a: mpf, s: mpf) -> mpf:
        return (s**3 + 3 * a**2 * (s - self.b * mp.atan2(s, self.b))) / (3 * self.big)


class TruncatedCone(Shape):
    """Flat up to b, then t (r - b)."""

    blunt = True
    jump = True

    def __init__(self, b: mpf, t: mpf) -> None:
        super().__init__()
        self.b, self.t = b, t

    def f(self, r: mpf) -> mpf:
        return self.t * (r - self.b) if r > self.b else mpf(0)

    def df(self, r: mpf) -> mpf:
        return self.t if r > self.b else mpf(0)

    def outer_g(self, x: mpf, s: mpf) -> mpf:
        return self.t * x * mp.atan2(s, self.b)

    def outer_dg(self, x: mpf, s: mpf) -> mpf:
        return self.t * (mp.atan2(s, self.b) + self.b / s)

    def outer_force(self, a: mpf, s: mpf) -> mpf:
        return self.t * (a**2 * mp.atan2(s, self.b) + self.b * s)


class CappedParaboloid(Shape):
    """Curvature ``inner`` everywhere, and ``k`` more on r^2 - b^2 beyond b.

    The truncated paraboloid has ``inner`` = 0.
    """

    def __init__(self, b: mpf, inner: mpf, k: mpf) -> None:
        super().__init__()
        self.b, self.inner, self.k = b, inner, k
        self.blunt = inner == 0
        self.jump = k > 0

    def f(self, r: mpf) -> mpf:
        extra = self.k * (r - self.b) * (r + self.b) if r > self.b else mpf(0)
        return (self.inner * r**2 + extra) / 2

    def df(self, r: mpf) -> mpf:
        return (self.inner + (self.k if r > self.b else 0)) * r

    def inner_g(self, x: mpf) -> mpf:
        return self.inner * x**2

    def inner_dg(self, x: mpf) -> mpf:
        return 2 * self.inner * x

    def inner_force(self, a: mpf) -> mpf:
        return 4 * self.inner * a**3 / 3

    def outer_g(self, x: mpf, s: mpf) -> mpf:
        return self.inner_g(x) + self.k * x * s

    def outer_dg(self, x: mpf, s: mpf) -> mpf:
        return self.inner_dg(x) + self.k * (s + x**2 / s)

    def outer_force(self, a: mpf, s: mpf) -> mpf:
        return self.inner_force(a) + 2 * self.k * s * (2 * a**2 + self.b**2) / 3


class RoundedCone(Shape):
    """Parabolic tip r^2/(2R) up to b = R t, then the tangent cone."""

    def __init__(self, t: mpf, big: mpf) -> None:
        super().__init__()
        self.t, self.big, self.b = t, big, big * t

    def f(self, r: mpf) -> mpf:
        if r <= self.b:
            return r**2 / (2 * self.big)
        return self.t * (r - self.b / 2)

    def df(self, r: mpf) -> mpf:
        return r / self.big if r <= self.b else self.t

    def inner_g(self, x: mpf) -> mpf:
        return x**2 / self.big

    def inner_dg(self, x: mpf) -> mpf:
        return 2 * x / self.big

    def inner_force(self, a: mpf) -> mpf:
        return 4 * a**3 / (3 * self.big)

    def outer_g(self, x: mpf, s: mpf) -> mpf:
        return self.t * x * (self.b / (x + s) + mp.atan2(s, self.b))

    def outer_dg(self, x: mpf, s: mpf) -> mpf:
        return self.t * (2 * self.b / (x + s) + mp.atan2(s, self.b))

    def outer_force(self, a: mpf, s: mpf) -> mpf:
        tip = 4 * a**2 * self.b / (a + s) / 3 + self.b * s / 3
        return self.t * (a**2 * mp.atan2(s, self.b) + tip)


class SphericalTipCone(Shape):
    """Exact sphere up to the tangent point b = R t/sqrt(1 + t^2), then the cone."""

    def __init__(self, t: mpf, big: mpf) -> None:
        super().__init__()
        self.t, self.big = t, big
        self.b = big * t / mp.sqrt(1 + t**2)
        self.h = big / mp.sqrt(1 + t**2)
        self.tip = Ellipsoid(big, big)

    def f(self, r: mpf) -> mpf:
        if r <= self.b:
            return self.tip.f(r)
        return self.tip.f(self.b) + self.t * (r - self.b)

    def df(self, r: mpf) -> mpf:
        return self.tip.df(r) if r <= self.b else self.t

    def inner_g(self, x: mpf) -> mpf:
        return self.tip.g(x)

    def inner_dg(self, x: mpf) -> mpf:
        return self.tip.dg(x)

    def inner_force(self, a: mpf) -> mpf:
        return self.tip.force(a)

    def _log(self, x: mpf, s: mpf) -> mpf:
        return mp.log((self.big + x) / (self.h + s))

    def outer_g(self, x: mpf, s: mpf) -> mpf:
        return x * (self._log(x, s) + self.t * mp.atan2(s, self.b))

    def outer_dg(self, x: mpf, s: mpf) -> mpf:
        smooth = self._log(x, s) + x / (self.big + x) + self.t * mp.atan2(s, self.b)
        return smooth + (self.t * self.b - s) / (self.h + s)

    def outer_force(self, a: mpf, s: mpf) -> mpf:
        sphere = self.h * s - self.big * a + (self.big**2 + a**2) * self._log(a, s)
        return sphere + self.t * (a**2 * mp.atan2(s, self.b) + self.b * s)


class Hyperboloid(Shape):
    """R t^2 (sqrt(1 + r^2/(R t)^2) - 1)."""

    def __init__(self, t: mpf, big: mpf) -> None:
        super().__init__()
        self.t, self.width = t, big * t

    def f(self, r: mpf) -> mpf:
        return self.t * (mp.hypot(self.width, r) - self.width)

    def df(self, r: mpf) -> mpf:
        return self.t * r / mp.hypot(self.width, r)

    def outer_g(self, x: mpf, s: mpf) -> mpf:
        return self.t * x * mp.atan(x / self.width)

    def outer_dg(self, x: mpf, s: mpf) -> mpf:
        rest = self.width * x / (self.width**2 + x**2)
        return self.t * (mp.atan(x / self.width) + rest)

    def outer_force(self, a: mpf, s: mpf) -> mpf:
        c = self.width
        return self.t * ((a - c) * (a + c) * mp.atan(a / c) + a * c)


class FlatPunch(Shape):
    """Flat punch: the contact radius is prescribed, and g = 0 on the whole contact."""

    def __init__(self, radius: mpf) -> None:
        super().__init__()
        self.b = self.limit = radius
        self.blunt = True

    def f(self, r: mpf) -> mpf:
        return mpf(0) if r <= self.b else mp.inf

    def df(self, r: mpf) -> mpf:
        return mpf(0)


def _series(p: Mapping[str, Any]) -> Shape:
    return Monomials([(mpf(t["coefficient"]), mpf(t["exponent"])) for t in p["terms"]])


def _field(p: Mapping[str, Any], name: str) -> mpf:
    return mpf(p[name])


_MAKERS: dict[str, Callable[[Mapping[str, Any]], Shape]] = {
    "flat_punch": lambda p: FlatPunch(_field(p, "radius")),
    "cone": lambda p: Monomials([(_field(p, "slope"), mpf(1))]),
    "paraboloid": lambda p: Monomials([(1 / (2 * _field(p, "radius")), mpf(2))]),
    "sphere": lambda p: Ellipsoid(_field(p, "radius"), _field(p, "radius")),
    "two_spheres": lambda p: TwoSpheres([mpf(radius) for radius in p["radii"]]),
    "ellipsoid": lambda p: Ellipsoid(_field(p, "radius"), _field(p, "height")),
    "power": lambda p: Monomials([(_field(p, "coefficient"), _field(p, "exponent"))]),
    "series": _series,
    "rounded_punch": lambda p: RoundedPunch(_field(p, "flat_radius"), _field(p, "rounding_radius")),
    "truncated_cone": lambda p: TruncatedCone(_field(p, "flat_radius"), _field(p, "slope")),
    "truncated_paraboloid": lambda p: CappedParaboloid(
        _field(p, "flat_radius"), mpf(0), 1 / _field(p, "radius")
    ),
    "rounded_cone": lambda p: RoundedCone(_field(p, "slope"), _field(p, "tip_radius")),
    "spherical_tip_cone": lambda p: SphericalTipCone(_field(p, "slope"), _field(p, "tip_radius")),
    "hyperboloid": lambda p: Hyperboloid(_field(p, "slope"), _field(p, "tip_radius")),
    "capped_paraboloid": lambda p: CappedParaboloid(
        _field(p, "cap_radius"),
        1 / _field(p, "tip_radius"),
        1 / _field(p, "radius") - 1 / _field(p, "tip_radius"),
    ),
}

#: Kinds with a closed form.
KINDS = tuple(_MAKERS)
#: Kinds of the banks. Pairs of spheres have references in `tests/core/test_two_spheres.py`.
BANKED = tuple(kind for kind in KINDS if kind != "two_spheres")


def shape_of(profile: Mapping[str, Any]) -> Shape:
    """Return the shape of a request's `profile`, with its doubles taken as exact."""
    return _MAKERS[profile["kind"]](profile)
