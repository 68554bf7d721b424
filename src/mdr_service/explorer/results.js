// The results of the analyses: requests, and the numbers and charts of their responses.

import { basics, pathPoints } from "./inputs.js";

const POINTS = 400;

/** Return the normal force of the load, by which all other requests give it. */
async function normalForce(inputs, query) {
  if (inputs.control === "normal_force") return inputs.load;
  const load = { [inputs.control]: inputs.load };
  return (await query("Contact", "v1/normal", { ...basics(inputs), load })).normal_force[0];
}

/** Return the tangential load on the wire; a share of the limiting force needs the normal force. */
function pushOf(inputs, force) {
  if (inputs.push !== "ratio") return { [inputs.push]: inputs.amount };
  return { tangential_force: inputs.amount * inputs.mu * force };
}

/** Return a response with the value of one load in place of each array. */
function single(response, index = 0) {
  const scalar = ([key, value]) => [key, Array.isArray(value) ? value.at(index) : value];
  return Object.fromEntries(Object.entries(response).map(scalar));
}

const marker = (name, x, y) => ({ name, x: [x], y: [y], mode: "markers", role: "marker" });

export async function solvePress(inputs, query) {
  const force = await normalForce(inputs, query);
  const forces = Array.from({ length: 60 }, (_, i) => force * ((i + 1) / 60) ** 2);
  const [curve, field] = await Promise.all([
    query("Curve", "v1/normal", { ...basics(inputs), load: { normal_force: forces } }),
    query("Pressure", "v1/stress", {
      ...basics(inputs), load: { normal_force: force }, points: POINTS, quantities: ["pressure"],
    }),
  ]);
  const now = single(curve, -1);
  return {
    responses: [curve, field],
    known: now,
    numbers: [
      ["Contact radius a", now.contact_radius, "length"],
      ["Indentation depth d", now.indentation_depth, "displacement"],
      ["Normal force", now.normal_force, "force"],
      ["Mean pressure", now.mean_pressure, "pressure"],
      ["Maximum pressure", now.maximum_pressure, "pressure"],
      ["Normal stiffness", now.normal_stiffness, "stiffness"],
      ["Elastic energy", now.elastic_energy, "energy"],
    ],
    charts: [
      pressureChart("Pressure", field, [["a", now.contact_radius]], "wide"),
      {
        id: "force-depth", request: "Curve", title: "Force over depth",
        x: ["Indentation depth", "displacement"], y: ["Normal force", "force"],
        traces: [
          { name: "force", x: [0, ...curve.indentation_depth], y: [0, ...curve.normal_force] },
          marker("this load", now.indentation_depth, now.normal_force),
        ],
      },
      {
        id: "radius-force", request: "Curve", title: "Contact radius over force",
        x: ["Normal force", "force"], y: ["Contact radius", "length"],
        traces: [
          { name: "contact radius", x: curve.normal_force, y: curve.contact_radius },
          marker("this load", now.normal_force, now.contact_radius),
        ],
      },
    ],
  };
}

function pressureChart(request, field, edges, size) {
  return {
    id: "pressure", request, title: "Pressure", size, linked: true, edges,
    x: ["Radius", "length"], y: ["Pressure", "pressure"],
    traces: [{ name: "pressure", x: field.radius, y: field.pressure[0], fill: true }],
  };
}

function shearStressChart(request, field, mu, edges) {
  const envelope = field.pressure[0].map((p) => (p === null ? null : mu * p));
  return {
    id: "shear-stress", request, title: "Shear stress", linked: true, edges,
    x: ["Radius", "length"], y: ["Shear stress", "pressure"],
    traces: [
      { name: "shear stress", x: field.radius, y: field.shear_stress[0], fill: true },
      { name: "limit µp", x: field.radius, y: envelope, role: "limit" },
    ],
  };
}

/** Return a field with gaps outside the contact, where it means nothing. */
function within(field, contactRadius, quantity) {
  return field[quantity][0].map((value, i) => (field.radius[i] > contactRadius ? null : value));
}

