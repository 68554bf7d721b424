// Sketch of the profile: the outline f(r) above the second body.

import { outline, wireProfile } from "./shapes.js";

// Coordinates that an image of any size can hold.
const FAR = 1e6;

/** Draw the profile of the inputs on its base if it has one, and the contact if its radius is known. */
export function showSketch(svg, inputs, contact) {
  const [width, height] = [280, 120];
  const profile = wireProfile(inputs);
  const points = outline(profile, (contact || inputs.radius || 1e-4) * 2);
  const wall = profile.kind === "flat_punch";
  const [end, top] = [Math.max(...points.map(([r]) => r)), Math.max(...points.map(([, f]) => f)) || 1];
  const scale = [(width / 2 - 8) / (wall ? end * 2 : end), (height - 44) / top];
  const at = ([r, f], side) => `${width / 2 + side * r * scale[0]},${height - 24 - f * scale[1]}`;
  const right = points.map((point) => at(point, 1));
  const left = points.map((point) => at(point, -1)).reverse();
  const corner = (side) => `${width / 2 + side * end * scale[0]},8`;
  const touch = Math.min(contact ?? 0, end) * scale[0];
  svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
  svg.replaceChildren();
  // Parameters of no body have no outline.
  const drawn = points.flatMap(([r, f]) => [r * scale[0], f * scale[1]]);
  if (!(end > 0) || !(top > 0) || !drawn.every((x) => Math.abs(x) < FAR)) return;
  svg.innerHTML =
    `<rect class="base" x="0" y="${height - 24}" width="${width}" height="24"/>` +
    `<polygon class="body" points="${corner(-1)} ${left.join(" ")} ${right.join(" ")} ${corner(1)}"/>` +
    `<line class="touch" x1="${width / 2 - touch}" x2="${width / 2 + touch}" y1="${height - 24}" y2="${height - 24}"/>`;
}
