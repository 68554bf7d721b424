// The results of the analyses: requests, and the numbers and charts of their responses.

import { basics, hasLayer, pathPoints } from "./inputs.js";
import { massOf, strengthOf } from "./materials.js";
import { QUANTITIES } from "./quantities.js";
import { Refusal } from "./requests.js";
import { inMetres, inSI } from "./shapes.js";
import { quantity } from "./units.js";

const POINTS = 400;
const SAMPLES_PER_STEP = 40;
// Relative change of a result up to which a model without an effect counts as good.
const WITHIN = 0.01;
const ALONG = ["x, along the tangential force", "length"];

/** Return the normal force of the load, by which all other requests give it. */
async function normalForce(inputs, query) {
  if (inputs.control === "normal_force") return inputs.load;
  const load = { [inputs.control]: inputs.load };
  return (await query("Contact", "v1/normal", { ...basics(inputs), load })).normal_force[0];
}

function withoutFriction() {
  const detail = "is 0, and nothing sticks: a contact without friction belongs to Press, or to Stress without tangential load";
  return new Refusal({ title: "Invalid request", errors: [{ pointer: "/friction_coefficient", detail }] });
}

/** Return the members of a request about a tangential load, prescribed by `control`, under a normal force. */
function pushed(inputs, force, control = inputs.push) {
  if (control === "none") return { ...basics(inputs), load: { normal_force: force } };
  if (inputs.mu === 0) throw withoutFriction();
  const tangential = control === "ratio"
    ? { tangential_force: inputs.amount * inputs.mu * force }
    : { [control]: inputs.amount };
  return { ...basics(inputs), load: { normal_force: force }, friction_coefficient: inputs.mu, tangential };
}

/** Return the fields of a stress query against the radius. */
function fieldsOf(query, name, body, quantities) {
  return query(name, "v1/stress", { ...body, points: POINTS, quantities });
}

/** Return a response with the value of one load in place of each array. */
function single(response, index = 0) {
  const scalar = ([key, value]) => [key, Array.isArray(value) ? value.at(index) : value];
  return Object.fromEntries(Object.entries(response).map(scalar));
}

function numbersOf(state, names) {
  return names.map((name) => [QUANTITIES[name][0], state[name], QUANTITIES[name][1]]);
}

/**
 * Return the stress σ_xx on the surface along the tangential force, where fretting fatigue begins:
 * its request, its largest value, and its chart with the edges of zones.
 */
async function surfaceStress(query, inputs, body, radius, edges) {
  const even = Array.from({ length: 161 }, (_, i) => radius * (i / 40 - 2));
  const at = new Set([...even, ...edges.flatMap(([, r]) => [-r, r])]);
  const { x, stress_xx: stress, ...response } = await query("Along the surface", "v1/subsurface", {
    ...body, body: inputs.body, x: [...at].sort((a, b) => a - b), z: [0], quantities: ["stress_xx"],
  });
  const chart = {
    request: "Along the surface", title: "Stress σ_xx along the surface", edges, mirrored: true,
    x: ALONG, y: [`σ_xx in body ${inputs.body}`, "pressure"], traces: [{ name: "σ_xx", x, y: stress[0][0] }],
  };
  // At a sharp edge or tip it is infinite, in tension or compression.
  const isFinite = !stress[0][0].includes(null);
  const numbers = isFinite ? [[`Largest σ_xx, body ${inputs.body}`, Math.max(...stress[0][0]), "pressure"]] : [];
  return { response, chart, numbers };
}

const marker = (name, x, y) => ({ name, x: [x], y: [y], mode: "markers", role: "marker" });

/** Return the chart of a quantity against another one, with a mark at the state of the contact. */
function relationChart(request, title, response, [x, y], state, { mark = "this load", ...options } = {}) {
  const [xAxis, yAxis] = [QUANTITIES[x], QUANTITIES[y]];
  const traces = [
    { name: yAxis[0], x: response[x], y: response[y] }, marker(mark, state[x], state[y]),
  ];
  return { request, title, x: xAxis, y: yAxis, traces, ...options };
}

