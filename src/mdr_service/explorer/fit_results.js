// Results of fits to measured curves and loops.

import { basics, hasLoop } from "./inputs.js";
import { QUANTITIES } from "./quantities.js";
import { Refusal } from "./requests.js";
import { inSI } from "./shapes.js";
import { numberOf } from "./units.js";

// Points that a fit needs.
const LEAST = 3;

/** Return the fitted parameters with their standard errors. */
function parametersOf(found) {
  return found.fit.map((name, i) => {
    const [label, dimension] = QUANTITIES[name];
    return [label, found[name][0], dimension, found.standard_errors[i]];
  });
}

/** Return the numbers that say how well the model meets the forces. */
const qualityOf = ({ noise, misfit }) => [
  ["Scatter of the forces", noise[0], "force", undefined, 2], ["p-value of the residuals as noise", misfit[0], "1", undefined, 2],
];

/** Return the charts of measured and fitted points `[x, y]`, and of the residuals against `place`. */
function chartsOf(found, title, [x, y], measured, fitted, [placeAxis, place], options) {
  const axes = { x: QUANTITIES[x], y: QUANTITIES[y] };
  const points = (name, columns, role) => ({ name, x: columns[0], y: columns[1], mode: "markers", role });
  return [
    {
      request: "Fit", title, size: "wide", ...axes, ...options,
      traces: [points("measured", measured, "second"), ...fitted],
    },
    {
      request: "Fit", title: `Residual against ${placeAxis[0].toLowerCase()}`, x: placeAxis, y: ["Measured less fitted force", "force"],
      traces: [points("residual", [place, found.residual])],
    },
  ];
}

async function solveLoop(inputs, query) {
  const { depths, forces } = inSI(inputs.curve);
  const found = await query("Fit", "v1/tangential/fit", {
    ...basics(inputs), [inputs.control]: inputs.load, tangential_displacement: depths, tangential_force: forces,
    ...(inputs.rig === "" ? {} : { rig_compliance: inputs.rig }),
  });
  const [label, dimension] = QUANTITIES.dissipated_energy;
  const [first, second, ...others] = parametersOf(found);
  const fitted = { name: "fit", x: depths, y: found.tangential_force };
  return {
    responses: [found],
    known: {},
    numbers: [
      first, second, [`${label} per cycle`, found.dissipated_energy[0], dimension, found.dissipated_energy_error[0]],
      ...others, ...qualityOf(found),
    ],
    charts: chartsOf(
      found, "Force against displacement", ["tangential_displacement", "tangential_force"], [depths, forces], [fitted],
      [["Point of the loop", "1"], depths.map((_, i) => i + 1)],
    ),
  };
}

export async function solveFit(inputs, query) {
  if (hasLoop(inputs)) return solveLoop(inputs, query);
  const { depths: measured, forces } = inSI(inputs.curve);
  const { rows, from, to, curve: { times } } = inputs;
  const [rate, error] = inputs.drift ? inputs.drift.split(",").map(numberOf) : [];
  const depths = inputs.drift ? measured.map((depth, i) => depth - rate * times[i]) : measured;
  const [begin, end] = rows ? rows.split(",").map(Number) : [0, depths.length];
  const isTaken = depths.map((depth, i) => i >= begin && i <= end && (from === "" || depth >= from) && (to === "" || depth <= to));
  const taken = (list) => list.filter((_, i) => isTaken[i]);
  if (taken(depths).length < LEAST && depths.length >= LEAST) {
    const pointer = to === "" ? "/from" : "/to";
    throw new Refusal({ title: "Invalid request", errors: [{ pointer, detail: `fewer than ${LEAST} points are left to fit` }] });
  }
  const others = (list) => list.filter((_, i) => !isTaken[i]);
  const drift = inputs.drift ? { time: taken(times), drift_rate: rate, drift_rate_error: error } : {};
  const { profile, material } = basics(inputs);
  const found = await query("Fit", "v1/normal/fit", {
    profile, indentation_depth: taken(measured), ...drift, normal_force: taken(forces),
    fit: ["e_star", ...(inputs.fitted === "none" ? [] : inputs.fitted.split(","))],
    layer: material.layer, poissons_ratio: inputs.nu2, indenter: material.bodies[0],
  });
  // With adhesion some of the measured points are left out.
  const { indentation_depth: used } = found;
  const order = used.map((_, i) => i).sort((i, j) => used[i] - used[j]);
  const sorted = (column) => order.map((i) => column[i]);
  const correlation = found.correlation[0][1];
  const [modulus, ...parameters] = parametersOf(found);
  const sample = [[QUANTITIES.youngs_modulus[0], found.youngs_modulus[0], "modulus", found.youngs_modulus_error[0]]];
  return {
    responses: [found],
    known: {},
    numbers: [
      modulus, ...sample, ...parameters, ...(inputs.drift ? [["Drift", rate, "m/s", error]] : []),
      ...(correlation === undefined ? [] : [["Correlation of E* and contact point", correlation, "1", undefined, 2]]),
      ...qualityOf(found),
    ],
    charts: chartsOf(
      found, "Force against depth", ["indentation_depth", "normal_force"], [depths, forces].map(taken),
      [
        { name: "fit", x: sorted(used), y: sorted(found.normal_force) },
        ...(isTaken.includes(false) ? [{ name: "left out", x: others(depths), y: others(forces), mode: "markers", role: "limit" }] : []),
      ],
      [["Depth", "displacement"], used], { selects: true },
    ),
  };
}
