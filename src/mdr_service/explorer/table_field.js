// The field for the table of a measured profile: its text, its units, and files.

import { mark, tableText } from "./form.js";
import { decoded, LENGTHS, readTable } from "./table_reader.js";

const $ = (selector) => document.querySelector(selector);
// The most points that the service takes by default.
const MOST = 2000;
// The table whose text the field holds.
let shown = null;

const selected = () => [$("#unit-r").value, $("#unit-f").value];

function describe({ r, named }) {
  const units = named?.every(Boolean) ? "; units from the heading" : "; the heading names no units: choose them above";
  $("#table-note").textContent = `${r.length} points${named ? units : ""}.`;
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
  $("#file").addEventListener("change", async () => {
    $("#table").value = decoded(await $("#file").files[0].arrayBuffer());
    $("#file").value = "";
    read();
  });
}
