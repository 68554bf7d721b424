// Elements of the page.

/** Return an element with properties or attributes, and contents. */
export function make(name, properties = {}, ...contents) {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(properties)) {
    if (key in element) element[key] = value;
    else element.setAttribute(key, value);
  }
  element.append(...contents);
  return element;
}

/** Return a button that calls `onclick`. */
export function makeButton(textContent, onclick, attributes) {
  return make("button", { type: "button", textContent, onclick, ...attributes });
}

/** Return a table of titled columns, each cell a text or an element. */
export function makeTable(titles, rows) {
  const table = make("table");
  table.createTHead().insertRow().append(...titles.map((title) => make("th", { scope: "col" }, title)));
  const body = table.createTBody();
  for (const cells of rows) body.insertRow().append(...cells.map((cell) => make("td", {}, cell)));
  return table;
}
