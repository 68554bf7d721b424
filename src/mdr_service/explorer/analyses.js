// The analyses and the fields that they add to the form.

import { controls, hasLoop, NORMAL, RIGID, TANGENTIAL } from "./inputs.js";
import { densityOf, massOf, strengthOf } from "./materials.js";
import { QUANTITIES } from "./quantities.js";
import { LENGTHS } from "./table_reader.js";
import { shown } from "./units.js";
import { solveStress, solveWear } from "./field_results.js";
import { solveFit } from "./fit_results.js";
import { solveCycle, solveImpact, solvePush } from "./friction_results.js";
import { solvePress } from "./press_results.js";

const SHARE = ["Share of µF_N", "1"];

export const BODIES = { 1: "Body 1 (indenter)", 2: "Body 2 (flat)" };

const STRESSED = { key: "body", label: "Stress in", choices: [1, 2].map((i) => [i, BODIES[i]]) };

export const THICKNESS = {
  key: "thickness", label: "Thickness on a rigid base", dimension: "length", optional: true, placeholder: "half-space",
};

/** How a body of that thickness is held, of which Press and Fit take account. */
export const BASE = { key: "base", label: "Layer on its base", choices: [["bonded", "bonded"], ["frictionless", "sliding"]] };

const choicesOf = (names) => names.map((name) => [name, QUANTITIES[name][0]]);
const FRICTION = { key: "mu", label: QUANTITIES.friction_coefficient[0], dimension: "1", range: [0.01, 1] };

/** Return the fields of the material of a body, 1 or 2. */
export function bodyFields(inputs, i) {
  if (inputs[`e${i}`] === RIGID) return [];
  return [
    { key: `e${i}`, label: `Young’s modulus ${i}`, dimension: "modulus" },
    { key: `nu${i}`, label: `Poisson’s ratio ${i}`, dimension: "1", range: [0, 0.5] },
  ];
}

/** Return the fields of the load of the inputs. */
export function loadFields(inputs) {
  if (["cycle", "impact"].includes(inputs.tab) || (inputs.tab === "fit" && !hasLoop(inputs))) return [];
  const choices = choicesOf(controls(inputs.tab));
  const [label, dimension] = QUANTITIES[inputs.control];
  return [
    { key: "control", label: "Prescribed", choices },
    { key: "load", label, dimension },
  ];
}

/** Return the fields of a tangential load, which the input `key` says how to prescribe. */
function pushFields(inputs, key = "push") {
  const control = inputs[key];
  const none = key === "shear" ? [["none", "none"]] : [];
  const choice = { key, label: "Tangential load", choices: [...none, ["ratio", SHARE[0]], ...choicesOf(TANGENTIAL)] };
  if (control === "none") return [choice];
  const [label, dimension] = control === "ratio" ? SHARE : QUANTITIES[control];
  const range = control === "ratio" ? [0, 1] : undefined;
  return [choice, FRICTION, { key: "amount", label, dimension, range }];
}

/** Return an optional field whose value, if it is empty, follows from other inputs. */
function derived(inputs, key, label, dimension, value) {
  const text = (number) => String(Number(Number(shown(number, dimension, inputs)).toPrecision(4)));
  return { key, label, dimension, optional: true, placeholder: value === undefined ? "needed" : text(value) };
}

/** Return the field of the load that a list of the user's own replaces, or undefined. */
export function listedField(inputs) {
  if (inputs.tab === "fit") return undefined;
  if (inputs.tab === "impact") return ANALYSES.impact.fields(inputs).find(({ key }) => key === "approach");
  return loadFields(inputs).find(({ key }) => key === "load");
}

/** Which measurement is fitted. */
export const MEASURED = {
  key: "measured", label: "Measured", choices: [["curve", "force-depth curve"], ["loop", "friction loop"]],
};

/** Return the fields of a measured curve or loop: which of its points are fitted. */
export function curveFields(inputs) {
  if (hasLoop(inputs)) return [];
  const { segments = [], units: [unit], drift } = inputs.curve;
  const words = (row) => row.split(",").map((each) => Number(each) + 1).join(" to ");
  const branches = segments.map(({ kind, first, last }) => [`${first},${last}`, `${kind}, ${words(`${first},${last}`)}`]);
  // A link holds rows without the direction of the depth.
  const own = inputs.rows && !branches.some(([rows]) => rows === inputs.rows) ? [[inputs.rows, words(inputs.rows)]] : [];
  // In metres per second, with its standard error, as a link holds it.
  const rate = inputs.drift || drift?.map((each) => each * LENGTHS[unit]).join();
  const end = (key, label, placeholder) => ({ key, label, dimension: "displacement", optional: true, placeholder });
  const choices = [["", "all points"], ...branches, ...own];
  return [
    ...(choices.length > 2 || own.length ? [{ key: "rows", label: "Rows", choices }] : []),
    ...(rate ? [{ key: "drift", label: "Drift from the hold", choices: [["", "not subtracted"], [rate, "subtracted"]] }] : []),
    end("from", "Depths from", "the first"), end("to", "Depths up to", "the last"),
  ];
}

