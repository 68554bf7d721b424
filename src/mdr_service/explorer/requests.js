// Requests to the service, and their forms for other tools.

import { QUANTITIES } from "./quantities.js";
import { times, unit, withUnit } from "./units.js";

/** The service refused a request; `problem` is its problem+json. */
export class Refusal extends Error {
  constructor(problem) {
    super(problem.errors?.[0]?.detail ?? problem.detail ?? problem.title);
    this.problem = problem;
  }
}

async function post(path, body, accept) {
  const headers = { "content-type": "application/json", accept };
  const send = () => fetch(path, { method: "POST", headers, body: JSON.stringify(body) }).catch(() => {
    throw new Refusal({ title: "The service cannot be reached" });
  });
  let response = await send();
  if (response.status === 503) {
    // The service is busy and says for how long.
    const seconds = Number(response.headers.get("retry-after") ?? 1);
    await new Promise((done) => setTimeout(done, 1000 * seconds));
    response = await send();
  }
  if (response.ok) return response;
  const problem = await response.json().catch(() => ({ title: `The service answered ${response.status}` }));
  throw new Refusal(problem);
}

/** Return the response to a query. */
export async function query(path, body) {
  return (await post(path, body, "application/json")).json();
}

/** Return the response to a query as CSV. */
export async function queryCsv(path, body) {
  return (await post(path, body, "text/csv")).text();
}

/** Return the CSV of a response, whose headings are the names of quantities, in the units shown. */
export function inShownUnits(csv, inputs) {
  const [heading, ...rows] = csv.trim().split(/\r?\n/).map((line) => line.split(","));
  const columns = heading.map((name) => QUANTITIES[name.split(".")[0]]);
  const titles = heading.map((name, i) => (columns[i] ? `"${withUnit([name, columns[i][1]], inputs)}"` : name));
  const value = (text, i) => {
    const isNumber = columns[i] && text !== "" && Number.isFinite(Number(text));
    return isNumber ? times(Number(text), 1 / unit(columns[i][1], inputs).factor) : text;
  };
  return [titles, ...rows.map((row) => row.map(value))].map((row) => `${row.join(",")}\n`).join("");
}

/**
 * Return a function that runs `work` with at most one run at a time: a call during a run
 * waits for its end, and only the newest waiting call runs.
 */
export function newestWins(work) {
  let [running, waiting] = [false, false];
  return async function run() {
    if (running) {
      waiting = true;
      return;
    }
    running = true;
    try {
      do {
        waiting = false;
        await work();
      } while (waiting);
    } finally {
      running = false;
    }
  };
}

/** Return a request as source in a language. */
export function source(language, { path, body }) {
  const url = new URL(path, document.baseURI).href;
  if (language === "JSON") return JSON.stringify(body, null, 2);
  if (language === "Python") {
    const json = JSON.stringify(body).replace(/([:,])(?=["[{\d-])/g, "$1 ");
    return `import httpx\n\nanswer = httpx.post(\n    "${url}",\n    json=${json},\n).raise_for_status().json()\n`;
  }
  return `curl -s ${url} \\\n  -H 'content-type: application/json' \\\n  -d '${JSON.stringify(body)}'\n`;
}

/** Copy the text of an element, and return whether that succeeded; the text is selected. */
export async function copied(element) {
  getSelection().selectAllChildren(element);
  // Pages over plain http have no clipboard, but may copy what is selected.
  if (!navigator.clipboard) return document.execCommand("copy");
  return navigator.clipboard.writeText(element.textContent).then(() => true, () => document.execCommand("copy"));
}

/** Return the name of a file about something, without a suffix. */
export function fileName(title) {
  return title.toLowerCase().replaceAll(" ", "-");
}

/** Offer a text as a download. */
export function download(name, content, type) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([content], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}
