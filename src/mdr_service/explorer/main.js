// The page: inputs -> form -> requests -> numbers and charts -> address.

import { draw, redraw } from "./charts.js";
import { makeButton } from "./dom.js";
import { choiceRow, numberRow, optionalRow } from "./form.js";
import { showEditor } from "./load_path.js";
import { MATERIALS, materialOf, weakest } from "./materials.js";
import { bodyFields, curveFields, leadOf, listedField, loadFields, ANALYSES, BASE, BODIES, MEASURED, THICKNESS } from "./analyses.js";
import { newestWins, query, Refusal } from "./requests.js";
import { controls, defaultInputs, exampleOf, fromAddress, hasLoop, pathPoints, RIGID, TABS, takesLayer, toAddress, withChoice, withKind } from "./inputs.js";
import { noteOnUnits, showAccuracy, showNumbers, showProblem } from "./outcome.js";
import { showReport } from "./report.js";
import { KINDS, OWN_FIELDS, OWN_FORMULAS } from "./shapes.js";
import { ownLoads } from "./own_loads.js";
import { showSketch } from "./sketch.js";
import { tableField } from "./table_field.js";
import { CURVE, PROFILE } from "./table_reader.js";
import { connectExport, showRequest, showRequests } from "./take_away.js";
import { BASE_UNITS } from "./units.js";

const $ = (selector) => document.querySelector(selector);
let inputs;
let catalogue = {};
// Error that is shown, or null.
let problem = null;
// The curve and the loop that were last shown.
const measurements = {};
let last = null;
let version = "";
// Fields for tables, by the key of their input, and the tables that were read last. They have
// segments and times, which an address does not hold.
const tables = {};
const held = {};
// Analysis whose results are shown.
let shownTab;
// Time after which a computation is reported [ms]: shorter ones would flicker.
const BUSY = 400;
// Section of the user's own loads.
let own;
// Keys of the fields that hold no value that can be read.
const unreadable = new Set();

/**
 * State of the page: `pending` while the case is computed, `current` if the results are those of
 * the form, `refused` if the service has none, `unreadable` if the form describes no case.
 */
function setState(state) {
  document.body.dataset.state = state;
  // The results of another analysis do not answer the question of this one.
  document.body.classList.toggle("stale", shownTab !== inputs.tab);
  $("#results").setAttribute("aria-busy", String(state === "pending"));
  clearTimeout(setState.timer);
  $("#busy").textContent = "";
  if (state === "pending") setState.timer = setTimeout(() => ($("#busy").textContent = "Computing …"), BUSY);
  const outdated = state === "refused" || state === "unreadable";
  for (const id of ["main-numbers", "numbers", "accuracy", "warnings", "charts", "own .row", "own .data", "take-away"]) $(`#${id}`).inert = outdated;
}

/** Show the case of the address. */
function showAddress() {
  const { inputs: next, unread } = fromAddress(location.search, location.hash);
  $("#unread").textContent = unread.length
    ? `Default values replace members of the link that the page cannot read: ${unread.join(", ")}.`
    : "";
  unreadable.clear();
  for (const [key, table] of Object.entries(held)) {
    if (["r", "f", "units"].every((part) => String(next[key][part]) === String(table[part]))) next[key] = table;
  }
  show(next);
}

/** Show other inputs in the whole page. */
function show(next) {
  inputs = next;
  // Fields are built again from the inputs; the text of a table stays.
  const kept = Object.keys(tables).filter((key) => unreadable.has(key) && isUsed(key));
  unreadable.clear();
  kept.forEach((key) => unreadable.add(key));
  const focused = document.activeElement?.id;
  showForm();
  showPath();
  if (focused) document.getElementById(focused)?.focus();
  refresh();
}

/** Return whether the case of the inputs depends on a table. */
function isUsed(key) {
  return key === "table" ? inputs.kind === "tabulated" : inputs.tab === "fit";
}

