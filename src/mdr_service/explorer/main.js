// The page: scene -> form -> requests -> numbers and charts -> address.

import { draw } from "./charts.js";
import { readTable, row, tableText } from "./form.js";
import { showEditor } from "./load_path.js";
import { loadFields, QUESTIONS } from "./questions.js";
import { ask, askCsv, download, newestWins, Refusal, source } from "./requests.js";
import { defaultScene, fromAddress, TABS, toAddress, withKind } from "./scene.js";
import { DEFAULT_FIELDS, LABELS, outline, OWN_FIELDS, OWN_FORMULAS, wireProfile } from "./shapes.js";
import { BASE_UNITS, format, unit } from "./units.js";

// Typical values for a first estimate; a real material may differ by several per cent.
const MATERIALS = {
  "Steel": [2.1e11, 0.3],
  "Stainless steel": [1.93e11, 0.29],
  "Aluminium alloy": [7e10, 0.33],
  "Titanium Ti-6Al-4V": [1.14e11, 0.34],
  "Brass": [1.05e11, 0.34],
  "Tungsten carbide": [6.3e11, 0.22],
  "Alumina": [3.8e11, 0.23],
  "Silicon nitride": [3.1e11, 0.27],
  "Soda-lime glass": [7e10, 0.23],
  "Fused silica": [7.3e10, 0.17],
  "PMMA": [3e9, 0.38],
  "Natural rubber": [2e6, 0.49],
};

const $ = (selector) => document.querySelector(selector);
let scene = fromAddress(location.search, location.hash);
let kinds = {};
let requests = [];
let last = null;
let rowOfTable = [];

// Form -------------------------------------------------------------------------------------------

function change(key, value) {
  const structural = ["control", "push", "oscillation", "normal", "tangential"].includes(key);
  const before = scene[key];
  scene = { ...scene, [key]: value };
  if (structural && before !== value) {
    keepLoad(key, value);
    showForm();
  }
  refresh();
}

/** Keep the state of the contact when another quantity is chosen to give it. */
function keepLoad(key, value) {
  const known = last?.known ?? {};
  if (key === "control" && known[value] > 0) scene.load = known[value];
  if (key === "push") {
    const share = known.tangential_force / (scene.mu * known.normal_force);
    scene.amount = value === "ratio" ? Math.min(share || 0.7, 1) : known[value] || scene.load / 10;
  }
  if (key === "oscillation") {
    scene.amplitude = value === "tangential_force" ? defaultScene().amplitude : 2e-7;
  }
  if (key === "normal") scene.path = rescaled(0, value === "normal_force" ? 100 : 2e-6);
  if (key === "tangential") scene.path = rescaled(1, value === "tangential_force" ? 20 : 4e-7);
}

function rescaled(column, largest) {
  const points = scene.path.split(";").map((point) => point.split(",").map(Number));
  const size = Math.max(...points.map((point) => Math.abs(point[column]))) || 1;
  for (const point of points) point[column] = Number(((point[column] / size) * largest).toPrecision(6));
  return points.map((point) => point.join(",")).join(";");
}

function fill(container, fields, references = scene) {
  container.querySelectorAll(":scope > :not(legend)").forEach((element) => element.remove());
  container.append(...fields.map((field) => row(field, scene, references[field.key] ?? scene[field.key], change)));
  container.hidden = fields.length === 0;
}

function profileFields() {
  const known = kinds[scene.kind];
  const fields = OWN_FIELDS[scene.kind] ?? known?.fields ?? [];
  return fields
    .filter(({ name }) => name in DEFAULT_FIELDS[scene.kind] && name !== "interpolation")
    .map(({ name, dimension, description }) => ({
      key: name, label: description, dimension,
      range: name.startsWith("exponent") ? [0.5, 10] : undefined,
    }));
}