export async function solvePush(inputs, query) {
  const force = await normalForce(inputs, query);
  const limit = inputs.mu * force;
  const base = { ...basics(inputs), load: { normal_force: force }, friction_coefficient: inputs.mu };
  const shares = Array.from({ length: 61 }, (_, i) => 1 - (1 - i / 60) ** 2);
  const tangential = pushOf(inputs, force);
  const [state, curve, field] = await Promise.all([
    query("State", "v1/tangential", { ...base, tangential }),
    query("Curve", "v1/tangential", {
      ...base, tangential: { tangential_force: shares.map((share) => share * limit) },
    }),
    query("Fields", "v1/stress", {
      ...base, tangential, points: POINTS, quantities: ["pressure", "shear_stress", "slip"],
    }),
  ]);
  const now = single(state);
  const edges = [["c", now.stick_radius], ["a", now.contact_radius]];
  return {
    responses: [state, curve, field],
    known: now,
    numbers: [
      ["Regime", now.regime.replace("_", " ")],
      ["Stick radius c", now.stick_radius, "length"],
      ["Contact radius a", now.contact_radius, "length"],
      ["Slip width a − c", now.slip_width, "length"],
      ["Tangential force", now.tangential_force, "force"],
      ["Tangential displacement", now.tangential_displacement, "displacement"],
      ["Tangential stiffness", now.tangential_stiffness, "stiffness"],
      ["Dissipated energy", now.dissipated_energy, "energy"],
    ],
    charts: [
      shearStressChart("Fields", field, inputs.mu, edges),
      {
        id: "force-displacement", request: "Curve", title: "Tangential force over displacement",
        x: ["Tangential displacement", "displacement"], y: ["Tangential force", "force"],
        traces: [
          { name: "force", x: curve.tangential_displacement, y: curve.tangential_force },
          marker("this load", now.tangential_displacement, now.tangential_force),
        ],
      },
      {
        id: "stick-force", request: "Curve", title: "Stick radius over tangential force",
        x: ["Tangential force", "force"], y: ["Stick radius", "length"],
        traces: [
          { name: "stick radius", x: curve.tangential_force, y: curve.stick_radius },
          marker("this load", Math.abs(now.tangential_force), now.stick_radius),
        ],
      },
      {
        id: "slip", request: "Fields", title: "Slip", linked: true, edges,
        x: ["Radius", "length"], y: ["Slip", "displacement"],
        traces: [{ name: "slip", x: field.radius, y: within(field, now.contact_radius, "slip") }],
      },
    ],
  };
}

export async function solveCycle(inputs, query) {
  const points = pathPoints(inputs);
  const column = (i) => points.map((point) => point[i]);
  const body = {
    ...basics(inputs),
    friction_coefficient: inputs.mu,
    history: {
      normal: { [inputs.normal]: column(0) },
      tangential: { [inputs.tangential]: column(1) },
    },
  };
  const sampled = { ...body, history: { ...body.history, samples_per_step: 40 } };
  const [history, field] = await Promise.all([
    query("History", "v1/tangential/history", sampled),
    query("Fields at the end", "v1/stress", {
      ...body, points: POINTS, quantities: ["pressure", "shear_stress", "slip"],
    }),
  ]);
  const last = (values) => values[values.length - 1];
  const edges = [...history.slip_fronts.map((r) => ["", r]), ["a", last(history.contact_radius)]];
  const position = history.step.map((_, i) => (i + 1) / 40);
  return {
    responses: [history, field],
    known: { contact_radius: last(history.contact_radius) },
    numbers: [
      ["Regime at the end", last(history.regime).replace("_", " ")],
      ["Contact radius a", last(history.contact_radius), "length"],
      ["Normal force", last(history.normal_force), "force"],
      ["Tangential force", last(history.tangential_force), "force"],
      ["Tangential displacement", last(history.tangential_displacement), "displacement"],
      ["Dissipated energy", last(history.dissipated_energy), "energy"],
    ],
    charts: [
      {
        id: "loop", request: "History", title: "Hysteresis", size: "wide",
        x: ["Tangential displacement", "displacement"], y: ["Tangential force", "force"],
        traces: [
          { name: "path", x: history.tangential_displacement, y: history.tangential_force },
          marker("end", last(history.tangential_displacement), last(history.tangential_force)),
        ],
      },
      shearStressChart("Fields at the end", field, inputs.mu, edges),
      {
        id: "dissipation", request: "History", title: "Dissipated energy along the path",
        x: ["Point of the path", "1"], y: ["Dissipated energy", "energy"],
        traces: [{ name: "dissipated energy", x: position, y: history.dissipated_energy }],
      },
    ],
  };
}

