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

const prefixed = (symbol, factor = 1) => Object.fromEntries(
  Object.entries({ M: 1e6, k: 1e3, "": 1, m: 1e-3, "µ": 1e-6, n: 1e-9, p: 1e-12 })
    .map(([prefix, size]) => [prefix + symbol, size * factor]));

// Dimensions with a unit of their own -> its name, and the units by size if there are several.
const OWN_UNITS = {
  energy: { name: "J", factors: prefixed("J") },
  s: { name: "s", factors: { s: 1, ms: 1e-3, "µs": 1e-6, ns: 1e-9 } },
  "m/s": { name: "m/s", factors: { "m/s": 1, "mm/s": 1e-3, "µm/s": 1e-6, "nm/s": 1e-9 } },
  "N·m": { name: "N·m", factors: { "N·m": 1, "N·mm": 1e-3, "µN·m": 1e-6, "nN·m": 1e-9 } },
  rad: { name: "rad", factors: { rad: 1, mrad: 1e-3, "µrad": 1e-6 } },
  "N/m": { name: "N/m", factors: { "N/m": 1 } },
  kg: { name: "g", factors: { kg: 1, g: 1e-3 } },
  "kg/m³": { name: "kg/m³", factors: { "kg/m³": 1 } },
  "1/pressure": { name: "mm³/J", factors: { "mm³/J": 1e-9 } },
  1: { name: "", factors: { "": 1 } },
};
// Derived dimension -> powers of the base units.
const DERIVED = {
  stiffness: { force: 1, displacement: -1 }, compliance: { displacement: 1, force: -1 }, volume: { length: 3 },
};

const SUPERSCRIPTS = { 1: "", 2: "²", 3: "³" };

// Sizes of numbers that are shown in the unit that is chosen.
const [LEAST, MOST] = [1e-3, 1e5];

/** Return the unit of a size among units `{name: factor}`: the largest that leaves at least 1. */
function bySize(factors, size) {
  const names = Object.keys(factors).sort((a, b) => factors[b] - factors[a]);
  const name = names.find((each) => size >= factors[each]) ?? names.at(-1);
  return { name, factor: factors[name] };
}

/**
 * Return the display unit `{name, factor}` of a dimension: SI value = shown value × factor.
 *
 * With the size of an SI value it is a unit in which the number is easily read; the chosen unit is
 * kept for numbers from `least`.
 */
export function unit(dimension, inputs, size, least = LEAST) {
  const isSized = size > 0 && Number.isFinite(size);
  const base = BASE_UNITS[dimension];
  if (base) {
    const factor = base.factors[inputs[base.key]];
    const fits = !isSized || (size >= least * factor && size < MOST * factor);
    return fits ? { name: inputs[base.key], factor } : bySize(base.factors, size);
  }
  const own = OWN_UNITS[dimension];
  if (own) return isSized ? bySize(own.factors, size) : { name: own.name, factor: own.factors[own.name] };
  const powers = DERIVED[dimension];
  if (!powers) return { name: dimension.replace("length", "m"), factor: 1 };
  if (dimension === "volume" && isSized) {
    const cubes = Object.fromEntries(Object.entries(LENGTHS).map(([name, factor]) => [`${name}³`, factor ** 3]));
    const chosen = cubes[`${inputs.ul}³`];
    if (size < LEAST * chosen || size >= MOST * chosen) return bySize(cubes, size);
  }
  let [above, below, factor] = [[], [], 1];
  for (const [part, power] of Object.entries(powers)) {
    const { name, factor: each } = unit(part, inputs);
    factor *= each ** power;
    (power > 0 ? above : below).push(name + SUPERSCRIPTS[Math.abs(power)]);
  }
  return { name: above.join("·") + (below.length ? "/" + below.join("·") : ""), factor };
}

/** Return a label with the display unit of its dimension, for values of a size. */
export function withUnit([label, dimension], inputs, size) {
  const { name } = unit(dimension, inputs, size);
  return name ? `${label} [${name}]` : label;
}

/** Return SI values, null where infinite and NaN where there is none, in the display unit of a size. */
export function scaled(values, dimension, inputs, size) {
  const { factor } = unit(dimension, inputs, size);
  return values.map((value) => (value === null ? null : value / factor));
}

/** Return the largest magnitude of SI values, null where infinite and NaN where there is none. */
export function largest(values) {
  return values.reduce((size, value) => (Math.abs(value) > size ? Math.abs(value) : size), 0);
}