function bodyFields() {
  const modulus = (i) => ({ key: `e${i}`, label: `Young’s modulus ${i}`, dimension: "modulus" });
  const ratio = (i) => ({ key: `nu${i}`, label: `Poisson’s ratio ${i}`, dimension: "1", range: [0, 0.5] });
  return scene.e2 === "rigid" ? [modulus(1), ratio(1)] : [modulus(1), ratio(1), modulus(2), ratio(2)];
}

function materialSelect(i) {
  const label = document.createElement("label");
  label.className = "row";
  label.innerHTML = `<span>Body ${i}</span><select id="material-${i}"></select>`;
  const select = label.querySelector("select");
  const current = Object.entries(MATERIALS).find(([, [e, nu]]) => e === scene[`e${i}`] && nu === scene[`nu${i}`]);
  const chosen = scene[`e${i}`] === "rigid" ? "Rigid" : current?.[0] ?? "Own values";
  const offered = ["Own values", ...Object.keys(MATERIALS), ...(i === 2 ? ["Rigid"] : [])];
  for (const name of offered) select.add(new Option(name, name, false, name === chosen));
  select.addEventListener("change", () => {
    if (select.value === "Rigid") scene = { ...scene, e2: "rigid" };
    else {
      const fallback = scene[`e${i}`] === "rigid" ? MATERIALS.Steel : [scene[`e${i}`], scene[`nu${i}`]];
      const [e, nu] = MATERIALS[select.value] ?? fallback;
      scene = { ...scene, [`e${i}`]: e, [`nu${i}`]: nu };
    }
    showForm();
    refresh();
  });
  return label;
}

function showForm() {
  const question = QUESTIONS[scene.tab];
  $("#kind").value = scene.kind;
  $("#formula").textContent = `f(r) = ${OWN_FORMULAS[scene.kind] ?? kinds[scene.kind]?.formula ?? "…"}`;
  const tabulated = scene.kind === "tabulated";
  $("#table-fields").hidden = !tabulated;
  if (tabulated && document.activeElement !== $("#table")) {
    $("#table").value = tableText(scene.table);
    rowOfTable = scene.table.r.map((_, i) => i + 1);
  }
  fill($("#profile-fields"), profileFields(), DEFAULT_FIELDS[scene.kind]);
  $("#profile-fields").hidden = false;
  fill($("#bodies"), bodyFields());
  $("#bodies legend").after(materialSelect(1), materialSelect(2));
  fill($("#loading"), loadFields(scene));
  fill($("#question"), question.fields(scene));
  fill($("#units"), Object.values(BASE_UNITS).map(({ key, label, units }) => ({
    key, label, choices: units.map((name) => ({ value: name, label: name })),
  })));
  for (const { key } of Object.values(BASE_UNITS)) {
    $(`#field-${key}`).addEventListener("change", showForm);
  }
  document.querySelectorAll("[role=tab]").forEach((tab) => {
    const selected = tab.id === `tab-${scene.tab}`;
    tab.setAttribute("aria-selected", String(selected));
    tab.tabIndex = selected ? 0 : -1;
  });
  $("#lead").textContent = question.lead;
}

function showSketch() {
  const [width, height] = [280, 120];
  const svg = $("#sketch");
  const profile = wireProfile(scene);
  const contact = last?.known?.contact_radius;
  const reach = (contact ?? scene.radius ?? 1e-4) * 2;
  const points = outline(profile, reach);
  const wall = profile.kind === "flat_punch";
  const [end, top] = [points.at(-1)[0], Math.max(...points.map(([, f]) => f)) || 1];
  const scale = [(width / 2 - 8) / (wall ? end * 2 : end), (height - 44) / top];
  const at = ([r, f], side) => `${width / 2 + side * r * scale[0]},${height - 24 - f * scale[1]}`;
  const right = points.map((point) => at(point, 1));
  const left = points.map((point) => at(point, -1)).reverse();
  const corner = (side) => `${width / 2 + side * end * scale[0]},8`;
  const touch = Math.min(contact ?? 0, end) * scale[0];
  svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
  svg.innerHTML =
    `<rect class="base" x="0" y="${height - 24}" width="${width}" height="24"/>` +
    `<polygon class="body" points="${corner(-1)} ${left.join(" ")} ${right.join(" ")} ${corner(1)}"/>` +
    `<line class="touch" x1="${width / 2 - touch}" x2="${width / 2 + touch}" y1="${height - 24}" y2="${height - 24}"/>`;
}