function change(key, value) {
  unreadable.delete(key);
  inputs = { ...inputs, [key]: value };
  // Material and values that follow from the one that has changed.
  const body = /^(?:e|nu)([12])$/.exec(key)?.[1];
  const material = body && $(`#field-material-${body}`);
  if (material) material.value = materialOf(inputs, body) ?? "Custom";
  for (const { key: other, optional, placeholder } of ANALYSES[inputs.tab].fields(inputs)) {
    if (optional) $(`#field-${other}`).placeholder = placeholder;
  }
  showBase();
  refresh();
}

/** Show the case with another measured curve or loop, all of whose points are fitted, in its units. */
function takeCurve(curve) {
  unreadable.delete("curve");
  const [ud, uf] = curve.units;
  show({ ...inputs, curve, rows: "", drift: "", from: "", to: "", ud, uf });
}

function fail(key) {
  unreadable.add(key);
  refresh();
}

function choose(key, value) {
  if (key === "measured") {
    measurements[inputs.measured] = inputs.curve;
    inputs = { ...inputs, measured: value };
    unreadable.delete("curve");
    return takeCurve(measurements[value] ?? exampleOf(value));
  }
  show(withChoice(inputs, key, value, last?.known ?? {}));
}

function row(field, reference) {
  const { key, label, choices, optional } = field;
  if (choices) return choiceRow(key, label, choices, inputs[key], (value) => choose(key, value));
  if (optional) return optionalRow(field, inputs, { change, fail });
  return numberRow(field, inputs, reference, { change, fail });
}

const rows = (fields, references = inputs) =>
  fields.map((field) => row(field, references[field.key] ?? inputs[field.key]));

function fill(container, elements) {
  container.querySelectorAll(":scope > :not(legend)").forEach((element) => element.remove());
  container.append(...elements);
  container.hidden = elements.length === 0;
}

function profileFields() {
  const fields = OWN_FIELDS[inputs.kind] ?? catalogue[inputs.kind]?.fields ?? [];
  return fields
    .filter(({ name }) => Object.hasOwn(KINDS[inputs.kind].fields, name))
    .map(({ name, description, ...field }) => ({
      key: name, label: description, ...field,
      range: name.startsWith("exponent") ? [0.5, 10] : undefined,
    }));
}

function materialRow(i) {
  const [modulus, ratio] = [`e${i}`, `nu${i}`];
  const known = { ...MATERIALS, Rigid: [RIGID, inputs[ratio]] };
  // The moduli of the material that was chosen would be that material again.
  const custom = [2e11, 0.3];
  const chosen = inputs[modulus] === RIGID ? "Rigid" : materialOf(inputs, i) ?? "Custom";
  const choices = ["Custom", ...Object.keys(known)].map((name) => [name, name]);
  return choiceRow(`material-${i}`, BODIES[i], choices, chosen, (name) => {
    const [e, nu] = known[name] ?? custom;
    // Strength and density are those of the material that is chosen.
    const next = { ...inputs, [modulus]: e, [ratio]: nu, [`yield${i}`]: "", ...(i === 1 ? { density: "" } : {}) };
    show({ ...next, body: weakest(next) });
  });
}

/** Show how the layer is held where there is one. */
function showBase() {
  $(".field[data-key=base]")?.toggleAttribute("hidden", inputs.thickness === "");
}

