// The page: inputs -> form -> requests -> numbers and charts -> address.

import { draw, redraw } from "./charts.js";
import { make, makeButton } from "./dom.js";
import { choiceRow, numberRow, readTable, tableText } from "./form.js";
import { showEditor } from "./load_path.js";
import { MATERIALS } from "./materials.js";
import { bodyFields, loadFields, ANALYSES } from "./analyses.js";
import { download, fileName, newestWins, query, queryCsv, Refusal, source } from "./requests.js";
import { defaultInputs, fromAddress, pathPoints, TABS, toAddress, withKind } from "./inputs.js";
import { KINDS, OWN_FIELDS, OWN_FORMULAS } from "./shapes.js";
import { showSketch } from "./sketch.js";
import { BASE_UNITS, format, unit } from "./units.js";

const $ = (selector) => document.querySelector(selector);
let inputs;
let catalogue = {};
let requests = [];
let last = null;
let rowOfTable = [];

/** Show the case of the address. */
function showAddress() {
  const { inputs: next, unread } = fromAddress(location.search, location.hash);
  $("#unread").textContent = unread.length
    ? `Default values replace members of the link that the page cannot read: ${unread.join(", ")}.`
    : "";
  show(next);
}

/** Show other inputs in the whole page. */
function show(next) {
  inputs = next;
  const focused = document.activeElement?.id;
  showForm();
  showPath();
  if (focused) document.getElementById(focused)?.focus();
  refresh();
}

function change(key, value) {
  inputs = { ...inputs, [key]: value };
  refresh();
}

function choose(key, value) {
  inputs = { ...inputs, [key]: value };
  keepLoad(key, value);
  show(inputs);
}

/** Keep the state of the contact when another quantity is chosen to give it. */
function keepLoad(key, value) {
  const known = last?.known ?? {};
  if (key === "control" && known[value] > 0) inputs.load = known[value];
  if (key === "push") {
    const share = known.tangential_force / (inputs.mu * known.normal_force);
    inputs.amount = value === "ratio" ? Math.min(share || 0.7, 1) : known[value] || inputs.load / 10;
  }
  if (key === "oscillation") {
    inputs.amplitude = value === "tangential_force" ? defaultInputs().amplitude : 2e-7;
  }
  if (key === "normal") {
    inputs.path = rescaled(0, Math.max(known[value], 0) || (value === "normal_force" ? 100 : 2e-6));
  }
  if (key === "tangential") {
    inputs.path = rescaled(1, Math.abs(known[value]) || (value === "tangential_force" ? 20 : 4e-7));
  }
}

function rescaled(column, largest) {
  const points = pathPoints(inputs);
  const size = Math.max(...points.map((point) => Math.abs(point[column]))) || 1;
  for (const point of points) point[column] = Number(((point[column] / size) * largest).toPrecision(6));
  return points.map((point) => point.join(",")).join(";");
}

function row(field, reference) {
  const { key, label, choices } = field;
  if (!choices) return numberRow(field, inputs, reference, change);
  return choiceRow(`field-${key}`, label, choices, inputs[key], (value) => choose(key, value));
}

function fill(container, fields, references = inputs) {
  container.querySelectorAll(":scope > :not(legend)").forEach((element) => element.remove());
  container.append(...fields.map((field) => row(field, references[field.key] ?? inputs[field.key])));
  container.hidden = fields.length === 0;
}

function profileFields() {
  const fields = OWN_FIELDS[inputs.kind] ?? catalogue[inputs.kind]?.fields ?? [];
  return fields
    .filter(({ name }) => Object.hasOwn(KINDS[inputs.kind].fields, name))
    .map(({ name, dimension, description }) => ({
      key: name, label: description, dimension,
      range: name.startsWith("exponent") ? [0.5, 10] : undefined,
    }));
}

function materialRow(i) {
  const [modulus, ratio] = [`e${i}`, `nu${i}`];
  const current = [inputs[modulus], inputs[ratio]];
  const known = { ...MATERIALS, ...(i === 2 && { Rigid: ["rigid", inputs[ratio]] }) };
  const custom = current[0] === "rigid" ? MATERIALS.Steel : current;
  const chosen = Object.keys(known).find((name) => String(known[name]) === String(current)) ?? "Custom";
  const choices = ["Custom", ...Object.keys(known)].map((name) => [name, name]);
  return choiceRow(`material-${i}`, `Body ${i}`, choices, chosen, (name) => {
    const [e, nu] = known[name] ?? custom;
    show({ ...inputs, [modulus]: e, [ratio]: nu });
  });
}

