// Charts from plain descriptions: curves over one axis, or a map with contours.

import { download } from "./requests.js";
import { format, unit } from "./units.js";

const figures = new Map();
// Plotly runs after the first requests have been sent, and before this event.
const plotlyLoaded = new Promise((done) => addEventListener("DOMContentLoaded", done, { once: true }));
let linking = false;

function theme() {
  const style = getComputedStyle(document.documentElement);
  const read = (name) => style.getPropertyValue(name).trim();
  return {
    ink: read("--ink"), faint: read("--faint"), grid: read("--grid"), paper: read("--card"),
    line: read("--line-1"), second: read("--line-2"), limit: read("--line-3"), marker: read("--mark"),
  };
}

const scaled = (values, factor) => values.map((value) => (value === null ? null : value / factor));

function axisTitle([label, dimension], inputs) {
  const { name } = unit(dimension, inputs);
  return name ? `${label} [${name}]` : label;
}

function curve(trace, spec, inputs, colours) {
  const role = trace.role ?? "line";
  const colour = colours[role];
  return {
    name: trace.name,
    x: scaled(trace.x, unit(spec.x[1], inputs).factor),
    y: scaled(trace.y, unit(spec.y[1], inputs).factor),
    mode: trace.mode ?? "lines",
    line: { color: colour, width: 2, simplify: false, dash: role === "limit" ? "dash" : "solid" },
    marker: { color: colour, size: 10 },
    fill: trace.fill ? "tozeroy" : "none",
    fillcolor: `${colour}22`,
    hovertemplate: "%{y:.5~g}",
  };
}

function contours(trace, spec, inputs, colours) {
  const factor = unit(spec.z[1], inputs).factor;
  return {
    type: "contour",
    x: scaled(trace.x, unit(spec.x[1], inputs).factor),
    y: scaled(trace.y, unit(spec.y[1], inputs).factor),
    z: trace.z.map((row) => scaled(row, factor)),
    colorscale: "Viridis",
    ncontours: 24,
    line: { width: 0.4 },
    colorbar: { title: { text: axisTitle(spec.z, inputs), side: "right" }, tickfont: { color: colours.ink } },
    hovertemplate: "x %{x:.4~g}, z %{y:.4~g}: %{z:.4~g}<extra></extra>",
  };
}

function verticals(spec, inputs, colours) {
  const factor = unit(spec.x[1], inputs).factor;
  const at = (spec.edges ?? []).filter(([, radius]) => radius > 0);
  const edges = spec.map ? at.flatMap(([name, radius]) => [[`−${name}`, -radius], [name, radius]]) : at;
  const lines = edges.map(([, radius]) => ({
    type: "line", x0: radius / factor, x1: radius / factor, y0: 0, y1: 1, yref: "paper",
    line: { color: colours.faint, width: 1, dash: "dot" },
  }));
  const notes = edges.filter(([name]) => name).map(([name, radius]) => ({
    x: radius / factor, y: 1, yref: "paper", yanchor: "bottom", text: name, showarrow: false,
    font: { color: colours.ink, size: 12 },
  }));
  return { lines, notes };
}

function layout(spec, inputs, colours) {
  const { lines, notes } = verticals(spec, inputs, colours);
  const axis = (title) => ({
    title: { text: axisTitle(title, inputs), standoff: 8 }, automargin: true,
    gridcolor: colours.grid, zerolinecolor: colours.faint, linecolor: colours.faint,
    exponentformat: "power",
  });
  return {
    font: { color: colours.ink, family: "system-ui, sans-serif", size: 13 },
    paper_bgcolor: colours.paper, plot_bgcolor: colours.paper,
    margin: { l: 56, r: 16, t: 24, b: 48 },
    showlegend: !spec.map && spec.traces.length > 1,
    legend: { orientation: "h", x: 0, y: 1.09, yanchor: "bottom" },
    hovermode: spec.map ? "closest" : "x unified",
    hoverlabel: { bgcolor: colours.paper, font: { color: colours.ink } },
    xaxis: { ...axis(spec.x), type: spec.logarithmic ? "log" : "linear" },
    yaxis: {
      ...axis(spec.y), type: spec.logarithmic ? "log" : "linear",
      autorange: spec.map ? "reversed" : true,
    },
    shapes: lines, annotations: notes,
  };
}

function columns(spec, inputs) {
  const column = (title, values) => [title, scaled(values, unit(title[1], inputs).factor)];
  const tables = [];
  for (const trace of spec.traces) {
    const known = tables.find((table) => table.x === trace.x);
    const table = known ?? { x: trace.x, columns: [column(spec.x, trace.x)] };
    if (!known) tables.push(table);
    table.columns.push(column([trace.name, spec.y[1]], trace.y));
  }
  return tables;
}

