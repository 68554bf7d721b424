// The field for the table of a measured profile: its text, its units, and files.

import { mark, tableText } from "./form.js";
import { numberOf } from "./units.js";
import { decoded, LENGTHS, readTable } from "./table_reader.js";

const $ = (selector) => document.querySelector(selector);
// The most points that the service takes by default.
const MOST = 2000;
// Points of a tip from the coefficients of its area function.
const POINTS_OF_AREA = 200;
// The table whose text the field holds.
let shown = null;

const selected = () => [$("#unit-r").value, $("#unit-f").value];

function describe({ r, named, ofAreas }) {
  const units = named?.every(Boolean) ? "; units from the heading" : "; the heading names no units: choose them above";
  const areas = ofAreas ? "; r = √(A/π) from the areas" : "";
  $("#table-note").textContent = `${r.length} points${areas}${named ? units : ""}.`;
}

/** Return the table of A(h) = C0 h² + C1 h + C2 √h + … up to the height `most`, as text. */
function areaText(coefficients, most, unit) {
  const heights = Array.from({ length: POINTS_OF_AREA }, (_, i) => most * (i / (POINTS_OF_AREA - 1)) ** 2);
  const area = (h) => coefficients.reduce((sum, c, i) => sum + c * h ** (2 ** (1 - i)), 0);
  return [`h [${unit}], A [${unit}²]`, ...heights.map((h) => `${h}, ${area(h)}`)].join("\n");
}

/** Show the table of the inputs, unless the field holds it or a text that cannot be read. */
export function showTable({ kind, table }, unreadable) {
  $("#table-fields").hidden = kind !== "tabulated";
  if (unreadable || table === shown) return;
  shown = table;
  $("#table").value = tableText(table);
  ["#unit-r", "#unit-f"].forEach((select, i) => ($(select).value = table.units[i]));
  describe(table);
}

/** Connect the field: `change(table)` is called with a table that is read, else `fail()`. */
export function connectTable({ change, fail }) {
  const give = (table) => {
    shown = table;
    mark($("#table-fields"), "");
    describe(table);
    change(table);
  };
  const rewrite = (table) => {
    $("#table").value = tableText(table);
    give({ ...table, named: undefined, lines: undefined });
  };
  const read = () => {
    $("#thin").hidden = true;
    try {
      const { units: named, ...table } = readTable($("#table").value);
      const units = selected().map((unit, i) => named[i] ?? unit);
      ["#unit-r", "#unit-f"].forEach((select, i) => ($(select).value = units[i]));
      offerThinning({ ...table, units });
      give({ ...table, units, named });
    } catch (error) {
      mark($("#table-fields"), error.message);
      $("#table-note").textContent = "";
      fail();
    }
  };
  /** Offer to use every n-th point, and throw an error, if there are too many points. */
  const offerThinning = ({ r, f, units }) => {
    const every = Math.ceil(r.length / MOST);
    if (every < 2) return;
    const thinned = (column) => column.filter((_, i) => i % every === 0);
    $("#thin").hidden = false;
    $("#thin").textContent = `Use one point of ${every}`;
    $("#thin").onclick = () => {
      $("#thin").hidden = true;
      rewrite({ r: thinned(r), f: thinned(f), units });
    };
    throw new Error(`${r.length} points, of which the service takes ${MOST}`);
  };
  for (const select of ["#unit-r", "#unit-f"]) {
    for (const name of Object.keys(LENGTHS)) $(select).add(new Option(name));
    $(select).addEventListener("change", () => {
      // The heading of the text states the units that are chosen.
      if ($("#table-fields .problem").textContent === "") rewrite({ ...shown, units: selected() });
      else read();
    });
  }
  $("#table").addEventListener("input", read);
  const showArea = () => {
    const coefficients = $("#coefficients").value.trim().split(/[\s;]+/).map(numberOf);
    const most = numberOf($("#largest-height").value);
    const wrong = coefficients.some(Number.isNaN) ? "the coefficients are numbers with blanks between them"
      : most > 0 ? "" : "the largest height is a positive number";
    $("#area-problem").textContent = wrong;
    if (wrong) return;
    $("#table").value = areaText(coefficients, most, $("#unit-f").value);
    read();
  };
  $("#use-area").addEventListener("click", showArea);
  $("#file").addEventListener("change", async () => {
    $("#table").value = decoded(await $("#file").files[0].arrayBuffer());
    $("#file").value = "";
    read();
  });
}
