// The inputs: one flat object of numbers and words in SI units, and its form in the address.

import { KINDS, measuredBall, wireProfile } from "./shapes.js";

export const TABS = ["press", "push", "cycle", "stress", "wear"];

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

/** Return the inputs of a first visit. */
export function defaultInputs() {
  return { ...DEFAULTS, ...KINDS[DEFAULTS.kind].fields, table: measuredBall() };
}

/** Return the inputs that the query string and the fragment of an address describe. */
export function fromAddress(search, hash) {
  const inputs = defaultInputs();
  const given = new URLSearchParams(search);
  if (given.get("kind") in KINDS) inputs.kind = given.get("kind");
  Object.assign(inputs, KINDS[inputs.kind].fields);
  for (const [key, text] of given) {
    if (!(key in inputs) || key === "table" || key === "kind") continue;
    const number = Number(text);
    const wordAllowed = typeof inputs[key] === "string" || (key === "e2" && text === "rigid");
    if (wordAllowed) inputs[key] = text;
    else if (text !== "" && Number.isFinite(number)) inputs[key] = number;
  }
  if (!TABS.includes(inputs.tab)) inputs.tab = DEFAULTS.tab;
  const table = new URLSearchParams(hash.replace(/^#/, ""));
  if (table.has("r") && table.has("f")) {
    const numbers = (name) => table.get(name).split(",").map(Number);
    inputs.table = { r: numbers("r"), f: numbers("f") };
  }
  return inputs;
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
  return inputs.path.split(";").map((point) => point.split(",").map(Number));
}

/** Return the members that every request shares. */
export function basics(inputs) {
  const body = (i) => ({ youngs_modulus: inputs[`e${i}`], poissons_ratio: inputs[`nu${i}`] });
  const second = inputs.e2 === "rigid" ? "rigid" : body(2);
  return { profile: wireProfile(inputs), material: { bodies: [body(1), second] } };
}
