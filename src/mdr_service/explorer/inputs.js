// The inputs: one flat object of numbers and words in SI units, and its form in the address.

import { KINDS, measuredBall, wireProfile } from "./shapes.js";
import { BASE_UNITS, numberOf } from "./units.js";

export const TABS = ["press", "push", "cycle", "stress", "wear"];
export const NORMAL = ["normal_force", "indentation_depth"];
export const TANGENTIAL = ["tangential_force", "tangential_displacement"];

const DEFAULTS = {
  tab: "press",
  kind: "paraboloid",
  e1: 2.1e11, nu1: 0.3, e2: 2.1e11, nu2: 0.3,
  control: "normal_force", load: 100,
  mu: 0.3, push: "ratio", amount: 0.7,
  normal: "normal_force", tangential: "tangential_force",
  path: "100,0;100,20;100,-20;100,20",
  body: 1, yield: 1.5e9,
  oscillation: "tangential_force", amplitude: 20, wear: 1e-13, cycles: 1e5,
  ul: "mm", ud: "µm", uf: "N", up: "MPa",
};

// Input that is chosen -> its choices.
const CHOICES = {
  tab: TABS, kind: Object.keys(KINDS), push: ["ratio", ...TANGENTIAL],
  normal: NORMAL, tangential: TANGENTIAL, oscillation: TANGENTIAL, body: [1, 2],
  ...Object.fromEntries(Object.values(BASE_UNITS).map(({ key, factors }) => [key, Object.keys(factors)])),
};

/** Return the quantities by which the load of an analysis can be prescribed. */
export function controls(tab) {
  return tab === "wear" ? NORMAL : [...NORMAL, "contact_radius"];
}

/** Return the inputs of a first visit. */
export function defaultInputs() {
  return { ...DEFAULTS, ...KINDS[DEFAULTS.kind].fields, table: measuredBall() };
}

/** Return the value of an input that a text holds, or undefined if it is none that the page offers. */
function valueOf(key, text, tab) {
  const choices = key === "control" ? controls(tab) : CHOICES[key];
  if (choices) return choices.find((choice) => String(choice) === text);
  if (key === "path") return pathPoints({ path: text }).every(isPoint) ? text : undefined;
  if (key === "e2" && text === "rigid") return text;
  const number = numberOf(text);
  return Number.isNaN(number) ? undefined : number;
}

const isPoint = (point) => point.length === 2 && !point.some(Number.isNaN);

function tableOf(fragment) {
  const [r, f] = ["r", "f"].map((name) => fragment.get(name)?.split(",").map(numberOf) ?? []);
  return r.length === f.length && ![...r, ...f].some(Number.isNaN) ? { r, f } : undefined;
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
  Object.keys(inputs).filter((key) => !["tab", "kind", "table"].includes(key)).forEach(take);
  if (fragment.has("r") || fragment.has("f")) set("table", tableOf(fragment));
  return { inputs, unread };
}

/** Return the address of the inputs, with the fields of the chosen profile. */
export function toAddress(inputs) {
  const keys = new Set([...Object.keys(DEFAULTS), ...Object.keys(KINDS[inputs.kind].fields)]);
  const words = [...keys].map((key) => `${key}=${encodeURIComponent(inputs[key]).replace(/%2C/g, ",").replace(/%3B/g, ";")}`);
  const table = inputs.kind === "tabulated" ? `#r=${inputs.table.r}&f=${inputs.table.f}` : "";
  return `?${words.join("&")}${table}`;
}

/** Return the inputs with another profile kind and its default values. */
export function withKind(inputs, kind) {
  return { ...inputs, ...KINDS[kind].fields, kind };
}

/** Return the points of the load path, each `[normal, tangential]`. */
export function pathPoints(inputs) {
  return inputs.path.split(";").map((point) => point.split(",").map(numberOf));
}

/** Return the members that every request shares. */
export function basics(inputs) {
  const body = (i) => ({ youngs_modulus: inputs[`e${i}`], poissons_ratio: inputs[`nu${i}`] });
  const second = inputs.e2 === "rigid" ? "rigid" : body(2);
  return { profile: wireProfile(inputs), material: { bodies: [body(1), second] } };
}
