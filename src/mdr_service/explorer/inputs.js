// The inputs: one flat object of numbers and words in SI units, and its form in the address.

import { KINDS, measuredBall, measuredCurve, measuredLoop, wireProfile } from "./shapes.js";
import { CURVE, LENGTHS, PROFILE } from "./table_reader.js";
import { BASE_UNITS, numberOf } from "./units.js";

export const TABS = ["press", "push", "cycle", "impact", "stress", "wear", "fit"];
export const NORMAL = ["normal_force", "indentation_depth"];
export const TANGENTIAL = ["tangential_force", "tangential_displacement"];
export const RIGID = "rigid";
// First value of a load that no result tells.
const LOADS = { normal_force: 100, indentation_depth: 2e-6, contact_radius: 1e-4 };

const DEFAULTS = {
  tab: "press",
  kind: "paraboloid",
  e1: 2.1e11, nu1: 0.3, e2: 2.1e11, nu2: 0.3, thickness: "", base: "bonded",
  control: "normal_force", load: 100, w: 0,
  mu: 0.3, push: "ratio", shear: "none", amount: 0.7,
  normal: "normal_force", tangential: "tangential_force",
  path: "100,0;100,20;100,-20;100,20",
  measured: "curve", rig: "", rows: "", drift: "", from: "", to: "", fitted: "contact_point", mass: "", density: "", share: 2 / 7, approach: 0.1, along: 0.05,
  body: 1, yield1: "", yield2: "", loads: "",
  oscillation: "tangential_force", amplitude: 20, wear: 1e-13, cycles: 1e5,
  ul: "mm", ud: "µm", uf: "N", up: "MPa", um: "GPa",
};

const POINT = "contact_point", OFFSET = `${POINT},force_offset`;
const FITTED = [POINT, OFFSET, ...[POINT, OFFSET].map((names) => `${names},work_of_adhesion`)];

// Input that is chosen -> its choices.
const CHOICES = {
  tab: TABS, fitted: ["none", ...FITTED], kind: Object.keys(KINDS), push: ["ratio", ...TANGENTIAL],
  shear: ["none", "ratio", ...TANGENTIAL],
  normal: NORMAL, tangential: TANGENTIAL, oscillation: TANGENTIAL, body: [1, 2],
  base: ["bonded", "frictionless"], measured: ["curve", "loop"],
  ...Object.fromEntries(Object.values(BASE_UNITS).map(({ key, factors }) => [key, Object.keys(factors)])),
};
const optional = (text) => (text === "" ? text : number(text));
// Inputs that are lists of numbers, or that may be empty.
const OTHERS = {
  loads: (text) => (text === "" || text.split(",").every(isNumber) ? text : undefined),
  path: (text) => (pathPoints({ path: text }).every(isPoint) ? text : undefined),
  rows: (text) => (/^(\d+,\d+)?$/.test(text) ? text : undefined),
  drift: (text) => (text === "" || isPoint(text.split(",").map(numberOf)) ? text : undefined),
  breaks: (text) => (text === "" || text.split(",").every(isNumber) ? text : undefined),
  uncertainty: optional, thickness: optional, mass: optional, density: optional, yield1: optional, yield2: optional,
  rig: optional, from: optional, to: optional,
  e1: (text) => (text === RIGID ? text : number(text)),
  e2: (text) => (text === RIGID ? text : number(text)),
};

const isNumber = (text) => !Number.isNaN(numberOf(text));
const number = (text) => (isNumber(text) ? numberOf(text) : undefined);
const isPoint = (point) => point.length === 2 && !point.some(Number.isNaN);

/** Return the quantities by which the load of an analysis can be prescribed. */
export function controls(tab) {
  return ["wear", "fit"].includes(tab) ? NORMAL : [...NORMAL, "contact_radius"];
}

/** Return the inputs of a first visit. */
export function defaultInputs() {
  return { ...DEFAULTS, ...KINDS[DEFAULTS.kind].fields, table: measuredBall(), curve: measuredCurve() };
}

/** Return the example of a measured curve or loop. */
export function exampleOf(measured) {
  return measured === "loop" ? measuredLoop() : measuredCurve();
}

/** Return whether the measurement is a hysteresis loop. */
export function hasLoop(inputs) {
  return inputs.tab === "fit" && inputs.measured === "loop";
}

/** Return the value of an input that a text holds, or undefined if it is none that the page offers. */
function valueOf(key, text, tab) {
  const choices = key === "control" ? controls(tab) : CHOICES[key];
  if (choices) return choices.find((choice) => String(choice) === text);
  return (OTHERS[key] ?? number)(text);
}

/** Members of the fragment that hold the columns of a table and their units. */
const COLUMNS = { table: ["r", "f", "ur", "uf"], curve: ["d", "F", "ud", "uF"] };

function tableOf(fragment, [first, second, ...unitNames], kind) {
  const [r, f] = [first, second].map((name) => fragment.get(name)?.split(",").map(numberOf) ?? []);
  const units = unitNames.map((name, i) => fragment.get(name) ?? Object.keys(kind.units[i])[0]);
  const whole = r.length === f.length && ![...r, ...f].some(Number.isNaN);
  return whole && units.every((name, i) => Object.hasOwn(kind.units[i], name)) ? { r, f, units } : undefined;
}

/**
 * Return the inputs that the query string and the fragment of an address describe, and the names
 * of the members that hold nothing that the page offers. Anybody may have written the address.
 */
