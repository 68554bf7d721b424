// Tables of radii and heights, and curves of force over depth, as instruments and spreadsheets write
// them.
// mdr_core/table_reader.py reads the same files; tests/data/tables holds examples for both.

/** Units of length that a heading may name -> metres. */
export const LENGTHS = { m: 1, mm: 1e-3, "µm": 1e-6, nm: 1e-9 };
/** Units of force -> newtons. */
export const FORCES = { N: 1, mN: 1e-3, "µN": 1e-6, nN: 1e-9 };

const UNIT_NAMES = {
  m: /^(m|met(er|re)s?)$/i,
  mm: /^(mm|millimet(er|re)s?)$/i,
  "µm": /^([uµμ]m|microns?|micromet(er|re)s?)$/i,
  nm: /^(nm|nanomet(er|re)s?)$/i,
  N: /^(N|newtons?)$/,
  mN: /^mN$/,
  "µN": /^[uµμ]N$/,
  nN: /^nN$/,
};
// The two columns of a table: their names, those that leave no doubt first, and their units.
const RADIUS = [/(?<![a-z])(r|radius|radial|rho)(?![a-z])/i, /(?<![a-z])(x|distance|position|lateral)(?![a-z])/i];
const HEIGHT = [/(?<![a-z])(f|z|h|hc|height|depth|profile)(?![a-z])/i, /(?<![a-z])y(?![a-z])/i];
const DEPTH = [/(?<![a-z])(d|depth|indentation|displacement)(?![a-z])/i, /(?<![a-z])(h|x|z|position|separation)(?![a-z])/i];
const FORCE = [/(?<![a-z])(f|fn|force|load)(?![a-z])/i, /(?<![a-z])(p|y)(?![a-z])/i];
export const PROFILE = {
  heads: ["r", "f"], names: [RADIUS, HEIGHT], units: [LENGTHS, LENGTHS], reversed: "f",
  expected: "a radius and a height", ask: "the radius r and the height f",
};
export const CURVE = {
  heads: ["d", "F"], names: [DEPTH, FORCE], units: [LENGTHS, FORCES], reversed: "r",
  expected: "a depth and a force", ask: "the depth d and the force F",
};

// Name and unit of the cross-section in a table of a tip's area function.
const AREA = /(?<![A-Za-z])(A|[Aa]reas?|[Ss]ection)(?![A-Za-z])/;
const SQUARE = /(²|\^2|\*\*2|(?<=m)2)$/;

