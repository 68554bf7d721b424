// Charts from plain descriptions: curves over one axis, or a map with contours.

import { make, makeButton, makeTable } from "./dom.js";
import { download, fileName } from "./requests.js";
import { format, largest, scaled, unit, withUnit } from "./units.js";

const figures = new Map();
// Plotly runs after the first requests have been sent, and before this event.
const plotlyLoaded = new Promise((done) => addEventListener("DOMContentLoaded", done, { once: true }));
let linking = false;
// Width of a chart below which a colour bar stands above its map [px].
const NARROW = 600;

function theme() {
  const style = getComputedStyle(document.documentElement);
  const read = (name) => style.getPropertyValue(name).trim();
  return {
    ink: read("--ink"), faint: read("--faint"), grid: read("--grid"), paper: read("--card"),
    line: read("--line-1"), second: read("--line-2"), limit: read("--line-3"), marker: read("--mark"),
  };
}

const ends = (values) => [Math.min(...values), Math.max(...values)];

/** Return the axes of a chart, each `[label, dimension, size of the values]`. */
function sized(spec) {
  const axis = (name) => spec[name] && [...spec[name].slice(0, 2), largest(spec.traces.flatMap((trace) => (trace[name] ?? []).flat()))];
  return { ...spec, x: axis("x"), y: axis("y"), z: axis("z") };
}

/**
 * Return half as much again as nine tenths of the positive values of a field reach, and the place of
 * its peak, if the field is infinite or much larger there; next to a singular edge few points would
 * leave nothing of the others.
 */
function peakOf({ x, y }) {
  const [start] = ends(x);
  const finite = x.flatMap((at, i) => (Number.isFinite(y[i]) ? [[at, Math.abs(y[i])]] : [])).sort(([a], [b]) => a - b);
  if (finite.length < 30) return null;
  // The radii crowd towards the edge: weigh each value by the distance to the one before.
  const widths = finite.map(([at], i) => at - (i ? finite[i - 1][0] : start));
  const order = finite.map((_, i) => i).filter((i) => finite[i][1] > 0).sort((i, j) => finite[i][1] - finite[j][1]);
  const whole = order.reduce((sum, i) => sum + widths[i], 0);
  let [sum, at] = [0, 0];
  while (at < order.length - 1 && sum + widths[order[at]] < 0.9 * whole) sum += widths[order[at++]];
  const bound = 1.5 * (finite[order[at]]?.[1] ?? 0);
  const infinite = y.indexOf(null);
  const highest = finite[order.at(-1)];
  if (!(bound > 0) || (infinite < 0 && highest[1] < 2 * bound)) return null;
  const sign = Math.sign(y[x.indexOf(highest[0])]);
  return { bound, sign, at: infinite >= 0 ? x[infinite] : highest[0], isInfinite: infinite >= 0 };
}

function curve(trace, spec, inputs, colours) {
  const role = trace.role ?? "line";
  const colour = colours[role];
  return {
    name: trace.name,
    x: scaled(trace.x, spec.x[1], inputs, spec.x[2]),
    y: scaled(trace.y, spec.y[1], inputs, spec.y[2]),
    mode: trace.mode ?? "lines",
    line: { color: colour, width: 2, simplify: false, dash: role === "limit" ? "dash" : "solid" },
    marker: { color: colour, size: 10 },
    fill: trace.fill ? "tozeroy" : "none",
    fillcolor: `${colour}22`,
    hovertemplate: "%{y:.5~g}",
  };
}

/** Return the levels of a map of stresses, up to half as much again as all but a fiftieth of them. */
function levels(z) {
  const sizes = z.flat().filter((value) => value !== null).sort((a, b) => a - b);
  const most = 1.5 * sizes[Math.floor(0.98 * (sizes.length - 1))];
  // Next to a singular edge few points would leave a single colour for the others.
  if (!(sizes.at(-1) > most && most > 0)) return { ncontours: 24 };
  return { zauto: false, zmin: 0, zmax: most, autocontour: false, contours: { start: 0, end: most, size: most / 20 } };
}

