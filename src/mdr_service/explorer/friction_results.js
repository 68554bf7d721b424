// Results of contacts with a tangential load: pushed, along a path of loads, and in an impact.

import { basics, pathPoints } from "./inputs.js";
import { massOf } from "./materials.js";
import { fieldChart, fieldsOf, normalForce, numbersOf, pushed, relationChart, shearStressChart, single, surfaceStress } from "./parts.js";
import { QUANTITIES } from "./quantities.js";
import { Refusal } from "./requests.js";

const SAMPLES_PER_STEP = 40;

/** Return the twists about the axis, in place of the tangential load, until a twentieth of the radius sticks. */
function twisted(query, { profile, material, load, friction_coefficient }, radius) {
  const sticks = Array.from({ length: 40 }, (_, i) => radius * (1 - 0.95 * ((i + 1) / 40) ** 2));
  const body = { profile, material, load, friction_coefficient, torsion: { stick_radius: sticks } };
  return query("Twist", "v1/torsion", body);
}

export async function solvePush(inputs, query) {
  const force = await normalForce(inputs, query);
  const base = pushed(inputs, force);
  const limit = inputs.mu * force;
  const forces = Array.from({ length: 61 }, (_, i) => limit * (1 - (1 - i / 60) ** 2));
  const solved = query("State", "v1/tangential", base);
  const [state, twist, curve, field] = await Promise.all([
    solved,
    solved.then(({ contact_radius: [radius] }) => twisted(query, base, radius)),
    query("Curve", "v1/tangential", { ...base, tangential: { tangential_force: forces } }),
    fieldsOf(query, "Fields", base, ["pressure", "shear_stress", "slip"]),
  ]);
  const now = single(state);
  const size = { ...now, tangential_force: Math.abs(now.tangential_force) };
  const edges = [["c", now.stick_radius], ["a", now.contact_radius]];
  // Outside the contact, slip has no meaning.
  const slip = field.slip[0].map((value, i) => (field.radius[i] > now.contact_radius ? NaN : value));
  return {
    responses: [state, twist, curve, field],
    known: now,
    numbers: [
      ...numbersOf(now, ["stick_radius", "tangential_displacement"]),
      ["Regime", now.regime.replace("_", " ")],
      ...numbersOf(now, [
        "contact_radius", "slip_width", "tangential_force", "tangential_stiffness", "dissipated_energy",
      ]),
      ...numbersOf(single(twist), ["torsion_arm"]),
    ],
    charts: [
      shearStressChart("Fields", field, inputs.mu, edges),
      relationChart(
        "Curve", "Tangential force against displacement", curve,
        ["tangential_displacement", "tangential_force"], now,
      ),
      relationChart(
        "Curve", "Stick radius against tangential force", curve, ["tangential_force", "stick_radius"], size,
      ),
      fieldChart("Fields", "Slip", "slip", edges, field.radius, [{ name: "slip", y: slip }]),
      {
        request: "Twist", title: "Twist instead: torque against rotation", x: QUANTITIES.rotation, y: QUANTITIES.torque,
        traces: [{ name: "torque", x: [0, ...twist.rotation], y: [0, ...twist.torque] }],
      },
    ],
  };
}

