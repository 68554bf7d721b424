// Results of a contact that is pressed, with and without adhesion.

import { basics, hasLayer, RIGID } from "./inputs.js";
import { strengthOf } from "./materials.js";
import { fieldsOf, marker, normalForce, numbersOf, pressureChart, relationChart, single } from "./parts.js";
import { quantity } from "./units.js";

// Relative change of a result up to which a model without an effect counts as good.
const WITHIN = 0.01;

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

/** Return the name of the body that yields, if its known strength is below the required one. */
function yieldWords(required, inputs) {
  const strengths = [1, 2].map((i) => [inputs[`e${i}`] === RIGID ? Infinity : strengthOf(inputs, i) ?? Infinity, i]);
  const [[strength, body]] = strengths.sort(([first], [second]) => first - second || 0);
  return strength < required ? ` (body ${body} has ${quantity(strength, "pressure", inputs, 3)}: it yields)` : "";
}

/**
 * Return a sentence with the limits up to which the effects that the model leaves out change the
 * results of the last load by no more than a relative tolerance, or nothing without a load. The
 * shape is not among them, because the user has chosen it.
 */
export function limitWords({ holds_while: limits, normal_force: forces }, within, inputs) {
  const force = forces.at(-1);
  const words = limits.filter(({ effect }) => LIMITED[effect]).map(({ effect, below, above }) => {
    const [[label, dimension], value] = [LIMITED[effect], (below ?? above).at(-1)];
    const isShare = effect === "slip";
    const size = quantity(isShare ? value / force : value, dimension, inputs, 2);
    const yields = effect === "yield" ? yieldWords(value, inputs) : "";
    return `${label} ${below ? "below" : "above"} ${size}${isShare ? " µF_N" : ""}${yields}`;
  });
  return force > 0 ? `Left-out effects change the results by at most ${100 * within} %: ${words.join(", ")}.` : "";
}

/** Return a sentence about the largest stresses on the axis, if they lie beneath the surface. */
async function axisWords(query, inputs, { normal_force: force, contact_radius: radius }) {
  if (hasLayer(inputs) || !(radius > 0)) return "";
  const body = inputs[`e${inputs.body}`] === RIGID ? 3 - inputs.body : inputs.body;
  const z = Array.from({ length: 150 }, (_, i) => (radius * (i + 1)) / 100);
  const beneath = await query("On the axis", "v1/subsurface", {
    ...basics(inputs), load: { normal_force: force }, body, x: [0], z, quantities: ["maximum_shear", "von_mises"],
  });
  const [shear, mises] = [beneath.maximum_shear, beneath.von_mises].map(([rows]) => rows.map(([value]) => value));
  const most = Math.max(...shear);
  const at = shear.indexOf(most);
  if (at === 0 || at === z.length - 1) return "";
  const shown = (value, dimension, digits = 3) => quantity(value, dimension, inputs, digits);
  return `On the axis of body ${body} the largest shear stress is ${shown(most, "pressure")} at the depth ${shown(z[at], "length", 2)}, von Mises ${shown(Math.max(...mises), "pressure")}.`;
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
  const stresses = await axisWords(query, inputs, now);
  const { indentation_depth: depths, normal_force: reached } = curve;
  const fromZero = { indentation_depth: [0, ...depths], normal_force: [0, ...reached] };
  return {
    responses: [curve, field],
    known: now,
    numbers: numbersOf(now, [
      "contact_radius", "maximum_pressure", "indentation_depth", "normal_force", "mean_pressure",
      "normal_stiffness", "elastic_energy",
    ]),
    lines: [curve.holds_while ? limitWords(curve, WITHIN, inputs) : "", stresses],
    charts: [
      pressureChart("Pressure", field, [["a", now.contact_radius]], { size: "wide" }),
      relationChart("Curve", "Force against depth", fromZero, ["indentation_depth", "normal_force"], now),
      relationChart("Curve", "Contact radius against force", curve, ["normal_force", "contact_radius"], now),
    ],
  };
}
