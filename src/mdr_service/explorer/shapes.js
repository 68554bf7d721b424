// Default values and shapes f(r) of the profile kinds, for the form and the sketch.
// What a kind is called on the wire, and which fields it has, comes from GET v1/profiles.

export const LABELS = {
  balls: "Two balls",
  paraboloid: "Paraboloid (ball)",
  sphere: "Sphere, exact",
  ellipsoid: "Ellipsoid",
  flat_punch: "Flat punch",
  rounded_punch: "Rounded punch",
  cone: "Cone",
  rounded_cone: "Cone, parabolic tip",
  spherical_tip_cone: "Cone, spherical tip",
  truncated_cone: "Truncated cone",
  truncated_paraboloid: "Truncated paraboloid (worn ball)",
  hyperboloid: "Hyperboloid",
  capped_paraboloid: "Paraboloid with a blunter cap",
  power: "Power law",
  series: "Sum of two powers",
  tabulated: "Table of measured points",
};

export const DEFAULT_FIELDS = {
  balls: { radius_1: 0.01, radius_2: 0.02 },
  paraboloid: { radius: 0.01 },
  sphere: { radius: 0.01 },
  ellipsoid: { radius: 0.01, height: 0.005 },
  flat_punch: { radius: 0.001 },
  rounded_punch: { flat_radius: 5e-4, rounding_radius: 0.005 },
  cone: { slope: 0.02 },
  rounded_cone: { slope: 0.05, tip_radius: 0.002 },
  spherical_tip_cone: { slope: 0.05, tip_radius: 0.002 },
  truncated_cone: { flat_radius: 2e-4, slope: 0.02 },
  truncated_paraboloid: { flat_radius: 1e-4, radius: 0.01 },
  hyperboloid: { slope: 0.05, tip_radius: 0.002 },
  capped_paraboloid: { cap_radius: 1e-4, tip_radius: 0.05, radius: 0.01 },
  power: { coefficient: 2e5, exponent: 3 },
  series: { coefficient_1: 50, exponent_1: 2, coefficient_2: 2e8, exponent_2: 4 },
  tabulated: { interpolation: "auto" },
};

// Fields that the page adds to those of the wire.
export const OWN_FIELDS = {
  balls: [
    { name: "radius_1", dimension: "length", description: "Radius of the first ball" },
    { name: "radius_2", dimension: "length", description: "Radius of the second ball" },
  ],
  series: [1, 2].flatMap((i) => [
    { name: `coefficient_${i}`, dimension: "length^(1-exponent)", description: `Factor of power ${i}` },
    { name: `exponent_${i}`, dimension: "1", description: `Exponent of power ${i}` },
  ]),
};

export const OWN_FORMULAS = {
  balls: "r²/2R with 1/R = 1/R₁ + 1/R₂",
  series: "c₁·r^n₁ + c₂·r^n₂",
};

/** Return the table of a ball that has been measured, with a flat worn on it. */
export function measuredBall() {
  const r = Array.from({ length: 41 }, (_, i) => Number((i * 1e-5).toPrecision(3)));
  const f = r.map((x) => Number(Math.max(0, (x * x - 1e-8) / 0.02).toPrecision(6)));
  return { r, f };
}

/** Return the profile as the wire has it. */
export function wireProfile(inputs) {
  const { kind } = inputs;
  if (kind === "balls") {
    const radius = 1 / (1 / inputs.radius_1 + 1 / inputs.radius_2);
    return { kind: "paraboloid", radius: Number(radius.toPrecision(15)) };
  }
  if (kind === "series") {
    const term = (i) => ({ coefficient: inputs[`coefficient_${i}`], exponent: inputs[`exponent_${i}`] });
    return { kind, terms: [term(1), term(2)] };
  }
  if (kind === "tabulated") {
    return { kind, r: inputs.table.r, f: inputs.table.f, interpolation: inputs.interpolation };
  }
  return { kind, ...Object.fromEntries(Object.keys(DEFAULT_FIELDS[kind]).map((k) => [k, inputs[k]])) };
}

const SHAPES = {
  flat_punch: (r, p) => (r <= p.radius ? 0 : Infinity),
  cone: (r, p) => p.slope * r,
  paraboloid: (r, p) => (r * r) / (2 * p.radius),
  sphere: (r, p) => p.radius - Math.sqrt(p.radius ** 2 - r * r),
  ellipsoid: (r, p) => p.height * (1 - Math.sqrt(1 - (r / p.radius) ** 2)),
  power: (r, p) => p.coefficient * r ** p.exponent,
  series: (r, p) => p.terms.reduce((sum, t) => sum + t.coefficient * r ** t.exponent, 0),
  rounded_punch: (r, p) => Math.max(0, r - p.flat_radius) ** 2 / (2 * p.rounding_radius),
  truncated_cone: (r, p) => p.slope * Math.max(0, r - p.flat_radius),
  truncated_paraboloid: (r, p) => Math.max(0, r * r - p.flat_radius ** 2) / (2 * p.radius),
  rounded_cone: (r, p) => {
    const tangent = p.tip_radius * p.slope;
    return r < tangent ? (r * r) / (2 * p.tip_radius) : p.slope * (r - tangent / 2);
  },
  spherical_tip_cone: (r, p) => {
    const tangent = (p.tip_radius * p.slope) / Math.hypot(1, p.slope);
    const cap = (x) => p.tip_radius - Math.sqrt(p.tip_radius ** 2 - x * x);
    return r < tangent ? cap(r) : cap(tangent) + p.slope * (r - tangent);
  },
  hyperboloid: (r, p) =>
    p.tip_radius * p.slope ** 2 * (Math.hypot(1, r / (p.tip_radius * p.slope)) - 1),
  capped_paraboloid: (r, p) =>
    (r * r) / (2 * p.tip_radius) +
    (Math.max(0, r * r - p.cap_radius ** 2) / 2) * (1 / p.radius - 1 / p.tip_radius),
};

/** Return the points `[r, f]` of the profile up to about `reach`. */
export function outline(profile, reach) {
  if (profile.kind === "tabulated") {
    return profile.r.map((r, i) => [r, profile.f[i]]).filter(([r]) => r <= reach * 1.5);
  }
  const points = [];
  for (let i = 0; i <= 120; i++) {
    const r = (reach * i) / 120;
    const f = SHAPES[profile.kind](r, profile);
    if (!Number.isFinite(f)) break;
    points.push([r, f]);
  }
  return points;
}