export async function solveCycle(inputs, query) {
  const points = pathPoints(inputs);
  const history = {
    normal: { [inputs.normal]: points.map(([normal]) => normal) },
    tangential: { [inputs.tangential]: points.map(([, tangential]) => tangential) },
    samples_per_step: SAMPLES_PER_STEP,
  };
  const body = { ...basics(inputs), friction_coefficient: inputs.mu, history };
  const [path, field] = await Promise.all([
    query("History", "v1/tangential/history", body),
    fieldsOf(query, "Fields at the end", body, ["pressure", "shear_stress", "slip"]),
  ]);
  const end = single(path, -1);
  // A straight step leaves one front at most; more of them belong to the samples of a curve.
  const fronts = path.slip_fronts.length > points.length ? [] : path.slip_fronts;
  const edges = [...fronts.map((r) => ["", r]), ["a", end.contact_radius]];
  const position = path.step.map((_, i) => (i + 1) / SAMPLES_PER_STEP);
  const surface = end.contact_radius > 0
    ? [await surfaceStress(query, inputs, body, end.contact_radius, edges)]
    : [];
  // The last point where the load was that of the end closes a cycle.
  const closed = points.slice(0, -1).findLastIndex((point) => point.join() === points.at(-1).join());
  const energyThere = path.dissipated_energy[(closed + 1) * SAMPLES_PER_STEP - 1];
  // Several loops within each other end where they began, too.
  const loop = points.slice(Math.max(closed, 0));
  const ways = loop.slice(1).map(([, t], i) => Math.sign(t - loop[i][1])).filter(Boolean);
  const isOne = ways.filter((way, i) => i && way !== ways[i - 1]).length < 3;
  const name = closed < 0 || isOne ? "Energy per cycle" : `Energy of the loops from point ${closed + 1}`;
  return {
    responses: [path, field, ...surface.map(({ response }) => response)],
    known: end,
    numbers: [
      [name, ...(closed < 0 ? ["no closed loop"] : [end.dissipated_energy - energyThere, "energy"])],
      ...numbersOf(end, ["tangential_displacement", "dissipated_energy"]),
      ...surface.flatMap(({ numbers }) => numbers),
      ["Regime at the end", end.regime.replace("_", " ")],
      ...numbersOf(end, ["contact_radius", "normal_force", "tangential_force"]),
    ],
    charts: [
      relationChart(
        "History", "Hysteresis", path, ["tangential_displacement", "tangential_force"], end,
        { mark: "end" },
      ),
      shearStressChart("Fields at the end", field, inputs.mu, edges),
      {
        request: "History", title: "Dissipated energy along the path",
        x: ["Point of the path", "1"], y: QUANTITIES.dissipated_energy,
        traces: [{ name: "dissipated energy", x: position, y: path.dissipated_energy }],
      },
      ...surface.map(({ chart }) => chart),
    ],
  };
}

export async function solveImpact(inputs, query) {
  const mass = massOf(inputs);
  if (mass === undefined) {
    const detail = "is needed: shape and material do not determine it";
    throw new Refusal({ title: "Invalid request", errors: [{ pointer: "/normal_mass", detail }] });
  }
  const body = {
    ...basics(inputs), friction_coefficient: inputs.mu,
    normal_mass: mass, tangential_mass: inputs.share * mass, normal_velocity: inputs.approach,
  };
  // Beyond some twice this velocity every body slides throughout.
  const sliding = (2 * inputs.mu * inputs.approach) / inputs.share;
  const most = Math.max(2 * sliding, 1.2 * Math.abs(inputs.along));
  const before = Array.from({ length: 41 }, (_, i) => (most * i) / 40);
  const [hit, curve] = await Promise.all([
    query("Impact", "v1/tangential/impact", { ...body, tangential_velocity: inputs.along }),
    query("Curve", "v1/tangential/impact", { ...body, tangential_velocity: before }),
  ]);
  const now = single(hit);
  const sign = Math.sign(inputs.along) || 1;
  const size = {
    ...now, tangential_velocity: Math.abs(inputs.along),
    tangential_rebound_velocity: sign * now.tangential_rebound_velocity,
  };
  const energy = (body.tangential_mass * inputs.along ** 2) / 2;
  return {
    responses: [hit, curve],
    known: {},
    numbers: [
      ...numbersOf(now, ["tangential_rebound_velocity", "maximum_normal_force"]),
      ["Regime", now.regime === "full_slip" ? "slides throughout" : now.regime.replace("_", " ")],
      ...numbersOf(now, ["duration", "maximum_indentation_depth", "dissipated_energy"]),
      ["Dissipated share of the tangential energy", energy && now.dissipated_energy / energy, "1"],
    ],
    charts: [
      relationChart(
        "Curve", "Rebound against incidence", curve,
        ["tangential_velocity", "tangential_rebound_velocity"], size, { mark: "this impact" },
      ),
      relationChart(
        "Curve", "Dissipated energy against incidence", curve,
        ["tangential_velocity", "dissipated_energy"], size, { mark: "this impact" },
      ),
    ],
  };
}