function contours(trace, spec, inputs, colours, { width }) {
  const z = trace.z.map((row) => scaled(row, spec.z[1], inputs, spec.z[2]));
  return {
    type: "contour",
    x: scaled(trace.x, spec.x[1], inputs, spec.x[2]),
    y: scaled(trace.y, spec.y[1], inputs, spec.y[2]),
    z,
    colorscale: "Viridis",
    ...levels(z),
    line: { width: 0.4 },
    // A narrow chart has no space for the colour bar beside the map.
    colorbar: {
      title: { text: withUnit(spec.z, inputs, spec.z[2]), side: width < NARROW ? "top" : "right" },
      tickfont: { color: colours.ink },
      ...(width < NARROW ? { orientation: "h", thickness: 14, y: 1.12, yanchor: "bottom" } : {}),
    },
    hovertemplate: "x %{x:.4~g}, z %{y:.4~g}: %{z:.4~g}<extra></extra>",
  };
}

function verticals(spec, inputs, colours) {
  const factor = unit(spec.x[1], inputs, spec.x[2]).factor;
  const at = (spec.edges ?? []).filter(([, radius]) => radius > 0);
  const edges = spec.mirrored ? at.flatMap(([name, radius]) => [[name && `−${name}`, -radius], [name, radius]]) : at;
  const lines = edges.map(([, radius]) => ({
    type: "line", x0: radius / factor, x1: radius / factor, y0: 0, y1: 1, yref: "y domain",
    line: { color: colours.faint, width: 1, dash: "dot" },
  }));
  const named = edges.filter(([name]) => name);
  const reach = Math.max(...(spec.range ?? spec.traces.flatMap(({ x }) => x)));
  // Names of neighbours stand on the outer sides of their lines.
  const isNear = (i, j) => named[j] && Math.abs(named[j][1] - named[i][1]) < 0.05 * reach;
  const notes = named.map(([name, radius], i) => ({
    x: radius / factor, y: 1, yref: "y domain", yanchor: "bottom", text: name, showarrow: false,
    xanchor: isNear(i, i + 1) ? "right" : isNear(i, i - 1) ? "left" : "center",
    font: { color: colours.ink, size: 12 },
  }));
  return { lines, notes };
}

