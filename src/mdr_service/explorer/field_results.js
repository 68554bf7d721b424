// Results of stresses in a body and of wear.

import { basics } from "./inputs.js";
import { strengthOf } from "./materials.js";
import { ALONG, fieldChart, fieldsOf, marker, normalForce, numbersOf, pressureChart, pushed, relationChart, shearStressChart, single, surfaceStress } from "./parts.js";

export async function solveStress(inputs, query) {
  const force = await normalForce(inputs, query);
  const base = pushed(inputs, force, inputs.shear);
  const strength = strengthOf(inputs, inputs.body);
  const material = { ...base.material, ...(strength === undefined ? {} : { yield_strength: strength }) };
  const sheared = inputs.shear === "none" ? [] : ["shear_stress"];
  const solved = query("Contact", "v1/normal", { ...basics(inputs), load: { normal_force: force } });
  const alongSurface = solved.then((contact) => {
    const radius = contact.contact_radius[0];
    return surfaceStress(query, inputs, base, radius, [["a", radius]]);
  });
  const [contact, surface, field, map] = await Promise.all([
    solved,
    alongSurface,
    fieldsOf(query, "Surface", base, ["pressure", ...sheared, "normal_displacement"]),
    query("Beneath", "v1/subsurface", {
      ...base, material, body: inputs.body, points: 61, quantities: ["von_mises"], largest: true,
    }),
  ]);
  const now = single(contact);
  const [mises, shear] = [single(map.largest.von_mises), single(map.largest.maximum_shear)];
  const edges = [["a", now.contact_radius]];
  const displacement = [{ name: "displacement", y: field.normal_displacement[0] }];
  const onset = (criterion) =>
    map.yield_onset_force ? [map.yield_onset_force[criterion][0], "force"] : ["needs a yield strength"];
  return {
    responses: [contact, field, map, surface.response],
    known: now,
    numbers: [
      ["Largest von Mises stress", mises.value, "pressure"],
      ["Normal force at onset of yield, von Mises", ...onset("von_mises")],
      ["Depth z of the largest stress", mises.z, "length"],
      ["x of the largest stress", mises.x, "length"],
      ["Largest shear stress", shear.value, "pressure"],
      ["Normal force at onset of yield, Tresca", ...onset("tresca")],
      ...surface.numbers,
      ...numbersOf(now, ["contact_radius"]),
    ],
    charts: [
      {
        request: "Beneath", title: "Von Mises stress beneath the surface", size: "wide", map: true, mirrored: true, edges,
        x: ALONG, y: ["Depth z", "length"],
        z: ["von Mises stress", "pressure"],
        traces: [
          { name: "von Mises stress", x: map.x, y: map.z, z: map.von_mises[0] },
          marker("largest", mises.x, mises.z),
        ],
      },
      pressureChart("Surface", field, edges),
      ...sheared.map(() => shearStressChart("Surface", field, inputs.mu, edges)),
      surface.chart,
      fieldChart(
        "Surface", "Normal displacement of the surface", "normal_displacement", edges, field.radius, displacement,
      ),
    ],
  };
}

export async function solveWear(inputs, query) {
  const body = {
    ...basics(inputs),
    load: { [inputs.control]: inputs.load },
    friction_coefficient: inputs.mu,
    oscillation: { [inputs.oscillation]: inputs.amplitude },
  };
  const decades = Array.from({ length: 17 }, (_, i) => 10 ** (i / 2));
  const cycles = [...new Set([...decades, inputs.cycles])].sort((a, b) => a - b);
  const course = await query("Evolution", "v1/wear/evolution", {
    ...body, wear_coefficient: inputs.wear, cycles, points: 200,
  });
  const { radius } = course;
  const limit = await query("Limit", "v1/wear", { ...body, radius });
  const [now, final] = [single(course, cycles.indexOf(inputs.cycles)), single(limit)];
  // The curve over the cycles goes beyond those of the form, where wear may end.
  const isWorn = now.worn_volume > 0.99 * course.worn_volume.at(-1);
  const warnings = course.warnings.filter(({ code }) => isWorn || code !== "limit_reached");
  // Unbounded wear has no limit, and outside a flat punch there is no profile.
  const depth = (profile) => profile.map((f, i) => {
    const unworn = limit.initial_profile[i];
    return f === null || unworn === null ? NaN : f - unworn;
  });
  const [stick, outer] = [now.stick_radius, now.contact_radius];
  const edges = [["c", stick], ["a", outer]];
  const width = outer - stick;
  // A narrow annulus fills a third of the chart.
  const range = width < 0.2 * outer ? [stick - width, outer + width] : undefined;
  // The radii reach as far as the contact after the largest number of cycles.
  const near = radius.at(-1) > 3 * outer ? { range: [0, 1.5 * outer] } : {};
  const hasLimit = final.worn_volume !== null;
  return {
    responses: [limit, { ...course, warnings }],
    known: now,
    numbers: [
      ...numbersOf(now, ["worn_volume", "contact_radius", "stick_radius"]),
      ["Worn volume in the limit", final.worn_volume, "volume"],
      ["Wear radius ã in the limit", final.wear_radius, "length"],
      ...numbersOf(now, ["indentation_depth", "normal_force", "dissipated_energy"]),
      ["Mean energy per cycle", now.dissipated_energy / inputs.cycles, "energy"],
    ],
    charts: [
      fieldChart("Evolution", "Profile", "profile", edges, radius, [
        { name: "after these cycles", y: now.profile },
        { name: "unworn", y: limit.initial_profile, role: "limit" },
        ...(hasLimit ? [{ name: "limit", y: final.limiting_profile, role: "second" }] : []),
      ], near),
      fieldChart("Evolution", "Worn depth", "worn_depth", edges, radius, [
        { name: "after these cycles", y: depth(now.profile) },
        ...(hasLimit ? [{ name: "limit", y: depth(final.limiting_profile), role: "second" }] : []),
      ], range ? { range } : near),
      fieldChart("Evolution", "Pressure after these cycles", "pressure", edges, radius, [
        { name: "pressure", y: now.pressure, fill: true },
      ], near),
      relationChart(
        "Evolution", "Worn volume against cycles", course, ["cycles", "worn_volume"], now,
        { mark: "these cycles", logarithmic: now.worn_volume > 0 },
      ),
    ],
  };
}
