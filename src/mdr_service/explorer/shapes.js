// Label, default values and shape f(r) of each profile kind, for the form and the sketch.
// The descriptions of the fields come from GET v1/profiles.

import { FORCES, LENGTHS } from "./table_reader.js";
import { times } from "./units.js";

const kind = (label, fields, f) => ({ label, fields, f });
const cap = (r, radius) => radius - Math.sqrt(radius ** 2 - r * r);

export const KINDS = {
  two_spheres: kind(
    "Two balls, or ball in socket", { radius_1: 0.01, radius_2: 0.02 },
    (r, p) => p.radii.reduce((sum, radius) => sum + Math.sign(radius) * cap(r, Math.abs(radius)), 0),
  ),
  paraboloid: kind("Paraboloid (ball)", { radius: 0.01 }, (r, p) => (r * r) / (2 * p.radius)),
  sphere: kind("Sphere, exact", { radius: 0.01 }, (r, p) => cap(r, p.radius)),
  ellipsoid: kind(
    "Ellipsoid", { radius: 0.01, height: 0.005 }, (r, p) => p.height * (1 - Math.sqrt(1 - (r / p.radius) ** 2)),
  ),
  flat_punch: kind("Flat punch", { radius: 0.001 }, (r, p) => (r <= p.radius ? 0 : Infinity)),
  rounded_punch: kind(
    "Rounded punch", { flat_radius: 5e-4, rounding_radius: 0.005 },
    (r, p) => Math.max(0, r - p.flat_radius) ** 2 / (2 * p.rounding_radius),
  ),
  cone: kind("Cone", { slope: 0.02 }, (r, p) => p.slope * r),
  rounded_cone: kind("Cone, parabolic tip", { slope: 0.05, tip_radius: 0.002 }, (r, p) => {
    const tangent = p.tip_radius * p.slope;
    return r < tangent ? (r * r) / (2 * p.tip_radius) : p.slope * (r - tangent / 2);
  }),
  spherical_tip_cone: kind("Cone, spherical tip", { slope: 0.05, tip_radius: 0.002 }, (r, p) => {
    const tangent = (p.tip_radius * p.slope) / Math.hypot(1, p.slope);
    return cap(Math.min(r, tangent), p.tip_radius) + p.slope * Math.max(0, r - tangent);
  }),
  truncated_cone: kind(
    "Truncated cone", { flat_radius: 2e-4, slope: 0.02 }, (r, p) => p.slope * Math.max(0, r - p.flat_radius),
  ),
  truncated_paraboloid: kind(
    "Truncated paraboloid (worn ball)", { flat_radius: 1e-4, radius: 0.01 },
    (r, p) => Math.max(0, r * r - p.flat_radius ** 2) / (2 * p.radius),
  ),
  hyperboloid: kind(
    "Hyperboloid", { slope: 0.05, tip_radius: 0.002 },
    (r, p) => p.tip_radius * p.slope ** 2 * (Math.hypot(1, r / (p.tip_radius * p.slope)) - 1),
  ),
  capped_paraboloid: kind(
    "Paraboloid with a blunter cap", { cap_radius: 1e-4, tip_radius: 0.05, radius: 0.01 },
    (r, p) => (r * r) / (2 * p.tip_radius) +
      (Math.max(0, r * r - p.cap_radius ** 2) / 2) * (1 / p.radius - 1 / p.tip_radius),
  ),
  power: kind("Power law", { coefficient: 2e5, exponent: 3 }, (r, p) => p.coefficient * r ** p.exponent),
  series: kind(
    "Sum of two powers", { coefficient_1: 50, exponent_1: 2, coefficient_2: 2e8, exponent_2: 4 },
    (r, p) => p.terms.reduce((sum, t) => sum + t.coefficient * r ** t.exponent, 0),
  ),
  tabulated: kind("Table of measured points", { breaks: "", uncertainty: "" }),
};

// Fields in place of those of the wire.
export const OWN_FIELDS = {
  two_spheres: [
    { name: "radius_1", dimension: "length", description: "Radius of the first ball" },
    { name: "radius_2", dimension: "length", description: "Radius of the second ball, < 0 for a socket" },
  ],
  tabulated: [
    { name: "uncertainty", dimension: "displacement", description: "Uncertainty of the heights", optional: true, placeholder: "from scatter" },
    { name: "breaks", dimension: "length", description: "Radii where the slope jumps", optional: true, list: true, placeholder: "none" },
  ],
  series: [1, 2].flatMap((i) => [
    { name: `coefficient_${i}`, dimension: "length^(1-exponent)", description: `Factor of power ${i}` },
    { name: `exponent_${i}`, dimension: "1", description: `Exponent of power ${i}` },
  ]),
};