/** Return a title in lines of at most `most` characters. */
function wrapped(text, most) {
  const lines = [""];
  for (const word of text.replace(/ \[/, " \u00a0[").split(" ")) {
    const line = `${lines.at(-1)} ${word}`.trim();
    if (line.length > most && lines.at(-1)) lines.push(word);
    else lines[lines.length - 1] = line;
  }
  return lines.join("<br>").replaceAll("\u00a0", "");
}

/** Return the note at a peak that the chart cuts. */
function peakNote({ at, sign, isInfinite }, spec, inputs, colours) {
  // A finite peak is the value of the nearest radius, which no grid resolves.
  const text = `${sign < 0 ? "↓" : "↑"} ${isInfinite ? "∞" : "peak"}`;
  return {
    x: at / unit(spec.x[1], inputs, spec.x[2]).factor, y: sign < 0 ? 0 : 1, yref: "y domain",
    yanchor: sign < 0 ? "bottom" : "top", xanchor: "left", xshift: 5,
    text, showarrow: false, font: { color: colours.marker, size: 12 },
  };
}

/** Return the range of the ordinate: downwards and to scale for a map, up to a peak that is cut. */
function rangeOf(spec, inputs, peak) {
  if (spec.map) {
    const depths = scaled(spec.traces[0].y, spec.y[1], inputs, spec.y[2]);
    return { range: [Math.max(...depths), Math.min(...depths)], scaleanchor: "x", constrain: "domain" };
  }
  if (!peak && !spec.range) return { autorange: true };
  const { factor } = unit(spec.y[1], inputs, spec.y[2]);
  const isShown = (at) => !spec.range || (at >= spec.range[0] && at <= spec.range[1]);
  const values = spec.traces.flatMap(({ x, y }) => y.filter((value, i) => Number.isFinite(value) && isShown(x[i])));
  const [low, high] = ends(values);
  const bound = peak?.bound ?? Infinity;
  const range = [Math.max(low, -bound), Math.min(high, bound)].map((end) => end / factor);
  return { autorange: false, range: [range[0] - 0.05 * (range[1] - range[0]) * (low < 0), range[1] + 0.05 * (range[1] - range[0])] };
}

function layout(spec, inputs, colours, { width, height }) {
  const { lines, notes } = verticals(spec, inputs, colours);
  // Mean width of a character of the font [px].
  const fitting = (length) => Math.max(12, Math.floor(length / 8.3));
  const peak = spec.linked ? spec.traces.map(peakOf).find(Boolean) : undefined;
  if (peak) notes.push(peakNote(peak, spec, inputs, colours));
  const axis = (title, length) => ({
    title: { text: wrapped(withUnit(title, inputs, title[2]), fitting(length)), standoff: 8 }, automargin: true,
    gridcolor: colours.grid, zerolinecolor: colours.faint, linecolor: colours.faint,
    exponentformat: "power",
  });
  return {
    font: { color: colours.ink, family: "system-ui, sans-serif", size: document.documentElement.className === "printing" ? 11 : 13 },
    paper_bgcolor: colours.paper, plot_bgcolor: colours.paper,
    margin: { l: 56, r: 16, t: 24, b: 48 },
    showlegend: !spec.map && spec.traces.length > 1,
    legend: { orientation: "h", x: 0, y: 1.09, yanchor: "bottom" },
    dragmode: spec.selects ? "select" : "zoom", selectdirection: "h", selections: [],
    hovermode: spec.map ? "closest" : "x unified",
    hoverlabel: { bgcolor: colours.paper, font: { color: colours.ink } },
    xaxis: {
      ...axis(spec.x, width - 100), type: spec.logarithmic ? "log" : "linear",
      range: (spec.range ?? (spec.map ? ends(spec.traces[0].x) : undefined))?.map((x) => x / unit(spec.x[1], inputs, spec.x[2]).factor),
      constrain: "domain",
    },
    yaxis: {
      ...axis(spec.y, height - 130), type: spec.logarithmic ? "log" : "linear",
      ...rangeOf(spec, inputs, peak),
    },
    shapes: lines, annotations: notes,
  };
}

/** Return the columns `[title, values]` of each data table: one for traces over the same values. */
function columns(spec) {
  const tables = new Map();
  for (const { name, x, y } of spec.traces) {
    if (!tables.has(x)) tables.set(x, [[spec.x, x]]);
    tables.get(x).push([[name, spec.y[1], spec.y[2]], y]);
  }
  return [...tables.values()];
}

/** Return the positions and values of a map, one row each. */
function mapPoints(spec) {
  const { x, y, z } = spec.traces[0];
  const repeated = y.flatMap((depth) => x.map(() => depth));
  return [[[spec.x, y.flatMap(() => x)], [spec.y, repeated], [spec.z, z.flat()]]];
}

/** Return the data of a chart as CSV, in the units of the chart: tables beside each other. */
function csvOf({ spec, inputs }) {
  const shown = (spec.map ? mapPoints : columns)(spec).flat().map(([title, values]) =>
    [withUnit(title, inputs, title[2]), scaled(values, title[1], inputs, title[2])]);
  const cell = (value) => (value === null ? "inf" : value === undefined || Number.isNaN(value) ? "" : Number(value.toPrecision(15)));
  const length = Math.max(...shown.map(([, values]) => values.length));
  const rows = Array.from({ length }, (_, i) => shown.map(([, values]) => cell(values[i])));
  return [shown.map(([title]) => `"${title}"`), ...rows].map((row) => `${row.join(",")}\n`).join("");
}

/** Return the largest value of each depth: a map has too many values for a table to read. */
function mapColumns(spec) {
  const { x, y, z } = spec.traces[0];
  const most = z.map((row) => Math.max(...row.filter((value) => value !== null)));
  const where = z.map((row, i) => x[row.indexOf(most[i])]);
  return [[[spec.y, y], [["largest value", ...spec.z.slice(1)], most], [["at x", ...spec.x.slice(1)], where]]];
}

function dataTables(spec, inputs) {
  return (spec.map ? mapColumns : columns)(spec).map((table) => {
    const titles = table.map(([title]) => withUnit(title, inputs, title[2]));
    const cells = table.map(([[, dimension, size], values]) => scaled(values, dimension, inputs, size));
    return makeTable(titles, cells[0].map((_, i) => cells.map((column) => format(column[i], 6))));
  });
}

function save(figure, format) {
  const filename = fileName(figure.spec.title);
  Plotly.downloadImage(figure.plot, { format, filename, width: 800, height: 500, scale: format === "png" ? 2 : 1 });
}

function create(spec, { showRequest }) {
  const figure = { plot: make("div", { className: "plot", role: "img" }) };
  const button = (text, act) => makeButton(text, act, { "aria-label": `${text} of “${spec.title}”` });
  const buttons = make("span", { className: "save" },
    button("Request", () => showRequest(figure.spec.request)),
    button("CSV", () => download(`${fileName(spec.title)}.csv`, csvOf(figure), "text/csv")),
    button("PNG", () => save(figure, "png")),
    button("SVG", () => save(figure, "svg")));
  const data = make("details", { ontoggle: () => fillTable(figure) },
    make("summary", {}, "Data table"), make("div", { className: "data", tabIndex: 0 }));
  const caption = make("figcaption", {}, make("h2", {}, spec.title), buttons);
  figure.element = make("figure", {}, caption, figure.plot, data);
  return figure;
}

function fillTable(figure) {
  const details = figure.element.querySelector("details");
  if (details.open) details.querySelector(".data").replaceChildren(...dataTables(figure.spec, figure.inputs));
}

/** Show the radius under the cursor in every chart against the radius. */
function link(figure, { select }) {
  figure.plot.on("plotly_selected", (event) => {
    const factor = unit(figure.spec.x[1], figure.inputs, figure.spec.x[2]).factor;
    if (event?.range) select(event.range.x.map((x) => x * factor).sort((a, b) => a - b));
  });
  const others = () => [...figures.values()].filter((other) => other !== figure && other.spec.linked);
  const forOthers = (act) => {
    if (linking || !figure.spec.linked) return;
    linking = true;
    others().forEach(act);
    linking = false;
  };
  figure.plot.on("plotly_hover", ({ xvals }) =>
    forOthers((other) => Plotly.Fx.hover(other.plot, { xval: xvals[0] })));
  figure.plot.on("plotly_unhover", () => forOthers((other) => Plotly.Fx.unhover(other.plot)));
}

function plot({ spec, inputs, plot }, size) {
  const colours = theme();
  const space = { width: plot.clientWidth, height: plot.clientHeight };
  const traces = spec.traces.map((trace) => (trace.z ? contours : curve)(trace, spec, inputs, colours, space));
  const options = { displayModeBar: false, responsive: true };
  return Plotly.react(plot, traces, { ...layout(spec, inputs, colours, space), ...size }, options);
}

/** Draw the charts again at once, in the present colours and sizes. */
export function redraw() {
  for (const figure of figures.values()) {
    const { clientWidth: width, clientHeight: height } = figure.plot;
    plot(figure, { width, height });
  }
}

/**
 * Draw the charts of a response, reusing those with the same title.
 *
 * `actions.showRequest` is called with the name of a chart's request, `actions.select` with the SI
 * range over which the user drags in a chart that `selects`.
 */
export async function draw(container, specs, inputs, actions) {
  await plotlyLoaded;
  for (const [title, figure] of figures) {
    if (specs.some((spec) => spec.title === title)) continue;
    Plotly.purge(figure.plot);
    figure.element.remove();
    figures.delete(title);
  }
  for (const spec of specs.map(sized)) {
    const known = figures.get(spec.title);
    const figure = known ?? create(spec, actions);
    Object.assign(figure, { spec, inputs });
    figure.element.className = `${spec.size ?? ""} ${spec.map ? "map" : ""}`.trim();
    figure.plot.setAttribute("aria-label", `${spec.title}: ${spec.y[0]} against ${spec.x[0]}`);
    // The legend of a narrow chart has a row for each curve.
    figure.plot.style.setProperty("--rows", spec.map || spec.traces.length < 3 ? 0 : spec.traces.length - 1);
    // In the order of the description, whatever was there before.
    container.append(figure.element);
    await plot(figure, { autosize: true });
    if (!known) link(figure, actions);
    figures.set(spec.title, figure);
    fillTable(figure);
  }
}
