// Editor of a load path: points in the plane of tangential and normal load.

import { dimensionOf, labelOf } from "./analyses.js";
import { pathPoints } from "./inputs.js";
import { format, read, shown, unit } from "./units.js";

const SVG = "http://www.w3.org/2000/svg";
const [WIDTH, HEIGHT, PAD] = [420, 240, 34];

// Paths in shares of a normal load and of the limiting tangential load.
const PRESETS = {
  "Loop at constant force": [[1, 0], [1, 0.7], [1, -0.7], [1, 0.7]],
  "Growing loops": [[1, 0], [1, 0.3], [1, -0.3], [1, 0.6], [1, -0.6], [1, 0.9], [1, -0.9], [1, 0]],
  "Both loads together": [[0.2, 0], [1, 0.7], [0.4, 0], [1, 0.7]],
  "Load, shear, unload": [[1, 0], [1, 0.8], [0.3, 0.2]],
};

function svgElement(name, attributes, parent) {
  const element = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  parent?.append(element);
  return element;
}

/** Show the editor of the load path in `container`; `change(path)` is called with a new one. */
export function showEditor(container, inputs, size, change) {
  const points = pathPoints(inputs);
  const focused = document.activeElement?.dataset?.point;
  const commit = () => change(points.map((point) => point.join(",")).join(";"));
  container.replaceChildren(
    heading(inputs, size, change), drawing(points, inputs, commit), table(points, inputs, commit),
  );
  if (focused) container.querySelector(`[data-point="${focused}"]`)?.focus();
}

function heading(inputs, { normal, tangential }, change) {
  const element = document.createElement("div");
  element.className = "row";
  element.innerHTML = '<h2>Load path</h2><label for="preset">Start from</label><select id="preset"><option value="">…</option></select>';
  const select = element.querySelector("select");
  for (const name of Object.keys(PRESETS)) select.add(new Option(name));
  select.addEventListener("change", () => {
    if (!select.value) return;
    const rounded = (x) => Number(x.toPrecision(3));
    const points = PRESETS[select.value].map(([n, t]) => [rounded(n * normal), rounded(t * tangential)]);
    change(points.map((point) => point.join(",")).join(";"));
  });
  return element;
}

