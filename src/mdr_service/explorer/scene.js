// The scene: one flat object of numbers and words in SI units, and its form in the address.

import { DEFAULT_FIELDS, measuredBall, wireProfile } from "./shapes.js";

export const TABS = ["press", "push", "cycle", "stress", "wear"];

// Keys of the address besides those of the profile; the tabs that use them.
const SHARED = ["e1", "nu1", "e2", "nu2", "ul", "ud", "uf", "up"];
const KEYS_OF = {
  press: ["control", "load"],
  push: ["control", "load", "mu", "push", "amount"],
  cycle: ["mu", "normal", "tangential", "path"],
  stress: ["control", "load", "mu", "push", "amount", "body", "yield"],
  wear: ["control", "load", "mu", "oscillation", "amplitude", "wear", "cycles"],
};

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

/** Return the scene of a first visit. */
export function defaultScene() {
  return { ...DEFAULTS, ...DEFAULT_FIELDS[DEFAULTS.kind], table: measuredBall() };
}

/** Return the scene that the query string and the fragment of an address describe. */
export function fromAddress(search, hash) {
  const scene = defaultScene();
  const given = new URLSearchParams(search);
  if (given.get("kind") in DEFAULT_FIELDS) scene.kind = given.get("kind");
  Object.assign(scene, DEFAULT_FIELDS[scene.kind]);
  for (const [key, text] of given) {
    if (!(key in scene) || key === "table" || key === "kind") continue;
    const number = Number(text);
    const wordAllowed = typeof scene[key] === "string" || (key === "e2" && text === "rigid");
    if (wordAllowed) scene[key] = text;
    else if (text !== "" && Number.isFinite(number)) scene[key] = number;
  }
  if (!TABS.includes(scene.tab)) scene.tab = DEFAULTS.tab;
  const table = new URLSearchParams(hash.replace(/^#/, ""));
  if (table.has("r") && table.has("f")) {
    const numbers = (name) => table.get(name).split(",").map(Number);
    scene.table = { r: numbers("r"), f: numbers("f") };
  }
  return scene;
}

/** Return the address of a scene: everything that its tab and its profile use. */
export function toAddress(scene) {
  const keys = ["tab", "kind", ...Object.keys(DEFAULT_FIELDS[scene.kind]), ...KEYS_OF[scene.tab], ...SHARED];
  const words = keys.map((key) => `${key}=${encodeURIComponent(scene[key]).replace(/%2C/g, ",").replace(/%3B/g, ";")}`);
  const table = scene.kind === "tabulated" ? `#r=${scene.table.r}&f=${scene.table.f}` : "";
  return `?${words.join("&")}${table}`;
}

/** Return the scene with another profile kind and its default values. */
export function withKind(scene, kind) {
  return { ...scene, ...DEFAULT_FIELDS[kind], kind };
}

/** Return the points of the load path, each `[normal, tangential]`. */
export function pathPoints(scene) {
  return scene.path.split(";").map((point) => point.split(",").map(Number));
}

/** Return the members that every request shares. */
export function basics(scene) {
  const body = (i) => ({ youngs_modulus: scene[`e${i}`], poissons_ratio: scene[`nu${i}`] });
  const second = scene.e2 === "rigid" ? "rigid" : body(2);
  return { profile: wireProfile(scene), material: { bodies: [body(1), second] } };
}
