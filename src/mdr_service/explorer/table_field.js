// The field for the two columns of a profile or a curve: its text, its units, and files.

import { make } from "./dom.js";
import { mark } from "./form.js";
import { readTable } from "./table_reader.js";
import { read as readNumber } from "./units.js";

// Points of a tip from the coefficients of its area function.
const POINTS_OF_AREA = 200;

/** Return the table of A(h) = C0 h² + C1 h + C2 √h + … between heights, and the end of the tip, as text. */
function areaText(coefficients, least, most, unit) {
  const between = Array.from({ length: POINTS_OF_AREA }, (_, i) => least + (most - least) * (i / (POINTS_OF_AREA - 1)) ** 2);
  // The end of the tip is known, whatever A(h) is next to it.
  const heights = [0, ...between.filter((h) => h > 0)];
  const area = (h) => coefficients.reduce((sum, c, i) => sum + c * h ** (2 ** (1 - i)), 0);
  return [`h [${unit}], A [${unit}²]`, ...heights.map((h) => `${h}, ${area(h)}`)].join("\n");
}

/** Return the text of a file, which may be edited, as the service decodes it. */
function decoded(bytes) {
  const [first, second] = new Uint8Array(bytes);
  const wide = { 0xfffe: "utf-16le", 0xfeff: "utf-16be" }[first * 256 + second];
  try {
    return new TextDecoder(wide ?? "utf-8", { fatal: true }).decode(bytes);
  } catch {
    return new TextDecoder("windows-1252").decode(bytes);
  }
}

/**
 * Return the field in an element for tables of a kind (`PROFILE`, `CURVE`), with `show(table,
 * unreadable, heads)`, names of its columns. `change(table)` is called with a table that is read, else `fail()`.
 */