export async function solveStress(inputs, query) {
  const force = await normalForce(inputs, query);
  const tangential = pushOf(inputs, force);
  const base = {
    ...basics(inputs), load: { normal_force: force }, friction_coefficient: inputs.mu, tangential,
  };
  const material = { ...base.material, yield_strength: inputs.yield };
  const [contact, field, map] = await Promise.all([
    query("Contact", "v1/normal", { ...basics(inputs), load: { normal_force: force } }),
    query("Surface", "v1/stress", {
      ...base, points: POINTS, quantities: ["pressure", "shear_stress", "normal_displacement"],
    }),
    query("Beneath", "v1/subsurface", {
      ...base, material, body: inputs.body, points: 61, quantities: ["von_mises"], largest: true,
    }),
  ]);
  const now = single(contact);
  const [mises, shear] = [single(map.largest.von_mises), single(map.largest.maximum_shear)];
  const edges = [["a", now.contact_radius]];
  return {
    responses: [contact, field, map],
    known: now,
    numbers: [
      ["Largest von Mises stress", mises.value, "pressure"],
      ["… at depth z", mises.z, "length"],
      ["… at x", mises.x, "length"],
      ["Largest shear stress", shear.value, "pressure"],
      ["Yield begins at, von Mises", map.yield_onset_force.von_mises[0], "force"],
      ["Yield begins at, Tresca", map.yield_onset_force.tresca[0], "force"],
      ["Maximum pressure", now.maximum_pressure, "pressure"],
      ["Contact radius a", now.contact_radius, "length"],
    ],
    charts: [
      {
        id: "map", request: "Beneath", title: "Von Mises stress beneath the surface", size: "wide", map: true, edges,
        x: ["x, along the tangential force", "length"], y: ["Depth z", "length"],
        z: ["von Mises stress", "pressure"],
        traces: [
          { name: "von Mises stress", x: map.x, y: map.z, z: map.von_mises[0] },
          marker("largest", mises.x, mises.z),
        ],
      },
      pressureChart("Surface", field, edges),
      shearStressChart("Surface", field, inputs.mu, edges),
      {
        id: "displacement", request: "Surface", title: "Normal displacement of the surface", linked: true, edges, size: "wide",
        x: ["Radius", "length"], y: ["Displacement", "displacement"],
        traces: [{ name: "displacement", x: field.radius, y: field.normal_displacement[0] }],
      },
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
  const at = cycles.indexOf(inputs.cycles);
  const course = await query("Evolution", "v1/wear/evolution", {
    ...body, wear_coefficient: inputs.wear, cycles, points: 200,
  });
  const limit = await query("Limit", "v1/wear", { ...body, radius: course.radius });
  const depth = (profile) => profile.map((f, i) => f - limit.initial_profile[i]);
  const now = single(limit);
  const edges = [["c", now.stick_radius], ["ã", now.wear_radius]];
  return {
    responses: [limit, course],
    known: {
      contact_radius: course.contact_radius[at],
      normal_force: course.normal_force[at],
      indentation_depth: course.indentation_depth[at],
    },
    numbers: [
      ["Worn volume", course.worn_volume[at], "volume"],
      ["Worn volume in the limit", now.worn_volume, "volume"],
      ["Contact radius", course.contact_radius[at], "length"],
      ["Wear radius ã in the limit", now.wear_radius, "length"],
      ["Stick radius c", now.stick_radius, "length"],
      ["Indentation depth", course.indentation_depth[at], "displacement"],
      ["Normal force", course.normal_force[at], "force"],
      ["Dissipated energy", course.dissipated_energy[at], "energy"],
    ],
    charts: [
      {
        id: "worn-profile", request: "Evolution", title: "Profile", linked: true, edges,
        x: ["Radius", "length"], y: ["Height", "displacement"],
        traces: [
          { name: "after these cycles", x: course.radius, y: course.profile[at] },
          { name: "unworn", x: course.radius, y: limit.initial_profile, role: "limit" },
          { name: "limit", x: course.radius, y: limit.limiting_profile[0], role: "second" },
        ],
      },
      {
        id: "worn-depth", request: "Evolution", title: "Worn depth", linked: true, edges,
        x: ["Radius", "length"], y: ["Depth", "displacement"],
        traces: [
          { name: "after these cycles", x: course.radius, y: depth(course.profile[at]) },
          { name: "limit", x: course.radius, y: depth(limit.limiting_profile[0]), role: "limit" },
        ],
      },
      {
        id: "pressure", request: "Evolution", title: "Pressure after these cycles", linked: true, edges,
        x: ["Radius", "length"], y: ["Pressure", "pressure"],
        traces: [{ name: "pressure", x: course.radius, y: course.pressure[at], fill: true }],
      },
      {
        id: "worn-volume", request: "Evolution", title: "Worn volume over the cycles", logarithmic: true,
        x: ["Cycles", "1"], y: ["Worn volume", "volume"],
        traces: [
          { name: "worn volume", x: course.cycles, y: course.worn_volume },
          marker("these cycles", inputs.cycles, course.worn_volume[at]),
        ],
      },
    ],
  };
}