export const OWN_FORMULAS = {
  series: "c₁·r^n₁ + c₂·r^n₂",
};

/** Return the table of a ball of radius 10 mm as a profilometer measures it: r in mm, f in µm. */
export function measuredBall() {
  const r = Array.from({ length: 41 }, (_, i) => i / 50);
  return { r, f: r.map((x) => Number((50 * x * x).toFixed(2))), units: ["mm", "µm"] };
}

/** Return a curve of a glass ball of radius 10 mm on rubber, in µm and mN, with its approach. */
export function measuredCurve() {
  const r = Array.from({ length: 61 }, (_, i) => i - 20);
  // 10.7 MPa, contact at 4.2 µm, and errors of some 4 mN.
  const f = r.map((d, i) => Number((1e3 * (4 / 3) * 10.7e6 * 0.1 * Math.max((d - 4.2) * 1e-6, 0) ** 1.5 + 4 * Math.sin(12.9 * i * i)).toFixed(1)));
  return { r, f, units: ["µm", "mN"] };
}

/** Return two cycles of a steel ball of radius 10 mm on steel under 100 N, in µm and N, with a rig in series. */
export function measuredLoop() {
  // Mindlin: µ = 0.3, full slip at 1.27 µm of an amplitude of 2.2 µm; a rig of 0.02 µm/N, errors of some 0.2 N.
  const first = (u) => 30 * (1 - Math.max(1 - u / 1.27, 0) ** 1.5);
  const points = Array.from({ length: 121 }, (_, i) => {
    const u = 2.2 * Math.cos((Math.PI * i) / 30);
    const way = Math.floor(i / 30) % 2 ? 1 : -1;
    const force = way * (2 * first((2.2 + way * u) / 2) - first(2.2));
    return [u + 0.02 * force, force + 0.2 * Math.sin(12.9 * i * i)];
  });
  return { r: points.map(([u]) => Number(u.toFixed(4))), f: points.map(([, f]) => Number(f.toFixed(2))), units: ["µm", "N"] };
}

/** Return the columns of a curve in metres and newtons. */
export function inSI({ r, f, units: [depth, force] }) {
  return { depths: r.map((x) => times(x, LENGTHS[depth])), forces: f.map((x) => times(x, FORCES[force])) };
}

/** Return the radii and heights of a table in metres. */
export function inMetres({ r, f, units }) {
  const [radii, heights] = [r, f].map((column, i) => column.map((x) => times(x, LENGTHS[units[i]])));
  return { r: radii, f: heights };
}

/** Return the profile as the wire has it. */
export function wireProfile(inputs) {
  const { kind } = inputs;
  if (kind === "two_spheres") return { kind, radii: [inputs.radius_1, inputs.radius_2] };
  if (kind === "series") {
    const term = (i) => ({ coefficient: inputs[`coefficient_${i}`], exponent: inputs[`exponent_${i}`] });
    return { kind, terms: [term(1), term(2)] };
  }
  if (kind === "tabulated") {
    const breaks = inputs.breaks ? { breaks: inputs.breaks.split(",").map(Number) } : {};
    const uncertainty = inputs.uncertainty === "" ? {} : { uncertainty: inputs.uncertainty };
    return { kind, ...inMetres(inputs.table), ...breaks, ...uncertainty };
  }
  return { kind, ...Object.fromEntries(Object.keys(KINDS[kind].fields).map((k) => [k, inputs[k]])) };
}

/** Return the points `[r, f]` of the profile up to about `reach`, of a table at least four. */
export function outline(profile, reach) {
  if (profile.kind === "tabulated") {
    const lowest = Math.min(...profile.f);
    const points = profile.r.map((r, i) => [Math.abs(r), profile.f[i] - lowest]).sort(([a], [b]) => a - b);
    return points.filter(([r], i) => i < 4 || r <= reach * 1.5);
  }
  const points = [];
  for (let i = 0; i <= 120; i++) {
    const r = (reach * i) / 120;
    const f = KINDS[profile.kind].f(r, profile);
    if (!Number.isFinite(f)) break;
    points.push([r, f]);
  }
  return points;
}
