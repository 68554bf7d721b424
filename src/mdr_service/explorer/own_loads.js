// A table of all results under loads of the user's own.

import { make, makeTable } from "./dom.js";
import { mark } from "./form.js";
import { inWords } from "./messages.js";
import { download, fileName } from "./requests.js";
import { format, largest, noNumber, read, scaled, shown, withUnit } from "./units.js";
import { workbook } from "./xlsx.js";

// More loads than this are a case for a sweep.
const MOST = 200;

/** Return the SI values of a text with a list of numbers, or throw an error with what is wrong. */
export function listOf(text, dimension, inputs) {
  const parts = text.split(/[\n\t;]|,\s/).flatMap((part) => {
    const commas = part.split(",");
    if (commas.length > 2) return commas;
    // Blanks separate numbers, unless a unit follows.
    return part.trim().split(/\s+(?=[-+−]?[\d.])/);
  }).map((part) => part.trim()).filter(Boolean);
  if (parts.length > MOST) throw new Error(`${parts.length} loads; the page takes at most ${MOST}: use mdr sweep`);
  return parts.map((part) => {
    if (/^\d+,\d+$/.test(part) && parts.length === 1) throw new Error(`write ${part.replace(",", " ")} for two numbers, ${part.replace(",", ".")} for one`);
    const value = read(part, dimension, inputs);
    if (Number.isNaN(value)) throw new Error(`“${part}”: ${noNumber(part, dimension)}`);
    return value;
  });
}

/** Return the columns `[title, cells]` of the results of cases `{given, result}`, a row each. */
export function columnsOf(given, cases, inputs) {
  const quantities = new Map();
  for (const { result } of cases) {
    for (const [label, value, dimension, error] of result?.numbers ?? []) {
      if (!quantities.has(label)) quantities.set(label, dimension ?? null);
      if (dimension) quantities.set(label, dimension);
      if (error !== undefined) quantities.set(`Standard error: ${label}`, dimension);
    }
  }
  const valueOf = ({ result }, label) => {
    const [of, isError] = [label.replace("Standard error: ", ""), label.startsWith("Standard error: ")];
    const entry = result?.numbers.find(([name]) => name === of);
    return entry === undefined ? NaN : entry[isError ? 3 : 1];
  };
  const column = (label, dimension, values) => {
    if (!dimension) return [label, values.map((value) => (Number.isNaN(value) ? "" : value))];
    const numbers = values.map((value) => (typeof value === "string" ? NaN : value));
    const size = largest(numbers);
    return [withUnit([label, dimension], inputs, size), scaled(numbers, dimension, inputs, size)];
  };
  const named = given ? [column(given[0], given[1], cases.map(({ value }) => value))] : [];
  const results = [...quantities].filter(([label]) => !given || label !== given[0])
    .map(([label, dimension]) => column(label, dimension, cases.map((each) => valueOf(each, label))));
  const most = (values) => Math.max(...values);
  const errors = [
    ["Relative error estimate", ({ responses }) => most(responses.map((each) => each.error_estimate))],
    ["Relative error of the model", ({ responses }) => most(responses.flatMap((each) => each.model_error))],
    ["Warnings", ({ responses }) => [...new Set(responses.flatMap((each) => each.warnings.map(({ code }) => code)))].join(" ")],
  ].map(([title, of]) => [title, cases.map(({ result, error }) => (result ? of(result) : title === "Warnings" ? error : NaN))]);
  return [...named, ...results, ...errors];
}

const cellText = (value) => (typeof value === "string" ? value : format(value));
const written = (value) => (value === null ? "inf" : typeof value === "number" ? (Number.isNaN(value) ? "" : Number(value.toPrecision(15))) : value);

/** Return a table of columns as rows, the titles first. */
const rowsOf = (columns) => [columns.map(([title]) => title), ...columns[0][1].map((_, i) => columns.map(([, cells]) => written(cells[i])))];

/** Return rows as CSV. */
export function csvOf(rows) {
  const cell = (value) => (typeof value === "string" && value !== "inf" && value !== "" ? `"${value.replaceAll('"', '""')}"` : value);
  return rows.map((row) => `${row.map(cell).join(",")}\n`).join("");
}

/**
 * Connect the section of the table: `state()` returns the inputs, the field `{key, label, dimension}`
 * of the load that a list replaces, if there is one, the last result and the title of the analysis;
 * `solve(inputs)` returns the result of other inputs, and `change(loads)` is called with a new list.
 */
export function ownLoads(root, { state, solve, change, fail }) {
  const part = (selector) => root.querySelector(selector);
  const text = part("textarea");
  let columns = null;

  const show = (found, words) => {
    columns = found;
    part(".status").textContent = words;
    part(".data").replaceChildren(...(found ? [makeTable(found.map(([title]) => title), found[0][1].map((_, i) => found.map(([, cells]) => cellText(cells[i]))))] : []));
  };
  const compute = async () => {
    const { inputs, field, result } = state();
    const values = field && inputs.loads ? inputs.loads.split(",").map(Number) : [];
    if (!values.length) return columnsOf(null, [{ result }], inputs);
    const cases = [];
    for (const value of values) {
      part(".status").textContent = `Computing ${cases.length + 1} of ${values.length} …`;
      try {
        cases.push({ value, result: await solve({ ...inputs, [field.key]: value }) });
      } catch (error) {
        cases.push({ value, error: inWords(error.message, inputs, {}) });
      }
      if (state().inputs !== inputs) return null;
    }
    return columnsOf([field.label, field.dimension], cases, inputs);
  };
  const computed = async () => {
    if (columns) return columns;
    const found = await compute();
    if (found) show(found, found[0][1].length > 1 ? `${found[0][1].length} loads.` : "");
    return found;
  };
  text.addEventListener("input", () => {
    const { inputs, field } = state();
    try {
      const loads = listOf(text.value, field.dimension, inputs).join(",");
      mark(root, "");
      show(null, "");
      change(loads);
    } catch (error) {
      mark(root, error.message);
      fail();
    }
  });
  const save = (suffix, content) => async () => {
    const found = await computed();
    if (found) download(`${fileName(state().title)}-results.${suffix}`, content(rowsOf(found)), "application/octet-stream");
  };
  part(".compute").addEventListener("click", computed);
  part(".csv").addEventListener("click", save("csv", csvOf));
  part(".xlsx").addEventListener("click", save("xlsx", workbook));
  return {
    computed,
    /** Show the list of other inputs, without results of the inputs before. */
    show(inputs, field) {
      show(null, "");
      part(".list").hidden = !field;
      if (!field || document.activeElement === text) return;
      part("label > span").textContent = withUnit([`Loads: ${field.label}`, field.dimension], inputs);
      text.value = inputs.loads ? inputs.loads.split(",").map((value) => shown(Number(value), field.dimension, inputs)).join(" ") : "";
    },
  };
}