/** Return the chart of a quantity against the radius, with its curves and the edges of zones. */
function fieldChart(request, title, quantity, edges, radius, traces, options) {
  return {
    request, title, edges, linked: true, x: QUANTITIES.radius, y: QUANTITIES[quantity],
    traces: traces.map((trace) => ({ x: radius, ...trace })), ...options,
  };
}

function pressureChart(request, { radius, pressure }, edges, options) {
  const traces = [{ name: "pressure", y: pressure[0], fill: true }];
  return fieldChart(request, "Pressure", "pressure", edges, radius, traces, options);
}

function shearStressChart(request, field, mu, edges) {
  const envelope = field.pressure[0].map((p) => (p === null ? null : mu * p));
  return fieldChart(request, "Shear stress", "shear_stress", edges, field.radius, [
    { name: "shear stress", y: field.shear_stress[0], fill: true },
    { name: "limit µp", y: envelope, role: "limit" },
  ]);
}

/**
 * Return the equilibrium states between first contact and the pull-off under a depth, which are
 * unstable, or nothing under a flat end: those of the contact without adhesion, less the retraction,
 * in proportion to the root of the contact radius.
 */
async function unstableStates(query, { profile, material }, curve) {
  const [radius, retraction] = [curve.contact_radius[0], curve.retraction[0]];
  const deepest = curve.indentation_depth[0] + retraction;
  if (deepest < 1e-9 * retraction) return [];
  const depths = Array.from({ length: 41 }, (_, i) => deepest * (i / 40) ** 2);
  const load = { indentation_depth: depths };
  const { contact_radius, normal_stiffness, ...free } = await query("Without adhesion", "v1/normal", { profile, material, load });
  const steps = contact_radius.map((a) => retraction * Math.sqrt(a / radius));
  const lessOf = (values, by) => values.map((value, i) => value - by(i));
  return [{
    contact_radius,
    indentation_depth: lessOf(free.indentation_depth, (i) => steps[i]),
    normal_force: lessOf(free.normal_force, (i) => normal_stiffness[i] * steps[i]),
  }];
}

/** Return an adhesive contact, with its states on both sides of the pull-off under a depth. */
async function solveAdhesive(inputs, query) {
  const { profile, material } = basics(inputs);
  const body = { profile, material: { ...material, work_of_adhesion: inputs.w } };
  const contact = await query("Contact", "v1/normal", { ...body, load: { [inputs.control]: inputs.load } });
  const now = single(contact);
  const { pull_off_depth: least, pull_off_force: weakest } = now;
  // Past the load of the form, but not past the largest contact with a layer.
  const span = Math.max(now.indentation_depth, -least) * (hasLayer(inputs) ? 1 : 1.2) - least;
  const depths = Array.from({ length: 61 }, (_, i) => least + span * (i / 60) ** 2);
  // A force has another state than a depth below the pull-off under force.
  const same = inputs.kind === "flat_punch" ? "normal_force" : "contact_radius";
  const [curve, field] = await Promise.all([
    query("Curve", "v1/normal", { ...body, load: { indentation_depth: depths } }),
    fieldsOf(query, "Pressure", { ...body, load: { [same]: now[same] } }, ["pressure"]),
  ]);
  // The retraction of a layer is not in that proportion.
  const unstable = hasLayer(inputs) ? [] : await unstableStates(query, { profile, material }, curve);
  const at = curve.normal_force.indexOf(Math.min(...curve.normal_force));
  // The last points that a prescribed force and a prescribed depth reach.
  const ends = { ...single(curve, at), normal_force: weakest };
  const chart = (title, [x, y]) => {
    const drawn = relationChart("Curve", title, curve, [x, y], now);
    const others = unstable.map((states) => ({ name: "unstable", x: states[x], y: states[y], role: "limit" }));
    const pullOff = { ...marker("pull-off", ends[x], ends[y]), role: "second" };
    return { ...drawn, traces: [...drawn.traces, ...others, pullOff] };
  };
  return {
    // The curve begins at the pull-off, next to which the radius is ill-conditioned.
    responses: [contact, field],
    known: now,
    numbers: numbersOf(now, [
      "contact_radius", "pull_off_force", "pull_off_depth", "indentation_depth", "normal_force", "maximum_pressure",
      "normal_stiffness", "elastic_energy", "retraction",
    ]),
    charts: [
      pressureChart("Pressure", field, [["a", now.contact_radius]], { size: "wide" }),
      chart("Force against depth", ["indentation_depth", "normal_force"]),
      chart("Contact radius against force", ["normal_force", "contact_radius"]),
    ],
  };
}

