// The five analyses and the fields that they add to the form.

import { solveCycle, solvePress, solvePush, solveStress, solveWear } from "./results.js";

const CONTROLS = {
  normal_force: ["Normal force", "force"],
  indentation_depth: ["Indentation depth", "displacement"],
  contact_radius: ["Contact radius", "length"],
};
const PUSHES = {
  ratio: ["Share of µF_N", "1"],
  tangential_force: ["Tangential force", "force"],
  tangential_displacement: ["Tangential displacement", "displacement"],
};
const OSCILLATIONS = {
  tangential_displacement: ["Displacement amplitude", "displacement"],
  tangential_force: ["Force amplitude", "force"],
};

const names = (table) => Object.entries(table).map(([value, [label]]) => ({ value, label }));
const FRICTION = { key: "mu", label: "Friction coefficient µ", dimension: "1", range: [0.01, 1] };

/** Return the fields of the materials of the inputs. */
export function bodyFields(inputs) {
  const modulus = (i) => ({ key: `e${i}`, label: `Young’s modulus ${i}`, dimension: "modulus" });
  const ratio = (i) => ({ key: `nu${i}`, label: `Poisson’s ratio ${i}`, dimension: "1", range: [0, 0.5] });
  return inputs.e2 === "rigid" ? [modulus(1), ratio(1)] : [modulus(1), ratio(1), modulus(2), ratio(2)];
}

/** Return the fields of the load of the inputs. */
export function loadFields(inputs) {
  if (inputs.tab === "cycle") return [];
  const choices = inputs.tab === "wear" ? names(CONTROLS).slice(0, 2) : names(CONTROLS);
  const [label, dimension] = CONTROLS[inputs.control];
  return [
    { key: "control", label: "Prescribed", choices },
    { key: "load", label, dimension },
  ];
}

function pushFields(inputs) {
  const [label, dimension] = PUSHES[inputs.push];
  const range = inputs.push === "ratio" ? [0, 1] : undefined;
  return [
    FRICTION,
    { key: "push", label: "Tangential load", choices: names(PUSHES) },
    { key: "amount", label, dimension, range },
  ];
}

export const ANALYSES = {
  press: {
    title: "Press",
    lead: "Two bodies are pressed together: how large is the contact, and how high is the pressure?",
    fields: () => [],
    solve: solvePress,
  },
  push: {
    title: "Push",
    lead: "A tangential load is added: which part sticks, and how far does the body move?",
    fields: pushFields,
    solve: solvePush,
  },
  cycle: {
    title: "Cycle",
    lead: "The load follows a path: how much energy is dissipated, and which shear stress remains?",
    fields: (inputs) => [
      FRICTION,
      { key: "normal", label: "Normal control", choices: names(CONTROLS).slice(0, 2) },
      { key: "tangential", label: "Tangential control", choices: names(PUSHES).slice(1) },
    ],
    solve: solveCycle,
  },
  stress: {
    title: "Stress",
    lead: "What stresses act at the surface and beneath it, and at which load does the material yield?",
    fields: (inputs) => [
      ...pushFields(inputs),
      { key: "body", label: "Stress in", choices: [{ value: 1, label: "body 1" }, { value: 2, label: "body 2" }] },
      { key: "yield", label: "Yield strength", dimension: "pressure" },
    ],
    solve: solveStress,
  },
  wear: {
    title: "Wear",
    lead: "The contact oscillates with a small amplitude: what shape does fretting leave, and how fast?",
    fields: (inputs) => {
      const [label, dimension] = OSCILLATIONS[inputs.oscillation];
      return [
        FRICTION,
        { key: "oscillation", label: "Oscillation", choices: names(OSCILLATIONS) },
        { key: "amplitude", label, dimension },
        { key: "wear", label: "Wear coefficient (volume per energy)", dimension: "1/pressure" },
        { key: "cycles", label: "Cycles", dimension: "1", range: [1, 1e8], logarithmic: true },
      ];
    },
    solve: solveWear,
  },
};

/** Return the dimension of a control of the load path. */
export function dimensionOf(control) {
  return (CONTROLS[control] ?? PUSHES[control])[1];
}

/** Return the label of a control of the load path. */
export function labelOf(control) {
  return (CONTROLS[control] ?? PUSHES[control])[0];
}