function showForm() {
  const analysis = ANALYSES[inputs.tab];
  $("#kind").value = inputs.kind;
  $("#formula").textContent = `f(r) = ${OWN_FORMULAS[inputs.kind] ?? catalogue[inputs.kind]?.formula ?? "…"}`;
  for (const [key, field] of Object.entries(tables)) {
    field.show(inputs[key], unreadable.has(key), key === "curve" ? [hasLoop(inputs) ? "u" : "d", "F"] : undefined);
  }
  $("#table-fields").hidden = !isUsed("table");
  $("#measured").hidden = !isUsed("curve");
  fill($("#profile-fields"), rows(profileFields(), KINDS[inputs.kind].fields));
  const isLoop = hasLoop(inputs);
  $("#curve-label").textContent = isLoop ? "Displacement u and friction F, in the order of time" : "Depth d and force F";
  $("[for=unit-depth]").textContent = `${isLoop ? "u" : "d"} in`;
  $("#curve-fields .reverse").hidden = isLoop;
  fill($("#measured-kind"), rows([MEASURED]));
  fill($("#curve-choice"), rows(curveFields(inputs)));
  $("#curve-choice").hidden = isLoop;
  // The fit determines the modulus of body 2.
  const bodies = inputs.tab === "fit" && !isLoop ? [1] : [1, 2];
  const layer = takesLayer(inputs) ? [THICKNESS, BASE] : [THICKNESS];
  fill($("#bodies"), [...bodies.flatMap((i) => [materialRow(i), ...rows(bodyFields(inputs, i))]), ...rows(layer)]);
  showBase();
  fill($("#loading"), rows(loadFields(inputs)));
  fill($("#analysis"), rows(analysis.fields(inputs)));
  fill($("#units"), rows(Object.values(BASE_UNITS).map(({ key, label, factors }) => ({
    key, label, choices: Object.keys(factors).map((name) => [name, name]),
  }))));
  document.querySelectorAll("[role=tab]").forEach((tab) => {
    const selected = tab.id === `tab-${inputs.tab}`;
    tab.setAttribute("aria-selected", String(selected));
    tab.tabIndex = selected ? 0 : -1;
    // On a narrow screen the tabs scroll.
    if (selected) tab.parentElement.scrollLeft = tab.offsetLeft - tab.parentElement.offsetLeft - 80;
  });
  $("#lead").textContent = leadOf(inputs);
}

// Results ----------------------------------------------------------------------------------------

/** Return the labels of the fields of the profile, by their names in requests. */
function labels() {
  return Object.fromEntries(profileFields().map(({ key, label }) => [key, label]));
}

/** Show an error, or none. */
function tell(error) {
  problem = error;
  showProblem(error, inputs, labels());
}

/** Fit the depths of a range. */
function select(range) {
  const [from, to] = range.map((depth) => Number(depth.toPrecision(4)));
  show({ ...inputs, from, to });
}

function showPath() {
  const editor = $("#editor");
  editor.hidden = inputs.tab !== "cycle";
  if (editor.hidden) return;
  const points = pathPoints(inputs);
  const normal = Math.max(...points.map(([n]) => n));
  const force = inputs.tangential === "tangential_force";
  const tangential = force && inputs.normal === "normal_force" ? inputs.mu * normal : Math.max(...points.map(([, t]) => Math.abs(t))) || 1e-7;
  const actions = { change: (path) => show({ ...inputs, path }), fail: () => fail("path") };
  showEditor(editor, inputs, { normal, tangential }, actions);
}

const sketch = () => showSketch($("#sketch"), inputs, last?.known?.contact_radius);

// Responses to the queries of the results shown; unchanged queries reuse them.
let responses = new Map();

const solve = newestWins(async () => {
  const current = inputs;
  const recorded = [];
  const sent = new Map();
  const recording = (name, path, body) => {
    recorded.push({ name, path, body });
    const key = JSON.stringify([path, body]);
    sent.set(key, sent.get(key) ?? responses.get(key) ?? query(path, body));
    return sent.get(key);
  };
  const isShown = () => inputs === current && unreadable.size === 0;
  try {
    const result = await ANALYSES[current.tab].solve(current, recording);
    if (current.tab !== inputs.tab) return;
    last = result;
    responses = sent;
    shownTab = current.tab;
    document.body.classList.remove("stale");
    if (isShown()) tell(null);
    showNumbers(result.numbers, current);
    showAccuracy(result, noteOnUnits(current, result.known.contact_radius), current, labels());
    sketch();
    showRequests(recorded);
    await draw($("#charts"), result.charts, current, { showRequest, select });
    document.body.dataset.drawn = toAddress(current);
    if (isShown()) setState("current");
  } catch (error) {
    if (!(error instanceof Refusal)) reportError(error);
    if (!isShown()) return;
    tell(error);
    setState("refused");
  }
});

