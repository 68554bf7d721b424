// The field for the two columns of a profile or a curve: its text, its units, and files.

import { mark } from "./form.js";
import { readTable } from "./table_reader.js";
import { numberOf } from "./units.js";

// Points of a tip from the coefficients of its area function.
const POINTS_OF_AREA = 200;

/** Return the table of A(h) = C0 h² + C1 h + C2 √h + … up to the height `most`, as text. */
function areaText(coefficients, most, unit) {
  const heights = Array.from({ length: POINTS_OF_AREA }, (_, i) => most * (i / (POINTS_OF_AREA - 1)) ** 2);
  const area = (h) => coefficients.reduce((sum, c, i) => sum + c * h ** (2 ** (1 - i)), 0);
  return [`h [${unit}], A [${unit}²]`, ...heights.map((h) => `${h}, ${area(h)}`)].join("\n");
}

/** Return the axis of a scan: that of the parabola through the points on both sides of it. */
export function axisOf({ r, f }) {
  const [first, last] = [Math.min(...r), Math.max(...r)];
  let axis = (first + last) / 2;
  for (let half = last - first, i = 0; i < 8; i++, half = Math.min(axis - first, last - axis)) {
    const inside = r.map((x, j) => [x - axis, f[j]]).filter(([u]) => Math.abs(u) <= half);
    const mean = (of) => inside.reduce((sum, point) => sum + of(point), 0) / inside.length;
    const [m, square, height] = [mean(([u]) => u), mean(([u]) => u * u), mean(([, y]) => y)];
    const a = mean(([u]) => (u - m) ** 2);
    const b = mean(([u]) => (u - m) * (u * u - square));
    const c = mean(([u]) => (u * u - square) ** 2);
    const [p, q] = [mean(([u, y]) => (u - m) * (y - height)), mean(([u, y]) => (u * u - square) * (y - height))];
    // Slope and curvature of the least squares.
    const step = -(p * c - q * b) / (2 * (q * a - p * b));
    // A scan of one side, which has no axis within it.
    if (!(axis + step > first && axis + step < last)) return NaN;
    axis += step;
  }
  return axis;
}

/**
 * Return the field in an element for tables of a kind (`PROFILE`, `CURVE`), with `show(table,
 * unreadable)`. `change(table)` is called with a table that is read, else `fail()`.
 */
export function tableField(root, kind, { change, fail }) {
  const part = (selector) => root.querySelector(selector);
  const text = part("textarea");
  const selects = [...root.querySelectorAll("select")];
  // The table whose text the field holds, and the number of the newest text, which is being read.
  let [shown, newest, pending] = [null, 0, false];

  const textOf = ({ r, f, units }) =>
    [kind.heads.map((head, i) => `${head} [${units[i]}]`).join(", "), ...r.map((x, i) => `${x}, ${f[i]}`)].join("\n");

  const describe = ({ r, named, ofAreas }) => {
    const units = named?.every(Boolean) ? "; units from the heading" : "; the heading names no units: choose them above";
    const areas = ofAreas ? "; r = √(A/π) from the areas" : "";
    part(".count").textContent = `${r.length} points${areas}${named ? units : ""}.`;
  };

  const give = (table) => {
    shown = table;
    mark(root, "");
    describe(table);
    change(table);
  };
  const rewrite = (table) => {
    text.value = textOf(table);
    give({ ...table, named: undefined, lines: undefined });
  };
  const read = async (content = text.value) => {
    part(".thin").hidden = true;
    const own = ++newest;
    pending = true;
    const result = await readTable(content, kind).catch((error) => error);
    // A newer text is being read.
    if (own !== newest) return;
    pending = false;
    try {
      if (result instanceof Error) throw result;
      const { units: named, ...table } = result;
      const units = selects.map(({ value }, i) => named[i] ?? value);
      selects.forEach((select, i) => (select.value = units[i]));
      offerThinning({ ...table, units });
      give({ ...table, units, named });
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
    throw new Error(`${r.length} points, of which the service takes ${kind.most}`);
  };
  selects.forEach((select, i) => {
    for (const name of Object.keys(kind.units[i])) select.add(new Option(name));
    select.addEventListener("change", () => {
      // The heading of the text states the units that are chosen.
      if (part(".problem").textContent === "") rewrite({ ...shown, units: selects.map(({ value }) => value) });
      else read();
    });
  });
  text.addEventListener("input", () => read());
  part(".reverse").addEventListener("click", () =>
    shown && rewrite({ ...shown, [kind.reversed]: shown[kind.reversed].map((x) => 0 - x) }));
  part(".centre")?.addEventListener("click", () => {
    if (!shown) return;
    const axis = axisOf(shown);
    if (Number.isNaN(axis)) mark(root, "the points lie on one side of their axis");
    else rewrite({ ...shown, r: shown.r.map((x) => Number((x - axis).toPrecision(12))) });
  });
  part("[type=file]").addEventListener("change", async ({ target }) => {
    const [file] = target.files;
    text.value = await file.text();
    // Its bytes, because the service knows other encodings.
    read(await file.arrayBuffer());
    target.value = "";
  });
  part(".use-area")?.addEventListener("click", () => {
    const coefficients = part("#coefficients").value.trim().split(/[\s;]+/).map(numberOf);
    const most = numberOf(part("#largest-height").value);
    const wrong = coefficients.some(Number.isNaN) ? "the coefficients are numbers with blanks between them"
      : most > 0 ? "" : "the largest height is a positive number";
    part("#area-problem").textContent = wrong;
    if (wrong) return;
    text.value = areaText(coefficients, most, selects[1].value);
    read();
  });

  return {
    /** Show a table, unless the field holds it or a text that cannot be read. */
    show(table, unreadable) {
      if (unreadable || pending || table === shown) return;
      shown = table;
      text.value = textOf(table);
      selects.forEach((select, i) => (select.value = table.units[i]));
      describe(table);
    },
  };
}