function dataTable(spec, inputs) {
  const parts = spec.map ? mapTable(spec, inputs) : columns(spec, inputs).map(({ columns }) => columns);
  return parts.map((part) => {
    const table = document.createElement("table");
    const head = table.createTHead().insertRow();
    for (const [title] of part) {
      const cell = document.createElement("th");
      cell.scope = "col";
      cell.textContent = axisTitle(title, inputs);
      head.append(cell);
    }
    const body = table.createTBody();
    part[0][1].forEach((_, i) => {
      const row = body.insertRow();
      for (const [, values] of part) row.insertCell().textContent = format(values[i], 6);
    });
    return table;
  });
}

/** Return the largest value of each depth: a map has too many values for a table to read. */
function mapTable(spec, inputs) {
  const { x, y, z } = spec.traces[0];
  const largest = z.map((row) => Math.max(...row.filter((value) => value !== null)));
  const where = z.map((row, i) => x[row.indexOf(largest[i])]);
  const column = (title, values) => [title, scaled(values, unit(title[1], inputs).factor)];
  return [[
    column(spec.y, y), column(["largest value", spec.z[1]], largest), column(["at x", spec.x[1]], where),
  ]];
}

async function picture(figure, type) {
  const svg = await Plotly.toImage(figure.plot, { format: "svg", width: 800, height: 500 });
  const text = decodeURIComponent(svg.slice(svg.indexOf(",") + 1));
  if (type === "svg") return download(`${figure.spec.id}.svg`, text, "image/svg+xml");
  const image = new Image();
  image.src = svg;
  await image.decode();
  const canvas = Object.assign(document.createElement("canvas"), { width: 1600, height: 1000 });
  canvas.getContext("2d").drawImage(image, 0, 0, 1600, 1000);
  canvas.toBlob((blob) => download(`${figure.spec.id}.png`, blob));
}

function create(spec, actions) {
  const element = document.createElement("figure");
  element.innerHTML =
    '<figcaption><h2></h2><span class="save"></span></figcaption>' +
    '<div class="plot" role="img"></div><details><summary>Data table</summary><div class="data" tabindex="0"></div></details>';
  const figure = { element, spec, plot: element.querySelector(".plot") };
  const button = (label, act) => {
    const made = Object.assign(document.createElement("button"), { type: "button", textContent: label });
    made.addEventListener("click", act);
    element.querySelector(".save").append(made);
  };
  button("Request", () => actions.showRequest(figure.spec.request));
  button("CSV", () => actions.saveCsv(figure.spec.request));
  button("PNG", () => picture(figure, "png"));
  button("SVG", () => picture(figure, "svg"));
  element.querySelector("details").addEventListener("toggle", () => fillTable(figure));
  return figure;
}

function fillTable(figure) {
  const details = figure.element.querySelector("details");
  if (details.open) details.querySelector(".data").replaceChildren(...dataTable(figure.spec, figure.inputs));
}

/** Show the radius under the cursor in every chart over the radius. */
function link(figure) {
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
  const traces = spec.traces.map((trace) => (trace.z ? contours : curve)(trace, spec, inputs, colours));
  const options = { displayModeBar: false, responsive: true };
  return Plotly.react(plot, traces, { ...layout(spec, inputs, colours), ...size }, options);
}

/** Draw the charts again at once, in the present colours and sizes. */
export function redraw() {
  for (const figure of figures.values()) {
    const { clientWidth: width, clientHeight: height } = figure.plot;
    plot(figure, { width, height });
  }
}

/**
 * Draw the charts of a response, reusing those that are there.
 *
 * `actions.showRequest` and `actions.saveCsv` are called with the name of a chart's request.
 */
export async function draw(container, specs, inputs, actions) {
  await plotlyLoaded;
  for (const [id, figure] of figures) {
    if (specs.some((spec) => spec.id === id)) continue;
    Plotly.purge(figure.plot);
    figure.element.remove();
    figures.delete(id);
  }
  for (const spec of specs) {
    const known = figures.get(spec.id);
    const figure = known ?? create(spec, actions);
    Object.assign(figure, { spec, inputs });
    figure.element.className = spec.size ?? "";
    figure.element.querySelector("h2").textContent = spec.title;
    figure.element.querySelectorAll("button").forEach((button) =>
      button.setAttribute("aria-label", `${button.textContent} of “${spec.title}”`));
    figure.plot.setAttribute("aria-label", `${spec.title}: ${axisTitle(spec.y, inputs)} over ${axisTitle(spec.x, inputs)}`);
    // In the order of the description, whatever was there before.
    container.append(figure.element);
    await plot(figure, { autosize: true });
    if (!known) link(figure);
    figures.set(spec.id, figure);
    fillTable(figure);
  }
}