const POWER = { "-": "⁻", 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹" };

/** Return a number with `digits` significant digits, without trailing zeros. */
export function format(value, digits = 5) {
  if (value === null) return "∞";
  if (Number.isNaN(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-4) {
    const [mantissa, exponent] = value.toExponential(digits - 1).split("e");
    const power = [...String(Number(exponent))].map((digit) => POWER[digit]).join("");
    const number = String(Number(mantissa)).replace("-", "−");
    return `${number}·10${power}`;
  }
  return String(Number(value.toPrecision(digits))).replace("-", "−");
}

/** Return an SI value, null where infinite, with its display unit. */
export function quantity(value, dimension, inputs, digits) {
  const { name, factor } = unit(dimension, inputs, Math.abs(value));
  return `${format(value && value / factor, digits)} ${name}`.trim();
}

/** Return an SI value ± its standard error, which has two digits, with the display unit. */
export function uncertain(value, error, dimension, inputs) {
  const { name, factor } = unit(dimension, inputs, Math.max(Math.abs(value), error), 1);
  const [number, spread] = [value / factor, error / factor];
  const decimals = Math.min(Math.max(1 - Math.floor(Math.log10(spread)), 0), 15);
  if (!(spread > 0) || spread >= 1e6 || spread < 1e-12) {
    return `${format(number)} ± ${format(spread, 2)} ${name}`.trim();
  }
  const [shown, digits] = [number, spread].map((each) => each.toFixed(decimals).replace("-", "−"));
  return `${shown} ± ${digits} ${name}`.trim();
}

/** Return the number that a text holds in decimal notation, or NaN. */
export function numberOf(text) {
  const cleaned = text.trim().replace("−", "-");
  const number = /^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i.test(cleaned) ? Number(cleaned) : NaN;
  // The service accepts no larger number, and the drawings overflow at larger ones.
  return Math.abs(number) <= LARGEST ? number : NaN;
}

// A comma before groups of three digits may separate thousands.
const THOUSANDS = /^[-+]?[1-9]\d{0,2}(,\d{3})+(?!\d)/;
// Units that people write beside those of the form -> SI.
const WRITTEN = {
  length: { cm: 1e-2, pm: 1e-12 },
  force: { MN: 1e6, pN: 1e-12 },
  pressure: { TPa: 1e12, "N/mm²": 1e6, "N/mm2": 1e6, bar: 1e5 },
  kg: { mg: 1e-6, "µg": 1e-9, t: 1e3 },
  "kg/m³": { "kg/m3": 1, "g/cm³": 1e3, "g/cm3": 1e3 },
  "N/m": { "mN/m": 1e-3, "J/m²": 1, "J/m2": 1, "mJ/m²": 1e-3, "mJ/m2": 1e-3 },
  "1/pressure": { "mm3/J": 1e-9, "m³/J": 1, "m3/J": 1, "1/Pa": 1 },
};
const SAME = { displacement: "length", modulus: "pressure" };

/** Return the units `{name: factor}` that a text of a dimension may name. */
function readable(dimension) {
  const { factors } = BASE_UNITS[dimension] ?? OWN_UNITS[dimension] ?? { factors: {} };
  return { ...factors, ...WRITTEN[SAME[dimension] ?? dimension] };
}

/** Return the number and the unit of a text, which may have a decimal comma or be a fraction. */
function parts(text) {
  const [, digits, rest] = text.trim().replace("−", "-").match(/^([-+]?[\d.,]+(?:e[-+]?\d+)?)(.*)$/i) ?? [];
  if (digits === undefined || THOUSANDS.test(digits)) return { number: NaN };
  const number = numberOf(digits.replace(/^([^.,]*),([^.,]*)$/, "$1.$2"));
  const [, below, name] = rest.match(/^\s*(?:\/\s*(\d+))?\s*(.*)$/);
  return { number: below ? number / Number(below) : number, name: name.replace(/[uμ](?=[a-zA-Z])/, "µ") };
}

/** Return what is wrong with a text that holds no number of a dimension. */
export function noNumber(text, dimension) {
  const { number, name } = parts(text);
  if (Number.isNaN(number) && THOUSANDS.test(text.trim())) {
    return `write ${text.trim().replaceAll(",", "")} or, for a decimal, ${text.trim().replace(",", ".")}`;
  }
  if (/^[-+]?\d[\d.]*e?[-+]?\d*$/i.test(text.trim()) && Math.abs(Number(text)) > LARGEST) {
    return "the largest number is 1e50";
  }
  const units = Object.keys(readable(dimension)).filter(Boolean);
  if (!Number.isNaN(number) && name) {
    return units.length ? `“${name}” is not one of its units: ${units.slice(0, 6).join(", ")}` : `a number without a unit, not “${name}”`;
  }
  return text.trim() === "" ? "a number is needed" : "not a number";
}

/** Return a number times a power of ten without its rounding error, like the product of decimals. */
export function times(number, factor) {
  return Number((number * factor).toPrecision(15));
}

/** Return an SI value as text for an input in its display unit. */
export function shown(value, dimension, inputs) {
  if (dimension === "1" && value > 0 && value < 1 && String(value).length > 12) {
    for (const below of [3, 6, 7, 9]) {
      const above = Math.round(value * below);
      if (above / below === value) return `${above}/${below}`;
    }
  }
  return String(Number((value / unit(dimension, inputs).factor).toPrecision(12)));
}

/** Return the SI value of a text in its display unit or in the unit that it names, or NaN. */
export function read(text, dimension, inputs) {
  const { number, name } = parts(text);
  if (name === "" && text.includes("/")) return number;
  const factor = name ? readable(dimension)[name] : unit(dimension, inputs).factor;
  return factor === undefined || Number.isNaN(number) ? NaN : times(number, factor);
}