// Results ----------------------------------------------------------------------------------------

function showNumbers(numbers) {
  $("#numbers").replaceChildren(...numbers.map(([label, value, dimension]) => {
    const entry = document.createElement("div");
    const shown = dimension ? unit(dimension, scene) : { name: "", factor: 1 };
    const text = typeof value === "number" || value === null
      ? `${format(value === null ? null : value / shown.factor)} ${shown.name}` : value;
    entry.innerHTML = "<dt></dt><dd></dd>";
    entry.querySelector("dt").textContent = label;
    entry.querySelector("dd").textContent = text;
    return entry;
  }));
}

function showAccuracy(answers) {
  const error = Math.max(...answers.map((answer) => answer.error_estimate));
  const methods = [...new Set(answers.map((answer) => answer.method.replace("_", " ")))];
  $("#accuracy").textContent =
    `Computed by ${methods.join(" and ")}; relative error of every number at most ${format(error, 2)}.`;
  const messages = new Map(answers.flatMap((answer) => answer.warnings.map((w) => [w.code, w.message])));
  $("#warnings").replaceChildren(...[...messages].map(([code, message]) => {
    const item = document.createElement("li");
    item.innerHTML = "<strong></strong> ";
    item.querySelector("strong").textContent = code.replaceAll("_", " ");
    item.append(message);
    return item;
  }));
}

// Member of a request -> keys of the scene that set it.
const SOURCES = {
  "/friction_coefficient": "mu", "/load": "load", "/tangential": "amount", "/oscillation": "amplitude",
  "/wear_coefficient": "wear", "/cycles": "cycles", "/material/yield_strength": "yield", "/body": "body",
  "/material/bodies/0/youngs_modulus": "e1", "/material/bodies/0/poissons_ratio": "nu1",
  "/material/bodies/1/youngs_modulus": "e2", "/material/bodies/1/poissons_ratio": "nu2",
};

