// Fields of the form: a number with its unit and a slider, a list of numbers, or a choice.

import { make } from "./dom.js";
import { HELP } from "./help.js";
import { noNumber, read, shown, unit } from "./units.js";

const SPAN = 100;

function sliderOf(field, value, reference, scale) {
  const { range, logarithmic } = field;
  if (range && !logarithmic) return { min: range[0], max: range[1], to: (x) => x, from: (x) => x };
  const centre = reference > 0 ? reference : scale;
  const reach = [centre / SPAN, centre * SPAN, value > 0 ? value : centre];
  const [low, high] = range ?? [Math.min(...reach), Math.max(...reach)];
  return { min: Math.log10(low), max: Math.log10(high), to: Math.log10, from: (x) => 10 ** x };
}

const describedBy = (key) => `problem-${key}${HELP[key] ? ` help-${key}` : ""}`;

function fieldOf(key, ...contents) {
  const problem = make("p", { className: "problem", role: "alert", id: `problem-${key}` });
  const help = HELP[key] ? [make("p", { className: "help", id: `help-${key}` }, HELP[key])] : [];
  return make("div", { className: "field", "data-key": key }, ...contents, problem, ...help);
}

/** Show what is wrong with the value of a field, or that nothing is. */
export function mark(element, problem) {
  element.querySelector(".problem").textContent = problem;
  const control = element.querySelector(":scope > label > :is(input, select), :is(:scope, :scope > .list) > textarea");
  control?.setAttribute("aria-invalid", String(problem !== ""));
}

/** Return a row with `choices`, pairs of value and text; `choose(value)` is called with a new one. */
export function choiceRow(key, label, choices, chosen, choose) {
  const options = choices.map(([value, text]) => new Option(text, value, false, value === chosen));
  const onchange = () => choose(choices[select.selectedIndex][0]);
  const select = make("select", { id: `field-${key}`, onchange, "aria-describedby": describedBy(key) }, ...options);
  return fieldOf(key, make("label", { className: "row" }, make("span", {}, label), select));
}

/** Return a row with a text and the unit of its numbers, `[label, text, unit]`. */
function textRow(key, label, name) {
  const text = make("input", {
    type: "text", inputMode: "decimal", id: `field-${key}`, "aria-describedby": describedBy(key),
  });
  const row = make("label", { className: "row" },
    make("span", {}, label), text, make("span", { className: "unit" }, name));
  return [fieldOf(key, row), text];
}

/**
 * Return a row with the number of a field and a slider.
 *
 * `actions.change(key, value)` is called with the new SI value while the slider moves and when a
 * text is a number, else `actions.fail(key)`. `reference` is the value around which the slider moves.
 */
export function numberRow(field, inputs, reference, { change, fail }) {
  const { key, dimension, label } = field;
  const { name, factor } = unit(dimension, inputs);
  const [element, text] = textRow(key, label, name);
  const { min, max, to, from } = sliderOf(field, inputs[key], reference, factor);
  const slider = make("input", { type: "range", "aria-label": `${label}, slider` });
  Object.assign(slider, { min, max, step: (max - min) / 400, value: to(inputs[key]) });
  element.firstChild.after(slider);
  const tell = (value) => slider.setAttribute("aria-valuetext", `${shown(value, dimension, inputs)} ${name}`);
  text.value = shown(inputs[key], dimension, inputs);
  tell(inputs[key]);
  slider.addEventListener("input", () => {
    const value = Number(from(Number(slider.value)).toPrecision(3));
    text.value = shown(value, dimension, inputs);
    tell(value);
    mark(element, "");
    change(key, value);
  });
  text.addEventListener("input", () => {
    const value = read(text.value, dimension, inputs);
    mark(element, Number.isNaN(value) ? noNumber(text.value, dimension) : "");
    if (Number.isNaN(value)) return fail(key);
    slider.value = to(value);
    tell(value);
    change(key, value);
  });
  return element;
}

/** Return a row with a number that may be missing, or with a list of numbers if `field.list`. */
export function optionalRow(field, inputs, { change, fail }) {
  const { key, dimension, label, list } = field;
  const [element, text] = textRow(key, label, unit(dimension, inputs).name);
  const held = inputs[key] === "" ? [] : String(inputs[key]).split(",");
  text.value = held.map((part) => shown(Number(part), dimension, inputs)).join(" ");
  text.placeholder = field.placeholder;
  text.addEventListener("input", () => {
    const parts = list ? text.value.split(/,?\s+|;/).filter(Boolean) : text.value.trim() ? [text.value] : [];
    const values = parts.map((part) => read(part, dimension, inputs));
    const wrong = values.some(Number.isNaN);
    mark(element, wrong ? (list ? "enter numbers separated by blanks" : noNumber(text.value, dimension)) : "");
    if (wrong) return fail(key);
    change(key, list || values.length === 0 ? values.join(",") : values[0]);
  });
  return element;
}