function showForm() {
  const analysis = ANALYSES[inputs.tab];
  $("#kind").value = inputs.kind;
  $("#formula").textContent = `f(r) = ${OWN_FORMULAS[inputs.kind] ?? catalogue[inputs.kind]?.formula ?? "…"}`;
  const tabulated = inputs.kind === "tabulated";
  $("#table-fields").hidden = !tabulated;
  if (tabulated && document.activeElement !== $("#table")) {
    $("#table").value = tableText(inputs.table);
    rowOfTable = inputs.table.r.map((_, i) => i + 1);
  }
  fill($("#profile-fields"), profileFields(), KINDS[inputs.kind].fields);
  fill($("#bodies"), bodyFields(inputs));
  $("#bodies legend").after(materialRow(1), materialRow(2));
  fill($("#loading"), loadFields(inputs));
  fill($("#analysis"), analysis.fields(inputs));
  fill($("#units"), Object.values(BASE_UNITS).map(({ key, label, factors }) => ({
    key, label, choices: Object.keys(factors).map((name) => [name, name]),
  })));
  document.querySelectorAll("[role=tab]").forEach((tab) => {
    const selected = tab.id === `tab-${inputs.tab}`;
    tab.setAttribute("aria-selected", String(selected));
    tab.tabIndex = selected ? 0 : -1;
  });
  $("#lead").textContent = analysis.lead;
}

// Results ----------------------------------------------------------------------------------------

function showNumbers(numbers) {
  $("#numbers").replaceChildren(...numbers.map(([label, value, dimension]) => {
    const shown = dimension ? unit(dimension, inputs) : { name: "", factor: 1 };
    const text = typeof value === "string" ? value : `${format(value && value / shown.factor)} ${shown.name}`;
    return make("div", {}, make("dt", {}, label), make("dd", {}, text));
  }));
}

function showAccuracy(responses) {
  const error = Math.max(...responses.map((response) => response.error_estimate));
  const methods = [...new Set(responses.map((response) => response.method.replace("_", " ")))];
  const fields = Math.max(...responses.map((response) => response.field_error_estimate ?? 0));
  const ofFields = fields ? `, of fields ${format(fields, 2)} of their largest value` : "";
  $("#accuracy").textContent =
    `Computed by ${methods.join(" and ")}; relative error at most ${format(error, 2)}${ofFields}.`;
  const messages = new Map(responses.flatMap((response) => response.warnings.map((w) => [w.code, w.message])));
  $("#warnings").replaceChildren(...[...messages].map(([code, message]) =>
    make("li", {}, make("strong", {}, code.replaceAll("_", " ")), ` ${message}`)));
}

// Member of a request -> keys of the inputs that set it.
const SOURCES = {
  "/friction_coefficient": "mu", "/load": "load", "/tangential": "amount", "/oscillation": "amplitude",
  "/wear_coefficient": "wear", "/cycles": "cycles", "/material/yield_strength": "yield", "/body": "body",
  "/material/bodies/0/youngs_modulus": "e1", "/material/bodies/0/poissons_ratio": "nu1",
  "/material/bodies/1/youngs_modulus": "e2", "/material/bodies/1/poissons_ratio": "nu2",
};

/** Return the key of the input that sets the member of a request at a pointer. */
function keyOf(pointer) {
  const member = Object.keys(SOURCES).find((prefix) => pointer.startsWith(prefix));
  if (member) return SOURCES[member];
  const [, , name, index, part] = pointer.split("/");
  if (inputs.kind === "balls" && name === "radius") return inputs.radius_1 > 0 ? "radius_2" : "radius_1";
  return name === "terms" ? `${part}_${Number(index) + 1}` : pointer.split("/").pop();
}

function showProblem(error) {
  const box = $("#problem");
  document.querySelectorAll(".field .problem, #table-problem").forEach((each) => (each.textContent = ""));
  document.querySelectorAll("[aria-invalid=true]").forEach((each) => each.setAttribute("aria-invalid", "false"));
  box.hidden = !error;
  if (!error) return;
  const { title = "The page has an error", errors = [] } = error.problem ?? {};
  box.textContent = title === error.message ? title : `${title}: ${error.message}`;
  for (const { pointer, detail } of errors) {
    const point = pointer.match(/^\/profile\/[rf](?:\/(\d+))?$/);
    if (inputs.kind === "tabulated" && point) {
      const line = point[1] === undefined ? "" : `Line ${rowOfTable[Number(point[1])] ?? Number(point[1]) + 1}: `;
      $("#table-problem").textContent = line + detail;
      continue;
    }
    const field = document.querySelector(`.field[data-key="${keyOf(pointer)}"]`);
    if (!field) continue;
    field.querySelector(".problem").textContent = detail;
    field.querySelector("input").setAttribute("aria-invalid", "true");
  }
}

