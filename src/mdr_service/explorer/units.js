// Display units. The inputs and the wire are in SI units throughout.

import { LENGTHS } from "./table_reader.js";

// Largest magnitude of a number in a request.
const LARGEST = 1e50;

const PRESSURES = { GPa: 1e9, MPa: 1e6, kPa: 1e3, Pa: 1 };

// Dimension of a base unit -> its key in the inputs, its label in the form, and its choices.
export const BASE_UNITS = {
  length: { key: "ul", label: "Lengths", factors: LENGTHS },
  displacement: { key: "ud", label: "Depths", factors: LENGTHS },
  force: { key: "uf", label: "Forces", factors: { kN: 1e3, N: 1, mN: 1e-3, "µN": 1e-6, nN: 1e-9 } },
  pressure: { key: "up", label: "Pressures", factors: PRESSURES },
  modulus: { key: "um", label: "Moduli", factors: PRESSURES },
};

// Derived dimension -> powers of the base units.
const DERIVED = {
  energy: { force: 1, displacement: 1 },
  stiffness: { force: 1, displacement: -1 },
  volume: { length: 3 },
  "1/pressure": { fixed: "mm³/J", factor: 1e-9 },
  1: { fixed: "", factor: 1 },
};

const SUPERSCRIPTS = { 1: "", 2: "²", 3: "³" };

/** Return the display unit `{name, factor}` of a dimension: SI value = shown value × factor. */
export function unit(dimension, inputs) {
  const base = BASE_UNITS[dimension];
  if (base) return { name: inputs[base.key], factor: base.factors[inputs[base.key]] };
  const derived = DERIVED[dimension];
  if (!derived) return { name: dimension.replace("length", "m"), factor: 1 };
  if (derived.fixed !== undefined) return { name: derived.fixed, factor: derived.factor };
  let [above, below, factor] = [[], [], 1];
  for (const [part, power] of Object.entries(derived)) {
    const { name, factor: each } = unit(part, inputs);
    factor *= each ** power;
    (power > 0 ? above : below).push(name + SUPERSCRIPTS[Math.abs(power)]);
  }
  return { name: above.join("·") + (below.length ? "/" + below.join("·") : ""), factor };
}

/** Return a label with the display unit of its dimension. */
export function withUnit([label, dimension], inputs) {
  const { name } = unit(dimension, inputs);
  return name ? `${label} [${name}]` : label;
}

/** Return SI values, null where infinite and NaN where there is none, in their display unit. */
export function scaled(values, dimension, inputs) {
  const { factor } = unit(dimension, inputs);
  return values.map((value) => (value === null ? null : value / factor));
}

/** Return a number with `digits` significant digits, without trailing zeros. */
export function format(value, digits = 5) {
  if (value === null) return "∞";
  if (Number.isNaN(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-4) {
    const [mantissa, exponent] = value.toExponential(digits - 1).split("e");
    return `${mantissa.replace(/\.?0+$/, "").replace("-", "−")}e${Number(exponent)}`;
  }
  return String(Number(value.toPrecision(digits))).replace("-", "−");
}

/** Return an SI value, null where infinite, with its display unit. */
export function quantity(value, dimension, inputs, digits) {
  const { name, factor } = unit(dimension, inputs);
  return `${format(value && value / factor, digits)} ${name}`.trim();
}

/** Return the number that a text holds in decimal notation, or NaN. */
export function numberOf(text) {
  const cleaned = text.trim().replace("−", "-");
  const number = /^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i.test(cleaned) ? Number(cleaned) : NaN;
  // The service accepts no larger number, and the drawings overflow at larger ones.
  return Math.abs(number) <= LARGEST ? number : NaN;
}

/** Return what is wrong with a text that holds no number. */
export function noNumber(text) {
  return text.includes(",") ? "write a decimal point in place of the comma" : "not a number";
}

/** Return a number times a power of ten without its rounding error, like the product of decimals. */
export function times(number, factor) {
  return Number((number * factor).toPrecision(15));
}

/** Return an SI value as text for an input in its display unit. */
export function shown(value, dimension, inputs) {
  return String(Number((value / unit(dimension, inputs).factor).toPrecision(12)));
}

/** Return the SI value of a text in its display unit, or NaN. */
export function read(text, dimension, inputs) {
  return times(numberOf(text), unit(dimension, inputs).factor);
}