// Effect of `holds_while` -> label and dimension of its limit.
const LIMITED = {
  adhesion: ["adhesion", "N/m"], slip: ["tangential force", "1"], thickness: ["thickness", "length"],
  yield: ["yield strength", "pressure"],
};

/**
 * Return a sentence with the limits up to which the effects that the model leaves out change the
 * results of the last load by no more than a relative tolerance, or nothing without a load. The
 * shape is no such effect: the page computes with the one that is chosen.
 */
export function limitWords({ holds_while: limits, normal_force: forces }, within, inputs) {
  const force = forces.at(-1);
  const words = limits.filter(({ effect }) => LIMITED[effect]).map(({ effect, below, above }) => {
    const [[label, dimension], value] = [LIMITED[effect], (below ?? above).at(-1)];
    const isShare = effect === "slip";
    const size = quantity(isShare ? value / force : value, dimension, inputs, 2);
    return `${label} ${below ? "below" : "above"} ${size}${isShare ? " µF_N" : ""}`;
  });
  return force > 0 ? `Within ${100 * within} %: ${words.join(", ")}.` : "";
}

export async function solvePress(inputs, query) {
  if (inputs.w !== 0) return solveAdhesive(inputs, query);
  const force = await normalForce(inputs, query);
  const forces = Array.from({ length: 60 }, (_, i) => force * ((i + 1) / 60) ** 2);
  // The limits are known of half-spaces.
  const within = hasLayer(inputs) ? {} : { holds_within: WITHIN };
  const [curve, field] = await Promise.all([
    query("Curve", "v1/normal", { ...basics(inputs), load: { normal_force: forces }, ...within }),
    fieldsOf(query, "Pressure", { ...basics(inputs), load: { normal_force: force } }, ["pressure"]),
  ]);
  const now = single(curve, -1);
  const { indentation_depth: depths, normal_force: reached } = curve;
  const fromZero = { indentation_depth: [0, ...depths], normal_force: [0, ...reached] };
  return {
    responses: [curve, field],
    known: now,
    numbers: numbersOf(now, [
      "contact_radius", "maximum_pressure", "indentation_depth", "normal_force", "mean_pressure",
      "normal_stiffness", "elastic_energy",
    ]),
    limits: curve.holds_while ? limitWords(curve, WITHIN, inputs) : "",
    charts: [
      pressureChart("Pressure", field, [["a", now.contact_radius]], { size: "wide" }),
      relationChart("Curve", "Force against depth", fromZero, ["indentation_depth", "normal_force"], now),
      relationChart("Curve", "Contact radius against force", curve, ["normal_force", "contact_radius"], now),
    ],
  };
}

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
    const detail = "is needed: the shape or the material leaves it open";
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