export function tableField(root, kind, { change, fail }) {
  const part = (selector) => root.querySelector(selector);
  const text = part("textarea");
  const selects = [...root.querySelectorAll("select")];
  // Whether the user has chosen a unit since a heading named one.
  const own = [false, false];
  let { heads } = kind;
  // Text or bytes that were read last, and the columns that were chosen.
  let given = [];
  // The columns of a friction loop are read as those of a curve, whose names do not decide them.
  const isLoop = () => heads[0] !== kind.heads[0];
  // The table whose text the field holds, and the number of the newest text, which is being read.
  let [shown, newest, pending] = [null, 0, false];

  const textOf = ({ r, f, units }) =>
    [heads.map((head, i) => `${head} [${units[i]}]`).join(", "), ...r.map((x, i) => `${x}, ${f[i]}`)].join("\n");

  const describe = ({ r, notes = [] }) => {
    const said = isLoop() ? notes.map((note) => note.replace("as the depth", "as the displacement")) : notes;
    part(".count").textContent = [`${r.length} points.`, ...said].join(" ");
  };

  const give = (table) => {
    shown = table;
    mark(root, "");
    describe(table);
    change(table);
  };
  const rewrite = (table) => {
    part(".columns").replaceChildren();
    text.value = textOf(table);
    give({ ...table, notes: undefined, lines: undefined });
  };
  /** Offer the columns of a file `[number, name]`, those that are `taken` as chosen. */
  const offerColumns = (content, columns, taken) => {
    const choices = heads.map((head, i) => {
      const options = [["", "choose"], ...columns].map(([number, name]) => new Option(number ? `${number}: ${name}` : name, number));
      const choice = make("select", {}, ...options);
      choice.value = taken[i] ?? "";
      return [make("label", {}, `${head}: column `, choice), choice];
    });
    const chosen = () => choices.map(([, choice]) => choice.value);
    for (const [, choice] of choices) choice.addEventListener("change", () => chosen().every(Boolean) && read(content, chosen()));
    part(".columns").replaceChildren(...(columns.length > (taken.length ? 2 : 0) ? choices.map(([label]) => label) : []));
  };
  const read = async (content = text.value, columns = undefined) => {
    given = [content, columns];
    part(".thin").hidden = true;
    const turn = ++newest;
    pending = true;
    const result = await readTable(content, kind, columns).catch((error) => error);
    // A newer text is being read.
    if (turn !== newest) return;
    pending = false;
    // Two columns, or two beside the time, leave no choice.
    const isOpen = isLoop() && !columns && result.columns?.length > (result.times ? 3 : 2);
    offerColumns(content, result.columns ?? [], (isOpen ? null : result.taken) ?? []);
    try {
      if (isOpen) throw new Error(`choose the columns of ${heads.join(" and ")}`);
      if (result instanceof Error) throw result;
      const { units: named, ...table } = result;
      named.forEach((name, i) => (own[i] &&= !name));
      const units = selects.map(({ value }, i) => named[i] ?? (own[i] ? value : ""));
      selects.forEach((select, i) => (select.value = units[i]));
      const open = heads.filter((_, i) => !units[i]);
      if (open.length) throw new Error(`no heading names the unit of ${open.join(" and ")}: choose it`);
      offerThinning({ ...table, units });
      give({ ...table, units });
    } catch (error) {
      shown = null;
      mark(root, error.message);
      part(".count").textContent = "";
      fail();
    }
  };
  /** Offer to use every n-th point, and throw an error, if there are too many points. */
  const offerThinning = ({ r, f, units }) => {
    const every = Math.ceil(r.length / kind.most);
    if (every < 2) return;
    const thinned = (column) => column.filter((_, i) => i % every === 0);
    part(".thin").hidden = false;
    part(".thin").textContent = `Use one point of ${every}`;
    part(".thin").onclick = () => {
      part(".thin").hidden = true;
      rewrite({ r: thinned(r), f: thinned(f), units });
    };
    throw new Error(`${r.length} points; the service takes at most ${kind.most}`);
  };
  selects.forEach((select, i) => {
    select.add(Object.assign(new Option("unit?", ""), { disabled: true, hidden: true }));
    for (const name of Object.keys(kind.units[i])) select.add(new Option(name));
    select.addEventListener("change", () => {
      own[i] = true;
      // The heading of the text states the units that are chosen.
      if (part(".problem").textContent === "") rewrite({ ...shown, units: selects.map(({ value }) => value) });
      else read(...given);
    });
  });
  text.addEventListener("input", () => read());
  for (const button of root.querySelectorAll(".reverse")) {
    button.addEventListener("click", () => {
      if (!shown) return;
      const { list } = button.dataset;
      const opposite = list === "r" ? { loading: "unloading", unloading: "loading" } : {};
      const segments = shown.segments?.map((each) => ({ ...each, kind: opposite[each.kind] ?? each.kind }));
      const drift = shown.drift && [list === "r" ? -shown.drift[0] : shown.drift[0], shown.drift[1]];
      rewrite({ ...shown, segments, drift, [list]: shown[list].map((x) => 0 - x) });
    });
  }
  part(".centre")?.addEventListener("click", async () => {
    if (!shown) return;
    const { axis } = await readTable(textOf(shown), kind);
    if (axis === null) mark(root, "the points lie on one side of their axis");
    else rewrite({ ...shown, r: shown.r.map((x) => Number((x - axis).toPrecision(12))) });
  });
  part("[type=file]").addEventListener("change", async ({ target }) => {
    const [file] = target.files;
    const bytes = await file.arrayBuffer();
    text.value = decoded(bytes);
    own.fill(false);
    // Send the bytes, because the service reads other encodings than UTF-8.
    read(bytes);
    target.value = "";
  });
  part(".use-area")?.addEventListener("click", () => {
    const number = (text) => readNumber(text, "1", {});
    const coefficients = part("#coefficients").value.trim().split(/[\s;]+/).map(number);
    const [least, most] = ["lowest", "largest"].map((end) => number(part(`#${end}-height`).value));
    const wrong = coefficients.some(Number.isNaN) ? "enter the coefficients as numbers separated by blanks"
      : !(least >= 0 && most > least) ? "enter the heights as numbers, the lowest at least 0 and below the largest"
        : selects[1].value ? "" : "choose the unit of f above";
    part("#area-problem").textContent = wrong;
    if (wrong) return;
    text.value = areaText(coefficients, least, most, selects[1].value);
    read();
  });

  return {
    /** Show a table, unless the field holds it or a text that cannot be read. */
    show(table, unreadable, names = heads) {
      heads = names;
      if (unreadable || pending || table === shown) return;
      shown = table;
      part(".columns").replaceChildren();
      text.value = textOf(table);
      selects.forEach((select, i) => (select.value = table.units[i]));
      describe(table);
    },
  };
}
