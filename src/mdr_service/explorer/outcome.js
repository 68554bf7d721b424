// Outcome of a computation: numbers, errors and warnings, or the invalid fields.

import { make } from "./dom.js";
import { mark } from "./form.js";
import { hasLoop } from "./inputs.js";
import { inWords } from "./messages.js";
import { inMetres } from "./shapes.js";
import { format, quantity, uncertain } from "./units.js";

const $ = (selector) => document.querySelector(selector);

/** Show the numbers of a result. */
export function showNumbers(numbers, inputs) {
  const entries = () => numbers.map(([label, value, dimension, error, digits]) => {
    const text = typeof value === "string" ? value
      : error === undefined ? quantity(value, dimension, inputs, digits) : uncertain(value, error, dimension, inputs);
    return make("div", {}, make("dt", {}, label), make("dd", {}, text));
  });
  $("#numbers").replaceChildren(...entries());
  $("#main-numbers").replaceChildren(...entries().slice(0, 2));
}

/** Return a note if the contact is small against the spacing of a table's points, else nothing. */
export function noteOnUnits(inputs, contactRadius) {
  const { r } = inMetres(inputs.table);
  const spacing = (Math.max(...r) - Math.min(...r)) / (r.length - 1);
  if (inputs.kind !== "tabulated" || !(contactRadius > 0) || contactRadius > 2 * spacing) return [];
  const [a, h] = [contactRadius, spacing].map((x) => quantity(x, "length", inputs, 3));
  return [{ code: "units", message: `the contact radius is ${a}, small against the spacing of the points, ${h}: check the units of the table` }];
}

/** Show the errors, sources and warnings of a result, and further notes. */
export function showAccuracy({ responses, lines = [] }, notes, inputs, labels) {
  const error = Math.max(...responses.map((response) => response.error_estimate));
  const methods = [...new Set(responses.map((response) => response.method.replace("_", " ")))];
  const fields = Math.max(...responses.map((response) => response.field_error_estimate ?? 0));
  const ofFields = fields ? `, of fields ${quantity(fields, "1", inputs, 2)} of their largest value` : "";
  const model = 100 * Math.max(...responses.flatMap((response) => response.model_error));
  // The last load is the one of the form.
  const data = responses.find((response) => response.data_error)?.data_error.at(-1);
  const byPoints = data ? ` The points of the table leave an error of about ${format(100 * data, 2)} % of depth and force.` : "";
  const accuracy =
    `Computed by ${methods.join(" and ")}; estimated relative error ${quantity(error, "1", inputs, 2)}${ofFields}. ` +
    `The model itself errs by ${model < 100 ? "about" : "over"} ${format(model, 2)} %.${byPoints}`;
  const sources = `Sources: ${[...new Set(responses.flatMap((response) => response.sources))].join("; ")}.`;
  $("#accuracy").replaceChildren(
    ...[...lines, accuracy].filter(Boolean).map((text) => make("p", {}, text)), make("small", {}, sources));
  // The estimate of the error is shown above, and the page does not set `rtol`.
  const warnings = [...notes, ...responses.flatMap((response) => response.warnings)]
    .filter(({ code }) => code !== "accuracy");
  const messages = new Map(warnings.map(({ code, message }) => [code, message]));
  $("#warnings").replaceChildren(...[...messages].map(([code, message]) =>
    make("li", {}, make("strong", {}, code.replaceAll("_", " ")), ` ${inWords(message, inputs, labels)}`)));
}

// Member of a request -> keys of the inputs that set it.
const SOURCES = {
  "/friction_coefficient": "mu", "/load": "load", "/tangential": "amount", "/oscillation": "amplitude",
  "/wear_coefficient": "wear", "/cycles": "cycles", "/body": "body",
  "/material/work_of_adhesion": "w", "/material/body_thickness": "thickness",
  "/material/layer": "thickness", "/layer": "thickness",
  "/history": "path", "/normal_mass": "mass", "/tangential_mass": "share", "/normal_velocity": "approach",
  "/tangential_velocity": "along", "/indentation_depth": "curve", "/normal_force": "curve",
  "/rig_compliance": "rig", "/poissons_ratio": "nu2",
  "/indenter/youngs_modulus": "e1", "/indenter/poissons_ratio": "nu1", "/indenter": "material-1",
  "/profile/r": "table", "/profile/f": "table",
  "/material/bodies/0/youngs_modulus": "e1", "/material/bodies/0/poissons_ratio": "nu1",
  "/material/bodies/1/youngs_modulus": "e2", "/material/bodies/1/poissons_ratio": "nu2",
  "/material/bodies": "material-2",
};

/** Return the key of the input that sets the member of a request at a pointer. */
function keyOf(pointer, inputs) {
  if (pointer === "/material/yield_strength") return `yield${inputs.body}`;
  // The lists of a loop and its load have the names of the load and the lists of a curve.
  if (hasLoop(inputs) && /^\/(normal_force|indentation_depth)/.test(pointer)) return "load";
  if (inputs.tab === "fit" && /^\/tangential_(force|displacement)/.test(pointer)) return "curve";
  const member = Object.keys(SOURCES).find((prefix) => `${pointer}/`.startsWith(`${prefix}/`));
  if (member) return SOURCES[member];
  const [, , name, index, part] = pointer.split("/");
  if (pointer === "/profile" && inputs.kind === "tabulated") return "table";
  if (name === "radii") return index === "0" ? "radius_1" : "radius_2";
  if (name === "breaks") return name;
  return name === "terms" ? `${part}_${Number(index) + 1}` : pointer.split("/").pop();
}

/** Return the field at a pointer, and a message about it. */
function placed({ pointer, detail }, inputs, labels) {
  const field = document.querySelector(`.field[data-key="${keyOf(pointer, inputs)}"]:not([hidden])`);
  const label = (field?.querySelector("h2, label > span") ?? field?.querySelector("label"))?.textContent;
  const [, row] = pointer.match(/^\/profile\/[rf]\/(\d+)$/) ?? [];
  const [, point] = pointer.match(/^\/history\/\w+\/\w+\/(\d+)$/) ?? [];
  // A heading is the first line of a table that the page has written.
  const line = row && (inputs.table.lines?.[row] ?? Number(row) + 2);
  const where = line ? `line ${line}: ` : point ? `point ${Number(point) + 1}: ` : "";
  const text = where + inWords(detail, inputs, labels);
  return { field, text, message: label ? `${label}: ${text}` : text };
}

/** Show an error of the page or of the service, at its fields too, or none. */
export function showProblem(error, inputs, labels) {
  const box = $("#problem");
  document.querySelectorAll(".field:has(.problem)").forEach((field) => mark(field, ""));
  box.hidden = !error;
  if (!error) return;
  const { title = "Error in the page", errors = [] } = error.problem ?? {};
  const found = errors.map((each) => placed(each, inputs, labels));
  for (const { field, text } of found) if (field) mark(field, text);
  const detail = found.length ? found.map(({ message }) => message).join("; ") : inWords(error.message, inputs, labels);
  box.textContent = title === detail ? title : `${title}: ${detail}`;
}
