// The requests behind the charts, for other tools.

import { copied, download, fileName, inShownUnits, queryCsv, source } from "./requests.js";

const $ = (selector) => document.querySelector(selector);
let requests = [];

/** Offer the requests `{name, path, body}` of a result. */
export function showRequests(made) {
  requests = made;
  const select = $("#request");
  const chosen = select.value;
  select.replaceChildren(...requests.map(({ name, path }) => new Option(`${name}: POST /${path}`, name)));
  if (requests.some(({ name }) => name === chosen)) select.value = chosen;
  showSource();
}

function showSource() {
  const request = requests.find(({ name }) => name === $("#request").value);
  $("#code").textContent = request ? source($("#language").value, request) : "";
  $("#copied").textContent = "";
}

/** Show the request of a name. */
export function showRequest(name) {
  $("#request").value = name;
  showSource();
  $("#code").focus();
}

async function saveCsv(inputs) {
  const { name, path, body } = requests.find((request) => request.name === $("#request").value);
  download(`${fileName(name)}.csv`, inShownUnits(await queryCsv(path, body), inputs), "text/csv");
}

/** Connect the section; `inputsOf()` returns the inputs that are shown. */
export function connectExport(inputsOf) {
  $("#request").addEventListener("change", showSource);
  $("#language").addEventListener("change", showSource);
  $("#copy").addEventListener("click", async () => {
    $("#copied").textContent = (await copied($("#code"))) ? "Copied." : "Selected: press Ctrl+C to copy.";
  });
  $("#csv").addEventListener("click", () => saveCsv(inputsOf()));
}
