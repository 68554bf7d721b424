// The report that is printed: inputs, results, and where its data are.

import { leadOf } from "./analyses.js";
import { make, makeTable } from "./dom.js";
import { hasLoop, pathPoints, toAddress } from "./inputs.js";
import { QUANTITIES } from "./quantities.js";
import { quantity } from "./units.js";

// Points of a table or curve that a report lists.
const LISTED = 200;

/** Return the rows `[label, value]` of the inputs in the form. */
function givenRows(inputs) {
  const rows = [...document.querySelectorAll("#inputs fieldset:not(#units) label.row")];
  const given = rows.filter((row) => !row.closest("[hidden]")).map((row) => {
    const [control, words] = [row.querySelector("input, select"), [...row.querySelectorAll("span")]];
    const value = control.selectedOptions?.[0].text ?? (control.value || control.placeholder);
    // A word may stand in place of a number: a half-space has no thickness.
    const unitName = /\d/.test(value) ? words[1]?.textContent ?? "" : "";
    return [words[0].textContent, `${value} ${unitName}`.trim()];
  });
  if (inputs.kind === "tabulated") given.splice(1, 0, ["Table", `${inputs.table.r.length} points`]);
  if (inputs.tab === "fit") given.push(["Measured curve", `${inputs.curve.r.length} points`]);
  if (inputs.tab === "cycle") {
    const dimensions = [inputs.normal, inputs.tangential].map((name) => QUANTITIES[name][1]);
    const points = pathPoints(inputs).map((point) => point.map((x, i) => quantity(x, dimensions[i], inputs)).join(", "));
    given.push(["Points of the path (normal, tangential)", points.join("; ")]);
  }
  return given;
}

/** Return the words of a report about the data of a table or a curve. */
function dataWords(name, heads, { r, f, units }) {
  const title = `${name} (${heads.map((head, i) => `${head} [${units[i]}]`).join(", ")})`;
  if (r.length <= LISTED) return `${title}: ${r.map((x, i) => `${x}, ${f[i]}`).join("; ")}.`;
  const ends = [0, r.length - 1].map((i) => `${r[i]}, ${f[i]}`).join(" to ");
  return `${title}: ${r.length} points, ${ends}. They are in the link of the page and in the CSV of its charts, not in this report.`;
}

/** Write the report of a case, of which the page shows the results. */
export function showReport(inputs, analysis, version) {
  const results = [...document.querySelectorAll("#numbers div")].map((entry) => [...entry.children].map(({ textContent }) => textContent));
  const date = new Date().toLocaleDateString("en-GB", { day: "numeric", month: "long", year: "numeric" });
  const table = (title, rows) => make("section", {}, make("h2", {}, title), makeTable([], rows));
  document.querySelector("#report").replaceChildren(
    make("p", {}, `${analysis.title}: ${leadOf(inputs)}`),
    make("p", {}, `${date}, MDR ${version}`),
    make("div", { className: "tables" }, table("Inputs", givenRows(inputs)), table("Results", results)));
  // The table of own loads is there if it belongs to this case.
  const own = [...document.querySelectorAll("#own table")].map((found) => found.cloneNode(true));
  document.querySelector("#loads-printed").replaceChildren(
    ...own.map((found) => make("section", {}, make("h2", {}, "Table of results"), found)));
  const held = [
    ...(inputs.kind === "tabulated" ? [dataWords("Table", ["r", "f"], inputs.table)] : []),
    ...(inputs.tab === "fit" ? [dataWords("Measured curve", [hasLoop(inputs) ? "u" : "d", "F"], inputs.curve)] : []),
  ];
  document.querySelector("#data").textContent = held.join(" ");
  // A printed link omits the points of a long table, because nobody would type them.
  const whole = new URL(toAddress(inputs), document.baseURI).href;
  document.querySelector("#link").textContent = whole.length < 2000 ? whole : `${whole.replace(/#.*/, "")} (the shape and the load; the data below complete it)`;
}
