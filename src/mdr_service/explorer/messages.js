// Messages of the service in the words and units of the page.

import { QUANTITIES } from "./quantities.js";
import { format, quantity } from "./units.js";

const NUMBER = String.raw`-?\d+(?:\.\d+)?(?:e[-+]?\d+)?`;
const EACH = new RegExp(NUMBER, "g");
// Words of the service next to numbers that have a unit -> their dimension.
const WORDS = [
  [/(?:radius|radii)(?: of the body,| beyond| =|,)? /, "length", ""],
  [/of the axis, near /, "length", ""],
  [/deviates by |pull-off depth, |at the depth /, "displacement", ""],
  [/a normal force of |pull-off force, /, "force", ""],
  ["", "displacement", / in the root mean square/],
];
const PATTERNS = WORDS.map(([before, dimension, after]) =>
  [new RegExp(`(${before.source ?? ""})(${NUMBER}(?:(?:, | to )${NUMBER})*)(${after.source ?? ""})`, "g"), dimension]);
const NAMES = /\b[a-z]+(?:_[a-z]+)+\b/g;

/**
 * Return a message with the labels of the page in place of names, and with units.
 *
 * `labels` holds the label of each field by its name in requests.
 */
export function inWords(message, inputs, labels) {
  const inUnits = (text, [pattern, dimension]) => {
    const meant = dimension === "oscillation" ? QUANTITIES[inputs.oscillation][1] : dimension;
    return text.replace(pattern, (_, before, numbers, after) =>
      before + numbers.replace(EACH, (number) => quantity(Number(number), meant, inputs)) + after);
  };
  const label = (name) => {
    const text = labels[name] ?? QUANTITIES[name]?.[0];
    return text ? `“${text}”` : name;
  };
  // The least number on the wire says nothing in units.
  const inLabels = PATTERNS.reduce(inUnits, message.replace(/, at least 1e-\d+$/, "")).replace(NAMES, label);
  return inLabels.replace(/(?<![\w.·])\d+(?:\.\d+)?e[-+]?\d+/g, (number) => format(Number(number)));
}