const POINT = /^[-+]?(\d+\.?\d*|\.\d+)([ed][-+]?\d+)?$/i;
const COMMA = /^[-+]?(\d+,?\d*|,\d+)([ed][-+]?\d+)?$/i;
const BLANKS = /,?\s+/;
// Separator of columns, and the form of a number. Blanks separate numbers with a decimal comma
// before commas separate columns: `0,5 1,2` holds two numbers.
const DIALECTS = [
  [/\t/, POINT], [/\t/, COMMA], [/;/, POINT], [/;/, COMMA], [BLANKS, COMMA], [/,/, POINT], [BLANKS, POINT],
];
const COMMENT = /^\s*(#|%|!|\/\/)+/;

/** Return the text of a file in UTF-8, UTF-16 or, as older instruments write it, Windows-1252. */
export function decoded(buffer) {
  const bytes = new Uint8Array(buffer);
  const encoding = { "255,254": "utf-16le", "254,255": "utf-16be" }[bytes.slice(0, 2)];
  try {
    return new TextDecoder(encoding, { fatal: true }).decode(bytes);
  } catch {
    return new TextDecoder("windows-1252").decode(bytes);
  }
}

function linesOf(text) {
  // A comma within quotes is a decimal comma, or part of a name.
  const unquoted = (_, inner) => inner.replace(/[,;]/g, COMMA.test(inner.trim()) ? "." : " ");
  return text.replace(/^\uFEFF/, "").split(/\r\n|\r|\n/).map((line, i) => ({
    number: i + 1,
    comment: COMMENT.test(line),
    text: line.replace(COMMENT, "").replace(/\s[#%!].*/, "").replaceAll("−", "-").replace(/"([^"]*)"/g, unquoted).trim(),
  })).filter(({ text }) => text);
}

function cellsOf(text, separator) {
  return text.replace(/[\s;,]+$/, "").split(separator).map((cell) => cell.trim());
}

/** Return the rows of numbers in a dialect with the heading above them, or the line that does not fit. */
function rowsIn(lines, [separator, form]) {
  const rows = [];
  const heading = [];
  for (const { number, comment, text } of lines) {
    const cells = cellsOf(text, separator);
    const count = rows[0]?.cells.length ?? Math.max(cells.length, 2);
    const fits = cells.length === count && cells.every((cell) => form.test(cell));
    if (!comment && fits) rows.push({ number, cells });
    else if (comment || (rows.length === 0 && !form.test(cells[0]))) heading.push({ number, text });
    else return { rows, wrong: number, count };
  }
  return { rows, heading, separator };
}

function unitOf(name) {
  return Object.keys(UNIT_NAMES).find((unit) => UNIT_NAMES[unit].test(name));
}

function isArea({ name }) {
  return AREA.test(name) && !RADIUS.some((radius) => radius.test(name));
}

/**
 * Return the `unit` that a cell of a heading names: `mm`, `r [mm]`, `r (mm)`, `r, mm`, `r_mm`, or
 * `A [mm²]`, of which it is that of the length; or that it is `unknown`.
 */
function unitOfCell(cell, line, ofArea) {
  const [, bracket, word] = cell.match(/([[(]?)\s*([^[(/_,\s\])]*)\s*[\])]?$/);
  const length = word.replace(SQUARE, "");
  const unit = (length !== word) === ofArea ? unitOf(length) : undefined;
  if (unit || bracket !== "[") return { unit };
  const known = Object.keys(LENGTHS).map((each) => each + (ofArea ? "²" : ""));
  return { unknown: `Line ${line}: the unit ${word} is none of ${known.join(", ")}` };
}

/** Return the name and the unit of each column, where the heading gives them. */
function columnsOf({ heading, separator, rows }) {
  const columns = rows[0].cells.map(() => ({ name: "" }));
  for (const { number, text } of heading) {
    const common = unitOf(text.match(/\bunits?\b\W*(\S+?)\W*$/i)?.[1]);
    if (common) columns.forEach((column) => (column.unit = common));
    // A unit stays with its name where blanks separate columns.
    const joined = text.replace(/\s+(?=[[(])/g, "").replace(/\s*\/\s*|\s+in\s+/g, "/");
    const cells = cellsOf(joined, separator);
    // Data of the measurement, such as `Length; 0,8 mm`, name no column.
    if (cells.length !== columns.length || cells.some((cell) => /^[-+]?\d/.test(cell))) continue;
    columns.forEach((column, i) => {
      column.name += ` ${cells[i]}`;
      const { unit, unknown } = unitOfCell(cells[i], number, isArea(column));
      column.unit = unit ?? column.unit;
      column.unknown ??= unknown;
    });
  }
  return columns;
}

/** Return the indices of the two columns; areas may stand in place of radii. */
function chosen(columns, line, { names, ask }) {
  const place = (patterns) => patterns.map((p) => columns.findIndex(({ name }) => p.test(name))).find((i) => i >= 0);
  let [r, f] = names.map(place);
  const areas = columns.findIndex(isArea);
  if (names[0] === RADIUS && r === undefined && areas >= 0) r = areas;
  if (r !== undefined && f !== undefined && r !== f) return [r, f];
  if (columns.length === 2) return [0, 1];
  throw new Error(`Line ${line}: ${columns.length} columns; name ${ask} in a line above`);
}

/**
 * Return the table that a text holds: `r` and `f` as written, or r = √(A/π) if `ofAreas`, `units`
 * of both where a heading names them, else undefined, and the number of each `lines`. An error
 * names the line.
 */
export function readTable(text, kind = PROFILE) {
  const lines = linesOf(text);
  const attempts = DIALECTS.map((dialect) => rowsIn(lines, dialect));
  const found = attempts.find(({ rows, wrong }) => rows.length && !wrong);
  if (!found) {
    const furthest = attempts.filter(({ wrong }) => wrong).sort((a, b) => b.rows.length - a.rows.length)[0];
    throw new Error(furthest
      ? `Line ${furthest.wrong}: ${furthest.count} numbers are expected`
      : `no line holds two numbers, ${kind.expected}`);
  }
  const { rows } = found;
  const width = rows[0].cells.length;
  if (found.separator.source === "," && width > 2 && rows.every(({ cells }) => cells.every((cell) => /^[-+]?\d+$/.test(cell)))) {
    throw new Error(`Line ${rows[0].number}: a comma may separate columns or decimals; separate columns by ; or tabs`);
  }
  const columns = columnsOf(found);
  const [r, f] = chosen(columns, rows[0].number, kind);
  [r, f].forEach((at, i) => {
    const { unit, unknown } = columns[at];
    if (unknown && !unit) throw new Error(unknown);
    if (unit && !Object.hasOwn(kind.units[i], unit)) {
      throw new Error(`${kind.heads[i]} in ${unit}: its units are ${Object.keys(kind.units[i]).join(", ")}`);
    }
  });
  const numbers = (i) => rows.map(({ cells }) => Number(cells[i].replace(",", ".").replace(/d/i, "e")));
  let radii = numbers(r);
  const ofAreas = kind === PROFILE && isArea(columns[r]);
  if (ofAreas) {
    const least = radii.indexOf(Math.min(...radii));
    if (radii[least] < 0) throw new Error(`Line ${rows[least].number}: an area is negative`);
    radii = radii.map((area) => Math.sqrt(area / Math.PI));
  }
  return {
    r: radii, f: numbers(f), ofAreas, units: [columns[r].unit, columns[f].unit], lines: rows.map(({ number }) => number),
  };
}
