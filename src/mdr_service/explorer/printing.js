// One sheet of paper: the inputs in words, its numbers and charts.

import { redraw } from "./charts.js";

/** Lay out the page as a sheet that states the inputs, or as a screen again. */
export function showForPrint(printing) {
  document.documentElement.classList.toggle("printing", printing);
  const rows = document.querySelectorAll("#inputs fieldset:not(#units, [hidden]) .row:not(.field .file)");
  document.querySelector("#given").textContent = [...rows].map((row) => {
    const [control, words] = [row.querySelector("input, select"), [...row.querySelectorAll("span")]];
    const value = control.selectedOptions?.[0].text ?? control.value;
    return `${words[0].textContent}: ${value} ${words[1]?.textContent ?? ""}`.trim();
  }).join("; ");
  if (printing) redraw();
}