function drawing(points, inputs, commit) {
  const svg = svgElement("svg", {
    viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "group", "aria-label": "Points of the path; move them by the arrow keys",
  });
  const reach = Math.max(...points.map(([, t]) => Math.abs(t))) * 1.25 || 1;
  const top = Math.max(...points.map(([n]) => n)) * 1.15 || 1;
  const place = ([n, t]) => [
    WIDTH / 2 + (t / reach) * (WIDTH / 2 - PAD), HEIGHT - PAD - (n / top) * (HEIGHT - 2 * PAD),
  ];
  const inverse = (x, y) => {
    const rounded = (value, scale) => Number((Math.round((value / scale) * 200) / 200 * scale).toPrecision(3));
    const n = (HEIGHT - PAD - y) / (HEIGHT - 2 * PAD) * top;
    return [Math.max(rounded(n, top), top / 200), rounded((x - WIDTH / 2) / (WIDTH / 2 - PAD) * reach, reach)];
  };
  svgElement("line", { x1: PAD, x2: WIDTH - PAD, y1: HEIGHT - PAD, y2: HEIGHT - PAD, class: "axis" }, svg);
  svgElement("line", { x1: WIDTH / 2, x2: WIDTH / 2, y1: PAD / 2, y2: HEIGHT - PAD, class: "axis" }, svg);
  const title = (control) => `${labelOf(control)} [${unit(dimensionOf(control), inputs).name}]`;
  svgElement("text", { x: WIDTH - PAD, y: HEIGHT - 8, "text-anchor": "end" }, svg).textContent = title(inputs.tangential);
  svgElement("text", { x: WIDTH / 2 + 6, y: PAD / 2 + 2 }, svg).textContent = title(inputs.normal);
  const line = svgElement("polyline", { class: "path" }, svg);
  const redraw = () => line.setAttribute("points", [[0, 0], ...points].map((p) => place(p).join(",")).join(" "));
  redraw();
  points.forEach((point, i) => {
    const [x, y] = place(point);
    const handle = svgElement("circle", {
      cx: x, cy: y, r: 8, tabindex: 0, role: "slider", "data-point": i, "aria-label": `Point ${i + 1}`,
      "aria-valuetext": valueText(point, inputs), "aria-valuenow": i + 1,
    }, svg);
    const same = points.flatMap((other, j) => (other.join() === point.join() ? [j + 1] : []));
    const label = svgElement("text", { x, y: y - 13, "text-anchor": "middle", class: "point" }, svg);
    label.textContent = same[0] === i + 1 ? same.join(", ") : "";
    const move = (next) => {
      points[i] = next;
      const [cx, cy] = place(next);
      handle.setAttribute("cx", cx);
      handle.setAttribute("cy", cy);
      redraw();
    };
    handle.addEventListener("pointerdown", (event) => {
      handle.setPointerCapture(event.pointerId);
      handle.focus();
    });
    handle.addEventListener("pointermove", (event) => {
      if (!handle.hasPointerCapture(event.pointerId)) return;
      const { x: px, y: py } = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
      move(inverse(px, py));
    });
    handle.addEventListener("pointerup", commit);
    handle.addEventListener("keydown", (event) => {
      const step = { ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [1, 0], ArrowDown: [-1, 0] }[event.key];
      if (!step) return;
      event.preventDefault();
      const [n, t] = points[i];
      move([Math.max(n + step[0] * top / 50, top / 50), t + step[1] * reach / 50].map((v) => Number(v.toPrecision(3))));
      commit();
    });
  });
  return svg;
}

function valueText([n, t], inputs) {
  const part = (value, control) => {
    const { name, factor } = unit(dimensionOf(control), inputs);
    return `${labelOf(control)} ${format(value / factor, 3)} ${name}`;
  };
  return `${part(n, inputs.normal)}, ${part(t, inputs.tangential)}`;
}

function table(points, inputs, commit) {
  const element = document.createElement("table");
  element.className = "points";
  const head = element.createTHead().insertRow();
  for (const title of ["Point", labelOf(inputs.normal), labelOf(inputs.tangential), "Change"]) {
    const cell = document.createElement("th");
    cell.scope = "col";
    cell.textContent = title;
    head.append(cell);
  }
  const body = element.createTBody();
  points.forEach((point, i) => {
    const row = body.insertRow();
    row.insertCell().textContent = i + 1;
    [inputs.normal, inputs.tangential].forEach((control, j) => {
      const input = document.createElement("input");
      input.value = shown(point[j], dimensionOf(control), inputs);
      input.inputMode = "decimal";
      input.dataset.point = `${i}-${j}`;
      input.setAttribute("aria-label", `Point ${i + 1}, ${labelOf(control)} [${unit(dimensionOf(control), inputs).name}]`);
      input.addEventListener("change", () => {
        const value = read(input.value, dimensionOf(control), inputs);
        input.setAttribute("aria-invalid", String(Number.isNaN(value)));
        if (Number.isNaN(value)) return;
        points[i][j] = value;
        commit();
      });
      row.insertCell().append(input);
    });
    const cell = row.insertCell();
    const button = (text, name, act) => {
      const each = Object.assign(document.createElement("button"), { type: "button", textContent: text });
      each.setAttribute("aria-label", name);
      each.addEventListener("click", () => {
        act();
        commit();
      });
      cell.append(each);
      return each;
    };
    button("+", `Add a point after point ${i + 1}`, () => points.splice(i + 1, 0, [...point]));
    button("−", `Remove point ${i + 1}`, () => points.splice(i, 1)).disabled = points.length === 1;
  });
  return element;
}
