// The page of the profile kinds and of the limits of the service.

import { make, makeTable } from "./dom.js";
import { KINDS } from "./shapes.js";

const fetched = (path) => fetch(path).then((response) => response.json());
const fieldWords = ({ name, dimension, description, required }) =>
  make("div", {}, make("code", {}, name), ` ${description} [${dimension}]${required ? "" : ", optional"}`);

const [{ profiles }, limits, api] = await Promise.all(["../v1/profiles", "../v1/limits", "../openapi.json"].map(fetched));
document.querySelector("#kinds").replaceChildren(makeTable(["Kind", "f(r)", "Fields"], profiles.map(({ kind, formula, fields }) =>
  [make("span", {}, KINDS[kind]?.label ?? kind, make("br"), make("code", {}, kind)), formula, make("div", {}, ...fields.map(fieldWords))])));
const meanings = api.components.schemas.Settings.properties;
document.querySelector("#limits").replaceChildren(makeTable(["Limit", "Value", "Meaning"], Object.entries(limits).map(([name, value]) =>
  [make("code", {}, name), Array.isArray(value) ? value.join(" ") || "none" : value.toLocaleString("en"), meanings[name]?.description ?? ""])));
