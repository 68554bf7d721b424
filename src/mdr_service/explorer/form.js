// Fields of the form: a number with its unit and a slider, or a choice.

import { make } from "./dom.js";
import { read, shown, unit } from "./units.js";

const SPAN = 100;

function sliderOf(field, value, reference, scale) {
  const { range, logarithmic } = field;
  if (range && !logarithmic) return { min: range[0], max: range[1], to: (x) => x, from: (x) => x };
  const centre = reference > 0 ? reference : scale;
  const reach = [centre / SPAN, centre * SPAN, value > 0 ? value : centre];
  const [low, high] = range ?? [Math.min(...reach), Math.max(...reach)];
  return { min: Math.log10(low), max: Math.log10(high), to: Math.log10, from: (x) => 10 ** x };
}

/** Return a row with `choices`, pairs of value and text; `choose(value)` is called with a new one. */
export function choiceRow(id, label, choices, chosen, choose) {
  const options = choices.map(([value, text]) => new Option(text, value, false, value === chosen));
  const select = make("select", { id, onchange: () => choose(choices[select.selectedIndex][0]) }, ...options);
  return make("label", { className: "row" }, make("span", {}, label), select);
}

/**
 * Return a row with the number of a field and a slider.
 *
 * `change(key, value)` is called with the new SI value while the slider moves and when a text
 * is a number. `reference` is the value in whose neighbourhood the slider moves.
 */
export function numberRow(field, inputs, reference, change) {
  const { key, dimension } = field;
  const { name, factor } = unit(dimension, inputs);
  const element = make("div", { className: "field", "data-key": key });
  element.innerHTML = `<label class="row"><span></span><input type="text" inputmode="decimal" id="field-${key}"><span class="unit"></span></label><input type="range" step="any"><p class="problem" role="alert"></p>`;
  const [text, slider] = element.querySelectorAll("input");
  element.querySelector("span").textContent = field.label;
  element.querySelector(".unit").textContent = name;
  slider.setAttribute("aria-label", `${field.label}, slider`);
  const { min, max, to, from } = sliderOf(field, inputs[key], reference, factor);
  Object.assign(slider, { min, max, step: (max - min) / 400, value: to(inputs[key]) });
  const tell = (value) => slider.setAttribute("aria-valuetext", `${shown(value, dimension, inputs)} ${name}`);
  text.value = shown(inputs[key], dimension, inputs);
  tell(inputs[key]);
  slider.addEventListener("input", () => {
    const value = Number(from(Number(slider.value)).toPrecision(3));
    text.value = shown(value, dimension, inputs);
    tell(value);
    change(key, value);
  });
  text.addEventListener("input", () => {
    const value = read(text.value, dimension, inputs);
    const wrong = Number.isNaN(value);
    element.querySelector(".problem").textContent = wrong ? "not a number" : "";
    text.setAttribute("aria-invalid", String(wrong));
    if (wrong) return;
    slider.value = to(value);
    tell(value);
    change(key, value);
  });
  return element;
}

/** Return the table that a text holds: pairs of r and f, one a line. */
export function readTable(text) {
  const table = { r: [], f: [] };
  const rowOf = [];
  text.split(/\r?\n/).forEach((line, i) => {
    const words = line.trim().split(/[\s,;]+/).filter(Boolean);
    if (words.length === 0 || line.startsWith("#")) return;
    const numbers = words.map(Number);
    // A first line of words is a heading.
    if (numbers.some(Number.isNaN) && table.r.length === 0 && i === 0) return;
    if (words.length !== 2 || numbers.some((x) => !Number.isFinite(x))) {
      throw new Error(`Line ${i + 1}: two numbers are expected, r and f`);
    }
    table.r.push(numbers[0]);
    table.f.push(numbers[1]);
    rowOf.push(i + 1);
  });
  return { table, rowOf };
}

/** Return a table as the text of its field. */
export function tableText({ r, f }) {
  return r.map((x, i) => `${x}, ${f[i]}`).join("\n");
}