export async function solveStress(inputs, query) {
  const force = await normalForce(inputs, query);
  const base = pushed(inputs, force, inputs.shear);
  const strength = strengthOf(inputs, inputs.body);
  const material = { ...base.material, ...(strength === undefined ? {} : { yield_strength: strength }) };
  const sheared = inputs.shear === "none" ? [] : ["shear_stress"];
  const solved = query("Contact", "v1/normal", { ...basics(inputs), load: { normal_force: force } });
  const alongSurface = solved.then((contact) => {
    const radius = contact.contact_radius[0];
    return surfaceStress(query, inputs, base, radius, [["a", radius]]);
  });
  const [contact, surface, field, map] = await Promise.all([
    solved,
    alongSurface,
    fieldsOf(query, "Surface", base, ["pressure", ...sheared, "normal_displacement"]),
    query("Beneath", "v1/subsurface", {
      ...base, material, body: inputs.body, points: 61, quantities: ["von_mises"], largest: true,
    }),
  ]);
  const now = single(contact);
  const [mises, shear] = [single(map.largest.von_mises), single(map.largest.maximum_shear)];
  const edges = [["a", now.contact_radius]];
  const displacement = [{ name: "displacement", y: field.normal_displacement[0] }];
  const onset = (criterion) =>
    map.yield_onset_force ? [map.yield_onset_force[criterion][0], "force"] : ["needs a yield strength"];
  return {
    responses: [contact, field, map, surface.response],
    known: now,
    numbers: [
      ["Largest von Mises stress", mises.value, "pressure"],
      ["Yield begins at, von Mises", ...onset("von_mises")],
      ["Depth z of the largest stress", mises.z, "length"],
      ["x of the largest stress", mises.x, "length"],
      ["Largest shear stress", shear.value, "pressure"],
      ["Yield begins at, Tresca", ...onset("tresca")],
      ...surface.numbers,
      ...numbersOf(now, ["contact_radius"]),
    ],
    charts: [
      {
        request: "Beneath", title: "Von Mises stress beneath the surface", size: "wide", map: true, mirrored: true, edges,
        x: ALONG, y: ["Depth z", "length"],
        z: ["von Mises stress", "pressure"],
        traces: [
          { name: "von Mises stress", x: map.x, y: map.z, z: map.von_mises[0] },
          marker("largest", mises.x, mises.z),
        ],
      },
      pressureChart("Surface", field, edges),
      ...sheared.map(() => shearStressChart("Surface", field, inputs.mu, edges)),
      surface.chart,
      fieldChart(
        "Surface", "Normal displacement of the surface", "normal_displacement", edges, field.radius, displacement,
      ),
    ],
  };
}

export async function solveWear(inputs, query) {
  const body = {
    ...basics(inputs),
    load: { [inputs.control]: inputs.load },
    friction_coefficient: inputs.mu,
    oscillation: { [inputs.oscillation]: inputs.amplitude },
  };
  const decades = Array.from({ length: 17 }, (_, i) => 10 ** (i / 2));
  const cycles = [...new Set([...decades, inputs.cycles])].sort((a, b) => a - b);
  const course = await query("Evolution", "v1/wear/evolution", {
    ...body, wear_coefficient: inputs.wear, cycles, points: 200,
  });
  const { radius } = course;
  const limit = await query("Limit", "v1/wear", { ...body, radius });
  const [now, final] = [single(course, cycles.indexOf(inputs.cycles)), single(limit)];
  // The curve over the cycles goes beyond those of the form, where wear may end.
  const isWorn = now.worn_volume > 0.99 * course.worn_volume.at(-1);
  const warnings = course.warnings.filter(({ code }) => isWorn || code !== "limit_reached");
  // Unbounded wear has no limit, and outside a flat punch there is no profile.
  const depth = (profile) => profile.map((f, i) => {
    const unworn = limit.initial_profile[i];
    return f === null || unworn === null ? NaN : f - unworn;
  });
  const [stick, outer] = [now.stick_radius, now.contact_radius];
  const edges = [["c", stick], ["a", outer]];
  const width = outer - stick;
  // A narrow annulus fills a third of the chart.
  const range = width < 0.2 * outer ? [stick - width, outer + width] : undefined;
  // The radii reach as far as the contact after the largest number of cycles.
  const near = radius.at(-1) > 3 * outer ? { range: [0, 1.5 * outer] } : {};
  const hasLimit = final.worn_volume !== null;
  return {
    responses: [limit, { ...course, warnings }],
    known: now,
    numbers: [
      ...numbersOf(now, ["worn_volume", "contact_radius", "stick_radius"]),
      ["Worn volume in the limit", final.worn_volume, "volume"],
      ["Wear radius ã in the limit", final.wear_radius, "length"],
      ...numbersOf(now, ["indentation_depth", "normal_force", "dissipated_energy"]),
      ["Energy per cycle, mean", now.dissipated_energy / inputs.cycles, "energy"],
    ],
    charts: [
      fieldChart("Evolution", "Profile", "profile", edges, radius, [
        { name: "after these cycles", y: now.profile },
        { name: "unworn", y: limit.initial_profile, role: "limit" },
        ...(hasLimit ? [{ name: "limit", y: final.limiting_profile, role: "second" }] : []),
      ], near),
      fieldChart("Evolution", "Worn depth", "worn_depth", edges, radius, [
        { name: "after these cycles", y: depth(now.profile) },
        ...(hasLimit ? [{ name: "limit", y: depth(final.limiting_profile), role: "limit" }] : []),
      ], range ? { range } : near),
      fieldChart("Evolution", "Pressure after these cycles", "pressure", edges, radius, [
        { name: "pressure", y: now.pressure, fill: true },
      ], near),
      relationChart(
        "Evolution", "Worn volume against cycles", course, ["cycles", "worn_volume"], now,
        { mark: "these cycles", logarithmic: true },
      ),
    ],
  };
}

