// Parts of the results of several analyses: requests, numbers and charts.

import { basics } from "./inputs.js";
import { QUANTITIES } from "./quantities.js";
import { Refusal } from "./requests.js";

const POINTS = 400;
export const ALONG = ["x, along the tangential force", "length"];

/** Return the normal force of the load, by which all other requests give it. */
export async function normalForce(inputs, query) {
  if (inputs.control === "normal_force") return inputs.load;
  const load = { [inputs.control]: inputs.load };
  return (await query("Contact", "v1/normal", { ...basics(inputs), load })).normal_force[0];
}

function withoutFriction() {
  const detail = "is 0, and nothing sticks: use Press, or Stress without a tangential load";
  return new Refusal({ title: "Invalid request", errors: [{ pointer: "/friction_coefficient", detail }] });
}

/** Return the members of a request about a tangential load, prescribed by `control`, under a normal force. */
export function pushed(inputs, force, control = inputs.push) {
  if (control === "none") return { ...basics(inputs), load: { normal_force: force } };
  if (inputs.mu === 0) throw withoutFriction();
  const tangential = control === "ratio"
    ? { tangential_force: inputs.amount * inputs.mu * force }
    : { [control]: inputs.amount };
  return { ...basics(inputs), load: { normal_force: force }, friction_coefficient: inputs.mu, tangential };
}

/** Return the fields of a stress query against the radius. */
export function fieldsOf(query, name, body, quantities) {
  return query(name, "v1/stress", { ...body, points: POINTS, quantities });
}

/** Return a response with the value of one load in place of each array. */
export function single(response, index = 0) {
  const scalar = ([key, value]) => [key, Array.isArray(value) ? value.at(index) : value];
  return Object.fromEntries(Object.entries(response).map(scalar));
}

export function numbersOf(state, names) {
  return names.map((name) => [QUANTITIES[name][0], state[name], QUANTITIES[name][1]]);
}

/**
 * Return the stress σ_xx on the surface along the tangential force, where fretting fatigue begins:
 * its request, its largest value, and its chart with the edges of zones.
 */
export async function surfaceStress(query, inputs, body, radius, edges) {
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

export const marker = (name, x, y) => ({ name, x: [x], y: [y], mode: "markers", role: "marker" });

/** Return the chart of a quantity against another one, with a mark at the state of the contact. */
export function relationChart(request, title, response, [x, y], state, { mark = "this load", ...options } = {}) {
  const [xAxis, yAxis] = [QUANTITIES[x], QUANTITIES[y]];
  const traces = [
    { name: yAxis[0], x: response[x], y: response[y] }, marker(mark, state[x], state[y]),
  ];
  return { request, title, x: xAxis, y: yAxis, traces, ...options };
}

/** Return the chart of a quantity against the radius, with its curves and the edges of zones. */
export function fieldChart(request, title, quantity, edges, radius, traces, options) {
  return {
    request, title, edges, linked: true, x: QUANTITIES.radius, y: QUANTITIES[quantity],
    traces: traces.map((trace) => ({ x: radius, ...trace })), ...options,
  };
}

export function pressureChart(request, { radius, pressure }, edges, options) {
  const traces = [{ name: "pressure", y: pressure[0], fill: true }];
  return fieldChart(request, "Pressure", "pressure", edges, radius, traces, options);
}

export function shearStressChart(request, field, mu, edges) {
  const envelope = field.pressure[0].map((p) => (p === null ? null : mu * p));
  return fieldChart(request, "Shear stress", "shear_stress", edges, field.radius, [
    { name: "shear stress", y: field.shear_stress[0], fill: true },
    { name: "limit µp", y: envelope, role: "limit" },
  ]);
}