function showRequests() {
  const select = $("#request");
  const chosen = select.value;
  select.replaceChildren(...requests.map(({ name, path }) => new Option(`${name}: POST /${path}`, name)));
  if (requests.some(({ name }) => name === chosen)) select.value = chosen;
  showSource();
}

function showSource() {
  const request = requests.find(({ name }) => name === $("#request").value);
  $("#code").textContent = request ? source($("#language").value, request) : "";
}

function showRequest(name) {
  $("#request").value = name;
  showSource();
  $("#code").focus();
}

async function saveCsv(name) {
  const { path, body } = requests.find((request) => request.name === name);
  download(`${fileName(name)}.csv`, await queryCsv(path, body), "text/csv");
}

function showPath() {
  const editor = $("#editor");
  editor.hidden = inputs.tab !== "cycle";
  if (editor.hidden) return;
  const points = pathPoints(inputs);
  const normal = Math.max(...points.map(([n]) => n));
  const force = inputs.tangential === "tangential_force";
  const tangential = force && inputs.normal === "normal_force" ? inputs.mu * normal : Math.max(...points.map(([, t]) => Math.abs(t))) || 1e-7;
  showEditor(editor, inputs, { normal, tangential }, (path) => show({ ...inputs, path }));
}

const sketch = () => showSketch($("#sketch"), inputs, last?.known?.contact_radius);

const solve = newestWins(async () => {
  const current = inputs;
  const recorded = [];
  const recording = (name, path, body) => {
    recorded.push({ name, path, body });
    return query(path, body);
  };
  try {
    const result = await ANALYSES[current.tab].solve(current, recording);
    requests = recorded;
    last = result;
    showProblem(null);
    showNumbers(result.numbers);
    showAccuracy(result.responses);
    sketch();
    showRequests();
    await draw($("#charts"), result.charts, current, { showRequest, saveCsv });
    document.body.dataset.drawn = toAddress(current);
    if (inputs === current) $("#results").dataset.state = "current";
  } catch (error) {
    if (!(error instanceof Refusal)) reportError(error);
    if (inputs !== current) return;
    showProblem(error);
    $("#results").dataset.state = "refused";
  }
});

/** Lay out the page as a sheet of paper that states the inputs in words, or as a screen again. */
function showForPrint(printing) {
  document.documentElement.classList.toggle("printing", printing);
  const rows = document.querySelectorAll("#inputs fieldset:not(#units, [hidden]) .row:not(.field .file)");
  $("#given").textContent = [...rows].map((row) => {
    const [control, words] = [row.querySelector("input, select"), [...row.querySelectorAll("span")]];
    const value = control.selectedOptions?.[0].text ?? control.value;
    return `${words[0].textContent}: ${value} ${words[1]?.textContent ?? ""}`.trim();
  }).join("; ");
  if (printing) redraw();
}

function refresh() {
  clearTimeout(refresh.timer);
  // Browsers limit how often the address may change.
  refresh.timer = setTimeout(() => history.replaceState(null, "", toAddress(inputs)), 250);
  sketch();
  $("#results").dataset.state = "pending";
  solve();
}

// Start ------------------------------------------------------------------------------------------

function showTab(tab) {
  inputs = { ...inputs, tab };
  if (tab === "wear" && inputs.control === "contact_radius") {
    inputs = { ...inputs, control: "normal_force", load: last?.known?.normal_force ?? 100 };
  }
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

function readTableField() {
  try {
    const { table, rowOf } = readTable($("#table").value);
    rowOfTable = rowOf;
    inputs = { ...inputs, table };
    refresh();
  } catch (error) {
    $("#table-problem").textContent = error.message;
  }
}

function connect() {
  for (const [kind, { label }] of Object.entries(KINDS)) $("#kind").add(new Option(label, kind));
  $("#kind").addEventListener("change", () => show(withKind(inputs, $("#kind").value)));
  $("#table").addEventListener("input", readTableField);
  $("#file").addEventListener("change", async () => {
    $("#table").value = await $("#file").files[0].text();
    readTableField();
  });
  $("#reset").addEventListener("click", () => show({ ...defaultInputs(), tab: inputs.tab }));
  $("#request").addEventListener("change", showSource);
  $("#language").addEventListener("change", showSource);
  $("#copy").addEventListener("click", () => navigator.clipboard.writeText($("#code").textContent));
  $("#csv").addEventListener("click", () => saveCsv($("#request").value));
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
  showForm();
});
