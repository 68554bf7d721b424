// Tables of radii and heights, and curves of force over depth, as the service reads them.

/** Units of length -> metres. */
export const LENGTHS = { m: 1, mm: 1e-3, "µm": 1e-6, nm: 1e-9 };
/** Units of force -> newtons. */
export const FORCES = { N: 1, mN: 1e-3, "µN": 1e-6, nN: 1e-9 };

// `most`: the points of the longest list that the service takes by default.
export const PROFILE = { as: "profile", heads: ["r", "f"], quantities: [["radius", "area"], ["height"]], lists: ["r", "f"], units: [LENGTHS, LENGTHS], most: 2000 };
export const CURVE = {
  as: "curve", heads: ["d", "F"], quantities: [["depth"], ["force"]], lists: ["indentation_depth", "normal_force"], units: [LENGTHS, FORCES], most: 100000,
};

/**
 * Return the table that a text or the bytes of a file hold: `r` and `f`, `units` of both where a
 * heading names them, else null, `notes` on the columns, the `axis` of a profile, the number of each of its `lines`, its `segments`, the `times` of its points, the `drift` of its depths per second with its
 * standard error, its `columns`, pairs of number and name, and those that are `taken`.
 * `chosen` are two of the numbers. An error names the line, and has the `columns` that are in doubt.
 */
export async function readTable(content, kind, chosen) {
  const query = `as=${kind.as}${chosen ? `&columns=${chosen}` : ""}`;
  const response = await fetch(`v1/table?${query}`, { method: "POST", headers: { "content-type": "text/plain" }, body: content })
    .catch(() => { throw new Error("The service cannot be reached"); });
  const answer = await response.json().catch(() => ({ detail: `The service answered ${response.status}` }));
  if (!response.ok) {
    const [first, ...choices] = answer.errors ?? [answer];
    throw Object.assign(new Error(first.detail), { columns: choices.map(({ pointer, detail }) => [pointer.split("/").pop(), detail]) });
  }
  const offered = (unit, i) => unit === null || Object.hasOwn(kind.units[i], unit);
  // In metres or newtons where the page does not offer the unit.
  const [r, f] = kind.lists.map((name, i) =>
    offered(answer.units[i], i) ? answer[name] : answer[name].map((x) => Number((x * answer.scales[i]).toPrecision(15))));
  const units = answer.units.map((unit, i) => (offered(unit, i) ? unit : Object.keys(kind.units[i])[0]));
  const { lines, segments, columns, notes, axis, time: times } = answer;
  const scale = offered(answer.units[0], 0) ? 1 : answer.scales[0];
  const drift = answer.drift_rate && [...answer.drift_rate, ...answer.drift_rate_error].map((x) => x * scale);
  return {
    r, f, units, lines, segments, times, drift, notes, axis,
    columns: columns.map(({ name, unit }, i) => [String(i + 1), unit ? `${name} [${unit}]` : name]),
    taken: kind.quantities.map((names) => String(columns.findIndex(({ quantity }) => names.includes(quantity)) + 1)),
  };
}