const LOOP = "A loop of friction over displacement was measured under a constant normal load: what are the shear modulus and the coefficient of friction of the contact, and how much energy does a cycle dissipate? ± is a standard error.";

/** Return the question that the page answers. */
export function leadOf(inputs) {
  return hasLoop(inputs) ? LOOP : ANALYSES[inputs.tab].lead;
}

export const ANALYSES = {
  press: {
    title: "Press",
    lead: "Two bodies are pressed together: how large is the contact, and how high is the pressure?",
    fields: () => [{ key: "w", label: "Work of adhesion (0: none)", dimension: "N/m", range: [0, 1] }],
    solve: solvePress,
  },
  push: {
    title: "Push",
    lead: "A tangential load is added: which part sticks, and how far does the body move?",
    fields: (inputs) => pushFields(inputs),
    solve: solvePush,
  },
  cycle: {
    title: "Cycle",
    lead: "The load follows a path: how much energy is dissipated, and which shear stress remains?",
    fields: (inputs) => [
      FRICTION,
      { key: "normal", label: "Normal control", choices: choicesOf(NORMAL) },
      { key: "tangential", label: "Tangential control", choices: choicesOf(TANGENTIAL) },
      STRESSED,
    ],
    solve: solveCycle,
  },
  impact: {
    title: "Impact",
    lead: "The body hits the other one obliquely: how does it rebound, and how much energy does friction dissipate?",
    fields: (inputs) => [
      FRICTION,
      derived(inputs, "density", "Density of body 1", "kg/m³", densityOf(inputs)),
      derived(inputs, "mass", "Mass m of body 1", "kg", massOf(inputs)),
      { key: "share", label: "Tangential mass over m", dimension: "1", range: [0.1, 1] },
      { key: "approach", label: "Normal velocity", dimension: "m/s" },
      { key: "along", label: "Tangential velocity", dimension: "m/s" },
    ],
    solve: solveImpact,
  },
  stress: {
    title: "Stress",
    lead: "What stresses act at the surface and beneath it, and at which load does the material yield?",
    fields: (inputs) => [
      ...pushFields(inputs, "shear"),
      STRESSED,
      derived(inputs, `yield${inputs.body}`, `Yield strength of body ${inputs.body}`, "pressure",
        strengthOf(inputs, inputs.body)),
    ],
    solve: solveStress,
  },
  wear: {
    title: "Wear",
    lead: "The contact oscillates with a small amplitude: what shape does fretting leave, and how fast?",
    fields: (inputs) => [
      FRICTION,
      { key: "oscillation", label: "Oscillation", choices: choicesOf(TANGENTIAL) },
      { key: "amplitude", label: "Amplitude", dimension: QUANTITIES[inputs.oscillation][1] },
      { key: "wear", label: "Wear coefficient (volume per energy)", dimension: "1/pressure" },
      { key: "cycles", label: "Cycles", dimension: "1", range: [1, 1e8], logarithmic: true },
    ],
    solve: solveWear,
  },
  fit: {
    title: "Fit",
    lead: "A curve of force over depth was measured: what is the modulus of the contact, and at which depth does it begin? ± is a standard error.",
    fields: (inputs) => hasLoop(inputs) ? [{
      key: "rig", label: "Compliance of the rig in series", dimension: "compliance", optional: true, placeholder: "fitted",
    }] : [{ key: "nu2", label: "Poisson’s ratio of the sample", dimension: "1", range: [0, 0.5] }, {
      key: "fitted", label: "Fitted together with E*",
      choices: [
        ["none", "nothing"], ["contact_point", "contact point"],
        ["contact_point,force_offset", "contact point, force offset"],
        ["contact_point,work_of_adhesion", "contact point, work of adhesion"],
        ["contact_point,force_offset,work_of_adhesion", "contact point, force offset, work of adhesion"],
      ],
    }],
    solve: solveFit,
  },
};