/** Lay out the page as a report of inputs and results, or as a screen again. */
function showForPrint(printing) {
  document.documentElement.classList.toggle("printing", printing);
  showReport(inputs, ANALYSES[inputs.tab], version);
  if (printing) redraw();
}

function refresh() {
  clearTimeout(refresh.timer);
  sketch();
  own.show(inputs, listedField(inputs));
  // Mail programs break longer links.
  const length = toAddress(inputs).length;
  $("#link-length").textContent = length > 2000 ? ` It is ${Math.ceil(length / 1000)} kB long with the points of the table: send a file of these instead.` : "";
  if (unreadable.size) return setState("unreadable");
  // Browsers limit how often the address may change.
  refresh.timer = setTimeout(() => history.replaceState(null, "", toAddress(inputs)), 250);
  setState("pending");
  solve();
}

// Start ------------------------------------------------------------------------------------------

function showTab(tab) {
  // The address of the tab that is left is complete before the next step of the history.
  if (unreadable.size === 0) history.replaceState(null, "", toAddress(inputs));
  inputs = { ...inputs, tab };
  if (!controls(tab).includes(inputs.control)) {
    inputs = { ...inputs, control: "normal_force", load: last?.known?.normal_force ?? 100 };
  }
  history.pushState(null, "", toAddress(inputs));
  show(inputs);
}

function makeTabs() {
  const list = $("[role=tablist]");
  for (const tab of TABS) {
    const attributes = { id: `tab-${tab}`, role: "tab", "aria-controls": "results" };
    list.append(makeButton(ANALYSES[tab].title, () => showTab(tab), attributes));
  }
  list.addEventListener("keydown", (event) => {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    const next = TABS[(TABS.indexOf(inputs.tab) + step + TABS.length) % TABS.length];
    showTab(next);
    $(`#tab-${next}`).focus();
  });
}

function connect() {
  for (const [kind, { label }] of Object.entries(KINDS)) $("#kind").add(new Option(label, kind));
  $("#kind").addEventListener("change", () => show(withKind(inputs, $("#kind").value)));
  for (const [key, kind] of [["table", PROFILE], ["curve", CURVE]]) {
    const take = (table) => {
      held[key] = table;
      if (key === "curve") takeCurve(table);
      else change(key, table);
    };
    tables[key] = tableField($(`#${key}-fields`), kind, { change: take, fail: () => fail(key) });
  }
  own = ownLoads($("#own"), {
    state: () => ({ inputs, field: listedField(inputs), result: last, title: ANALYSES[inputs.tab].title }),
    solve: (next) => ANALYSES[next.tab].solve(next, (name, path, body) => query(path, body)),
    change: (loads) => change("loads", loads),
    fail: () => fail("loads"),
  });
  $("#reset").addEventListener("click", () => show({ ...defaultInputs(), tab: inputs.tab }));
  connectExport(() => inputs);
  $("#print").addEventListener("click", async () => {
    // Without a table the case has changed meanwhile.
    if (!inputs.loads || (await own.computed())) print();
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", solve);
  addEventListener("beforeprint", () => showForPrint(true));
  addEventListener("afterprint", () => showForPrint(false));
  addEventListener("afterprint", solve);
  addEventListener("popstate", showAddress);
}

makeTabs();
connect();
showAddress();
fetch("v1/profiles").then((response) => response.json()).then(({ profiles }) => {
  catalogue = Object.fromEntries(profiles.map((profile) => [profile.kind, profile]));
  if (unreadable.size === 0) showForm();
  tell(problem);
});
fetch("health").then((response) => response.json()).then((health) => ({ version } = health));