function showProblem(error) {
  const box = $("#problem");
  document.querySelectorAll(".field .problem, #table-problem").forEach((each) => (each.textContent = ""));
  document.querySelectorAll("[aria-invalid=true]").forEach((each) => each.setAttribute("aria-invalid", "false"));
  $("#results").classList.toggle("stale", Boolean(error));
  box.hidden = !error;
  if (!error) return;
  const { title = "The service cannot be reached", errors = [] } = error instanceof Refusal ? error.problem : {};
  box.textContent = error instanceof Refusal ? `${title}: ${error.message}` : title;
  for (const { pointer, detail } of errors) {
    const point = pointer.match(/^\/profile\/[rf](?:\/(\d+))?$/);
    if (scene.kind === "tabulated" && point) {
      const line = point[1] === undefined ? "" : `Line ${rowOfTable[Number(point[1])] ?? Number(point[1]) + 1}: `;
      $("#table-problem").textContent = line + detail;
      continue;
    }
    const member = Object.keys(SOURCES).find((prefix) => pointer.startsWith(prefix));
    const key = member ? SOURCES[member] : pointer.split("/").pop();
    const field = document.querySelector(`.field[data-key="${key}"]`);
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

const chosenRequest = () => requests.find(({ name }) => name === $("#request").value);

function showSource() {
  const request = chosenRequest();
  $("#code").textContent = request ? source($("#language").value, request) : "";
}

function showPath() {
  const editor = $("#editor");
  editor.hidden = scene.tab !== "cycle";
  if (editor.hidden) return;
  const columns = scene.path.split(";").map((point) => point.split(",").map(Number));
  const normal = Math.max(...columns.map(([n]) => n));
  const force = scene.tangential === "tangential_force";
  const tangential = force && scene.normal === "normal_force" ? scene.mu * normal : Math.max(...columns.map(([, t]) => Math.abs(t))) || 1e-7;
  showEditor(editor, scene, { normal, tangential }, (path) => {
    scene = { ...scene, path };
    showPath();
    refresh();
  });
}

const solve = newestWins(async (outdated) => {
  const asked = scene;
  const recorded = [];
  const recording = (name, path, body) => {
    recorded.push({ name, path, body });
    return ask(path, body);
  };
  try {
    const result = await QUESTIONS[asked.tab].solve(asked, recording);
    requests = recorded;
    last = result;
    showProblem(null);
    showNumbers(result.numbers);
    showAccuracy(result.answers);
    showSketch();
    showRequests();
    await draw($("#charts"), result.charts, asked);
    document.body.dataset.drawn = toAddress(asked);
  } catch (error) {
    if (!outdated()) showProblem(error);
    if (!(error instanceof Refusal) && !(error instanceof TypeError)) throw error;
  }
});

const showAddress = () => history.replaceState(null, "", toAddress(scene));

function refresh() {
  clearTimeout(refresh.timer);
  // Browsers limit how often the address may change.
  refresh.timer = setTimeout(showAddress, 250);
  if (scene.kind !== "tabulated" || scene.table.r.length) showSketch();
  solve();
}

// Start ------------------------------------------------------------------------------------------

function showTab(tab) {
  scene = { ...scene, tab };
  if (tab === "wear" && scene.control === "contact_radius") {
    scene = { ...scene, control: "normal_force", load: last?.known?.normal_force ?? 100 };
  }
  last = { ...last, numbers: [] };
  showForm();
  showPath();
  refresh();
}

function makeTabs() {
  const list = $("[role=tablist]");
  for (const tab of TABS) {
    const button = Object.assign(document.createElement("button"), {
      type: "button", id: `tab-${tab}`, textContent: QUESTIONS[tab].title,
    });
    button.setAttribute("role", "tab");
    button.setAttribute("aria-controls", "results");
    button.addEventListener("click", () => showTab(tab));
    list.append(button);
  }
  list.addEventListener("keydown", (event) => {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    const next = TABS[(TABS.indexOf(scene.tab) + step + TABS.length) % TABS.length];
    showTab(next);
    $(`#tab-${next}`).focus();
  });
}

function readTableField() {
  try {
    const { table, rowOf } = readTable($("#table").value);
    rowOfTable = rowOf;
    scene = { ...scene, table };
    refresh();
  } catch (error) {
    $("#table-problem").textContent = error.message;
  }
}

function connect() {
  for (const [kind, label] of Object.entries(LABELS)) $("#kind").add(new Option(label, kind));
  $("#kind").addEventListener("change", () => {
    scene = withKind(scene, $("#kind").value);
    showForm();
    refresh();
  });
  $("#table").addEventListener("input", readTableField);
  $("#file").addEventListener("change", async () => {
    $("#table").value = await $("#file").files[0].text();
    readTableField();
  });
  $("#reset").addEventListener("click", () => {
    scene = { ...defaultScene(), tab: scene.tab };
    showForm();
    showPath();
    refresh();
  });
  $("#request").addEventListener("change", showSource);
  $("#language").addEventListener("change", showSource);
  $("#copy").addEventListener("click", () => navigator.clipboard.writeText($("#code").textContent));
  $("#csv").addEventListener("click", async () => {
    const { name, path, body } = chosenRequest();
    download(`${name.toLowerCase().replaceAll(" ", "-")}.csv`, await askCsv(path, body), "text/csv");
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", solve);
  addEventListener("popstate", () => {
    scene = fromAddress(location.search, location.hash);
    showForm();
    showPath();
    solve();
  });
}

makeTabs();
connect();
showForm();
showPath();
showAddress();
solve();
fetch("v1/profiles").then((answer) => answer.json()).then(({ profiles }) => {
  kinds = Object.fromEntries(profiles.map((profile) => [profile.kind, profile]));
  showForm();
});