export function fromAddress(search, hash) {
  const given = new URLSearchParams(search);
  const fragment = new URLSearchParams(hash.slice(1));
  const inputs = defaultInputs();
  const unread = [];
  const set = (key, value) => (value === undefined ? unread.push(key) : (inputs[key] = value));
  const take = (key) => given.has(key) && set(key, valueOf(key, given.get(key), inputs.tab));
  take("tab");
  take("kind");
  Object.assign(inputs, KINDS[inputs.kind].fields);
  Object.keys(inputs).filter((key) => !["tab", "kind", "table", "curve"].includes(key)).forEach(take);
  inputs.curve = exampleOf(inputs.measured);
  for (const [key, kind] of [["table", PROFILE], ["curve", CURVE]]) {
    if (COLUMNS[key].some((name) => fragment.has(name))) set(key, tableOf(fragment, COLUMNS[key], kind));
  }
  if (inputs.drift) {
    const times = fragment.get("t")?.split(",").map(numberOf) ?? [];
    const isWhole = times.length === inputs.curve.r.length && !times.some(Number.isNaN);
    if (isWhole) {
      const drift = inputs.drift.split(",").map((each) => numberOf(each) / LENGTHS[inputs.curve.units[0]]);
      Object.assign(inputs.curve, { times, drift });
    } else {
      inputs.drift = "";
      unread.push("t");
    }
  }
  return { inputs, unread };
}

/**
 * Return the address of the inputs, with those that differ from their defaults.
 *
 * Links are kept in reports: a default never changes, another name gets another default.
 */
export function toAddress(inputs) {
  const member = ([key, value]) =>
    `${key}=${encodeURIComponent(value).replace(/%2C/g, ",").replace(/%3B/g, ";")}`;
  const defaults = { ...DEFAULTS, ...KINDS[inputs.kind].fields };
  const drifts = inputs.tab === "fit" && inputs.drift !== "";
  const isWritten = (key) => ["tab", "kind"].includes(key) || (inputs[key] !== defaults[key] && (key !== "drift" || drifts));
  const keys = Object.keys(defaults).filter(isWritten);
  const query = keys.map((key) => member([key, inputs[key]])).join("&");
  const held = [["table", inputs.kind === "tabulated"], ["curve", inputs.tab === "fit"]].filter(([, shown]) => shown);
  const columns = held.flatMap(([key]) => {
    const { r, f, units } = inputs[key];
    return [r, f, ...units].map((value, i) => member([COLUMNS[key][i], value]));
  });
  if (drifts) columns.push(member(["t", inputs.curve.times]));
  return columns.length ? `?${query}#${columns.join("&")}` : `?${query}`;
}

/** Return the inputs with another profile kind; values that differ from their defaults are kept. */
export function withKind(inputs, kind) {
  const chosen = { ...inputs, kind };
  for (const [key, value] of Object.entries(KINDS[inputs.kind].fields)) {
    if (inputs[key] === value) delete chosen[key];
  }
  return { ...KINDS[kind].fields, ...chosen };
}

/** Return the points of the load path, each `[normal, tangential]`. */
export function pathPoints(inputs) {
  return inputs.path.split(";").map((point) => point.split(",").map(numberOf));
}

/** Return whether the analysis computes with a layer, rather than checking its thickness. */
export function takesLayer(inputs) {
  return inputs.tab === "press" || (inputs.tab === "fit" && !hasLoop(inputs));
}

/** Return whether there is a layer with which the analysis computes. */
export function hasLayer(inputs) {
  return takesLayer(inputs) && inputs.thickness !== "";
}

/** Return the members that every request shares. */
export function basics(inputs) {
  const bodies = [1, 2].map((i) =>
    inputs[`e${i}`] === RIGID ? RIGID : { youngs_modulus: inputs[`e${i}`], poissons_ratio: inputs[`nu${i}`] });
  const { thickness, base } = inputs;
  const body = hasLayer(inputs) ? { layer: { thickness, base } } : { body_thickness: thickness };
  return { profile: wireProfile(inputs), material: { bodies, ...(thickness === "" ? {} : body) } };
}

/**
 * Return the inputs after the choice of a `value` for `key`, with the state of the contact that is
 * `known` by its quantities where another one is chosen to give it.
 */
export function withChoice(given, key, value, known) {
  const inputs = { ...given, [key]: value };
  if (key === "control") inputs.load &&= known[value] > 0 ? known[value] : LOADS[value];
  if (key === "push" || key === "shear") {
    const share = known.tangential_force / (inputs.mu * known.normal_force);
    inputs.amount = value === "ratio" ? Math.min(share || 0.7, 1) : known[value] || inputs.load / 10;
  }
  if (key === "oscillation") {
    inputs.amplitude = value === "tangential_force" ? defaultInputs().amplitude : 2e-7;
  }
  if (key === "normal") {
    inputs.path = rescaled(inputs, 0, Math.max(known[value], 0) || (value === "normal_force" ? 100 : 2e-6));
  }
  if (key === "tangential") {
    inputs.path = rescaled(inputs, 1, Math.abs(known[value]) || (value === "tangential_force" ? 20 : 4e-7));
  }
  return inputs;
}

function rescaled(inputs, column, largest) {
  const points = pathPoints(inputs);
  const size = Math.max(...points.map((point) => Math.abs(point[column]))) || 1;
  for (const point of points) point[column] = Number(((point[column] / size) * largest).toPrecision(6));
  return points.map((point) => point.join(",")).join(";");
}
