// Young's modulus [Pa], Poisson's ratio, yield strength [Pa] and density [kg/m³] of common materials, as
// starting values: those of the material at hand differ by some per cent, the strength by far more. It
// is null where the material does not yield in tension, or where its name leaves it open.
// Moduli: metals, nylon and rubber lie in the ranges of J. M. Gere, Mechanics of Materials, 5th ed.,
// Table H-2, the density of structural steel and brass in those of Table H-1;
// bearing steel: T. A. Harris, M. N. Kotzalas, Rolling Bearing Analysis, 5th ed.;
// diamond, of indenters: W. C. Oliver, G. M. Pharr, J. Mater. Res. 7 (1992) 1564;
// polycrystalline silicon: W. N. Sharpe et al., Proc. 10th IEEE Workshop on MEMS (1997) 424;
// silicon nitride lies in the ranges of ASTM F2094 for bearing balls;
// tungsten carbide: H. Doi et al., Metall. Trans. 1 (1970) 1417;
// alumina: R. G. Munro, J. Am. Ceram. Soc. 80 (1997) 1919; N-BK7: data sheet of Schott;
// fused silica: data sheet of Corning HPFS 7980.
// Strengths: structural steel, the least of ASTM A36; stainless steel 304, the least of ASTM A240;
// 6061-T6, typical, The Aluminum Association; Ti-6Al-4V, the least of ASTM B348, grade 5.

export const MATERIALS = {
  "Structural steel": [2.1e11, 0.3, 2.5e8, 7850],
  "Bearing steel 52100": [2.07e11, 0.3, null, 7810],
  "Stainless steel 304": [1.9e11, 0.3, 2.05e8, 7900],
  "Aluminium 6061-T6": [7e10, 0.33, 2.76e8, 2700],
  "Titanium Ti-6Al-4V": [1.14e11, 0.33, 8.28e8, 4430],
  "Brass": [1.03e11, 0.34, null, 8500],
  "Tungsten carbide, 6 % Co": [6.3e11, 0.22, null, 14900],
  "Diamond": [1.141e12, 0.07, null, 3515],
  "Silicon, polycrystalline": [1.69e11, 0.22, null, 2330],
  "Silicon nitride": [3.1e11, 0.26, null, 3200],
  "Alumina, sintered": [4.16e11, 0.231, null, 3984],
  "Glass N-BK7": [8.2e10, 0.206, null, 2510],
  "Fused silica": [7.27e10, 0.16, null, 2200],
  "Nylon": [2.8e9, 0.4, null, null],
  "Rubber": [2e6, 0.49, null, null],
};

/** Return the name of the listed material of body `i`, or undefined. */
export function materialOf(inputs, i) {
  return Object.keys(MATERIALS).find((name) =>
    MATERIALS[name][0] === inputs[`e${i}`] && MATERIALS[name][1] === inputs[`nu${i}`]);
}

/** Return the yield strength of body `i`: as given, else that of its material, else undefined. */
export function strengthOf(inputs, i) {
  return inputs[`yield${i}`] === "" ? MATERIALS[materialOf(inputs, i)]?.[2] ?? undefined : inputs[`yield${i}`];
}

/** Return the density of body 1: as given, else that of its material, else undefined. */
export function densityOf(inputs) {
  return inputs.density === "" ? MATERIALS[materialOf(inputs, 1)]?.[3] ?? undefined : inputs.density;
}

/** Return the mass of body 1: as given, else that of a solid ball of its radius, else undefined. */
export function massOf(inputs) {
  if (inputs.mass !== "") return inputs.mass;
  const radius = { two_spheres: inputs.radius_1, paraboloid: inputs.radius, sphere: inputs.radius }[inputs.kind];
  const mass = (4 / 3) * Math.PI * radius ** 3 * densityOf(inputs);
  return mass > 0 ? mass : undefined;
}

/** Return the elastic body of the lower yield strength, if both are known, else the one that is chosen. */
export function weakest(next) {
  const rigid = [1, 2].find((i) => next[`e${i}`] === "rigid");
  if (rigid) return 3 - rigid;
  const [first, second] = [1, 2].map((i) => strengthOf(next, i));
  if (first === undefined || second === undefined || first === second) return next.body;
  return first < second ? 1 : 2;
}
