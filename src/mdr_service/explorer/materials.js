// Young's modulus [Pa] and Poisson's ratio of common materials, as starting values: those of the
// material at hand differ by some per cent, of polymers and rubber by far more.
// Metals, nylon and rubber lie in the ranges of J. M. Gere, Mechanics of Materials, 5th ed., Table H-2;
// bearing steel: T. A. Harris, M. N. Kotzalas, Rolling Bearing Analysis, 5th ed.;
// diamond, of indenters: W. C. Oliver, G. M. Pharr, J. Mater. Res. 7 (1992) 1564;
// polycrystalline silicon: W. N. Sharpe et al., Proc. 10th IEEE Workshop on MEMS (1997) 424;
// silicon nitride lies in the ranges of ASTM F2094 for bearing balls;
// tungsten carbide: H. Doi et al., Metall. Trans. 1 (1970) 1417;
// alumina: R. G. Munro, J. Am. Ceram. Soc. 80 (1997) 1919; N-BK7: data sheet of Schott;
// fused silica: data sheet of Corning HPFS 7980.

export const MATERIALS = {
  "Steel": [2.1e11, 0.3],
  "Bearing steel 52100": [2.07e11, 0.3],
  "Stainless steel": [1.9e11, 0.3],
  "Aluminium 6061-T6": [7e10, 0.33],
  "Titanium alloy": [1.14e11, 0.33],
  "Brass": [1.03e11, 0.34],
  "Tungsten carbide, 6 % Co": [6.3e11, 0.22],
  "Diamond": [1.141e12, 0.07],
  "Silicon, polycrystalline": [1.69e11, 0.22],
  "Silicon nitride": [3.1e11, 0.26],
  "Alumina, sintered": [4.16e11, 0.231],
  "Glass N-BK7": [8.2e10, 0.206],
  "Fused silica": [7.27e10, 0.16],
  "Nylon": [2.8e9, 0.4],
  "Rubber": [2e6, 0.49],
};