export async function solveFit(inputs, query) {
  const { depths, forces } = inSI(inputs.curve);
  const fit = ["e_star", ...(inputs.fitted === "none" ? [] : inputs.fitted.split(","))];
  const { profile, material } = basics(inputs);
  const found = await query("Fit", "v1/normal/fit", {
    profile, indentation_depth: depths, normal_force: forces, fit, body_thickness: material.body_thickness,
  });
  const values = fit.map((name, i) => {
    const [label, dimension] = QUANTITIES[name];
    const [value, error] = [found[name][0], found.standard_errors[i]];
    return [label, value, dimension, error];
  });
  // With adhesion some of the measured points are left out.
  const { indentation_depth: used } = found;
  const order = used.map((_, i) => i).sort((i, j) => used[i] - used[j]);
  const sorted = (column) => order.map((i) => column[i]);
  const x = sorted(used);
  const [xAxis, yAxis] = [QUANTITIES.indentation_depth, QUANTITIES.normal_force];
  const correlation = found.correlation[0][1];
  return {
    responses: [found],
    known: {},
    numbers: [
      ...values,
      ...(correlation === undefined ? [] : [["Correlation of E* and contact point", correlation, "1"]]),
      ["Scatter of the forces", found.noise[0], "force"],
      ["Residuals like noise, probability", found.misfit[0], "1"],
    ],
    charts: [
      {
        request: "Fit", title: "Force against depth", size: "wide", x: xAxis, y: yAxis,
        traces: [
          { name: "measured", x: depths, y: forces, mode: "markers", role: "second" },
          { name: "fit", x, y: sorted(found.normal_force) },
        ],
      },
      {
        request: "Fit", title: "Residual against depth", x: xAxis, y: ["Measured less fitted force", "force"],
        traces: [{ name: "residual", x, y: sorted(found.residual), mode: "markers" }],
      },
    ],
  };
}

/** Return a note if the contact is small against the spacing of a table's points, else nothing. */
export function noteOnUnits(inputs, contactRadius) {
  const { r } = inMetres(inputs.table);
  const spacing = (Math.max(...r) - Math.min(...r)) / (r.length - 1);
  if (inputs.kind !== "tabulated" || !(contactRadius > 0) || contactRadius > 2 * spacing) return [];
  const [a, h] = [contactRadius, spacing].map((x) => quantity(x, "length", inputs, 3));
  return [{ code: "units", message: `the contact radius, ${a}, is small against the spacing of the points, ${h}: check the units of the table` }];
}
