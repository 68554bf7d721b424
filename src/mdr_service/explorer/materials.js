// Young's modulus [Pa] and Poisson's ratio of common materials, as starting values: those of the
// material at hand differ by some per cent, of polymers and rubber by far more.
// Metals, nylon and rubber lie in the ranges of J. M. Gere, Mechanics of Materials, 5th ed., Table H-2;
// alumina: R. G. Munro, J. Am. Ceram. Soc. 80 (1997) 1919; N-BK7: data sheet of Schott;
// fused silica: data sheet of Corning HPFS 7980.

export const MATERIALS = {
  "Steel": [2.1e11, 0.3],
  "Stainless steel": [1.9e11, 0.3],
  "Aluminium 6061-T6": [7e10, 0.33],
  "Titanium alloy": [1.14e11, 0.33],
  "Brass": [1.03e11, 0.34],
  "Alumina, sintered": [4.16e11, 0.231],
  "Glass N-BK7": [8.2e10, 0.206],
  "Fused silica": [7.27e10, 0.16],
  "Nylon": [2.8e9, 0.4],
  "Rubber": [2e6, 0.49],
};
