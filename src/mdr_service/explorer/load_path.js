// Editor of a load path: points in the plane of tangential and normal load.

import { make, makeButton, makeTable } from "./dom.js";
import { pathPoints } from "./inputs.js";
import { QUANTITIES } from "./quantities.js";
import { format, noNumber, read, shown, unit, withUnit } from "./units.js";

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

/**
 * Show the editor of the load path in `container`.
 *
 * `change(path)` is called with a new path, `fail()` if a number in the table cannot be read.
 */
export function showEditor(container, inputs, size, { change, fail }) {
  const points = pathPoints(inputs);
  const focused = document.activeElement?.dataset?.point;
  const commit = (path = points) => change(path.map((point) => point.join(",")).join(";"));
  const [above, next] = [[heading(size, commit), drawing(points, inputs, commit)], table(points, inputs, commit, fail)];
  const shownTable = container.querySelector(".points");
  if (shownTable && textOf(shownTable) === textOf(next)) {
    // The key or the click that ends an entry acts on the elements that are there.
    above.forEach((element, i) => container.children[i].replaceWith(element));
    container.querySelector(".problem").textContent = "";
  } else {
    container.replaceChildren(...above, next, make("p", { className: "problem", role: "alert", id: "problem-path" }));
  }
  if (focused) container.querySelector(`[data-point="${focused}"]`)?.focus();
}

/** Return the labels and values of the numbers of a table. */
const textOf = (element) => [...element.querySelectorAll("input")].map((each) => each.ariaLabel + each.value).join();

function heading({ normal, tangential }, commit) {
  const rounded = (x) => Number(x.toPrecision(3));
  const start = ({ target }) =>
    commit(PRESETS[target.value].map(([n, t]) => [rounded(n * normal), rounded(t * tangential)]));
  const prompt = make("option", { hidden: true }, "…");
  const names = Object.keys(PRESETS).map((name) => new Option(name));
  return make("div", { className: "row" },
    make("h2", {}, "Load path"), make("label", { htmlFor: "preset" }, "Start from"),
    make("select", { id: "preset", onchange: start }, prompt, ...names));
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
  const title = (control) => withUnit(QUANTITIES[control], inputs);
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
    const [label, dimension] = QUANTITIES[control];
    const { name, factor } = unit(dimension, inputs);
    return `${label} ${format(value / factor, 3)} ${name}`;
  };
  return `${part(n, inputs.normal)}, ${part(t, inputs.tangential)}`;
}

function table(points, inputs, commit, fail) {
  const number = (i, j, control) => make("input", {
    value: shown(points[i][j], QUANTITIES[control][1], inputs),
    inputMode: "decimal",
    "data-point": `${i}-${j}`,
    "aria-label": `Point ${i + 1}, ${withUnit(QUANTITIES[control], inputs)}`,
    onchange: ({ target }) => {
      const value = read(target.value, QUANTITIES[control][1], inputs);
      if (Number.isNaN(value)) {
        target.setAttribute("aria-invalid", "true");
        target.closest(".field").querySelector(".problem").textContent = `Point ${i + 1}: ${noNumber(target.value)}`;
        fail();
        return;
      }
      points[i][j] = value;
      target.value = shown(value, QUANTITIES[control][1], inputs);
      target.removeAttribute("aria-invalid");
      commit();
    },
  });
  const button = (text, name, act) => makeButton(text, () => { act(); commit(); }, { "aria-label": name });
  const rows = points.map((point, i) => {
    const add = button("+", `Add a point after point ${i + 1}`, () => points.splice(i + 1, 0, [...point]));
    const remove = button("−", `Remove point ${i + 1}`, () => points.splice(i, 1));
    remove.disabled = points.length === 1;
    const change = make("span", {}, add, remove);
    return [i + 1, number(i, 0, inputs.normal), number(i, 1, inputs.tangential), change];
  });
  const titles = [inputs.normal, inputs.tangential].map((control) => QUANTITIES[control][0]);
  const element = makeTable(["Point", ...titles, "Change"], rows);
  element.className = "points";
  return element;
}
