"""Sources of the cases, by their keys; "as in" names where the values or equations were read."""

from typing import Final

SOURCES: Final = {
    "hertz": "H. Hertz, J. reine angew. Math. 92 (1882) 156-171; Johnson 1985, (4.22)-(4.24)",
    "boussinesq": "J. Boussinesq, 1885; Johnson 1985, section 3.4",
    "huber": "M. T. Huber, Ann. Phys. 319 (1904) 153-163, as in ContactMechanics",
    "cattaneo": (
        "C. Cattaneo, Rend. Accad. Naz. Lincei 27 (1938) 342-348; R. D. Mindlin, J. Appl. Mech. 16 "
        "(1949) 259-268"
    ),
    "love": "A. E. H. Love, Q. J. Math. 10 (1939) 161-175",
    "mindlin-deresiewicz": "R. D. Mindlin, H. Deresiewicz, J. Appl. Mech. 20 (1953) 327-344",
    "lubkin": "J. L. Lubkin, J. Appl. Mech. 18 (1951) 183-187",
    "deresiewicz": "H. Deresiewicz, J. Appl. Mech. 21 (1954) 52-56",
    "jaeger": "J. Jaeger, Arch. Appl. Mech. 65 (1995) 478-487",
    "segalman": "D. J. Segalman, M. J. Starr, M. W. Heinstein, J. Appl. Mech. 72 (2005) 705",
    "galin": "L. A. Galin, Contact Problems in the Theory of Elasticity, 1953",
    "sneddon": "I. N. Sneddon, Int. J. Eng. Sci. 3 (1965) 47-57",
    "cremers": "C. J. Cremers, R. C. Birkebak, Appl. Opt. 5 (1966) 1057-1064, as in PyAbel",
    "hamilton": "G. M. Hamilton, Proc. Inst. Mech. Eng. 197C (1983) 53-59, as in ContactMechanics",
    "johnson": "K. L. Johnson, Contact Mechanics, Cambridge University Press 1985",
    "briscoe": (
        "B. J. Briscoe, K. S. Sebastian, M. J. Adams, J. Phys. D 27 (1994) 1156-1162, as in AtomicJ"
    ),
    "kalker": "J. J. Kalker 1990, section 5.2.1.1: example `cattaneo` of E. Vollebregt's CONTACT",
    "buie": (
        "M. J. Buie et al., J. Quant. Spectrosc. Radiat. Transf. 55 (1996) 231-243, as in PyAbel"
    ),
    "sun": "Y. Sun, B. Akhremitchev, G. C. Walker, Langmuir 20 (2004) 5837-5845, as in AtomicJ",
    "chung-ooi": "Y. C. Chung, J. Y. Ooi, Granular Matter 13 (2011) 643-656, parameters as in YADE",
    "mdr-5": (
        "V. L. Popov, M. Hess, Method of Dimensionality Reduction in Contact Mechanics and "
        "Friction, Springer 2015, chapter 5"
    ),
    "maw": "N. Maw, J. R. Barber, J. N. Fawcett, Wear 38 (1976) 101-114",
    "kharaz": (
        "A. H. Kharaz, D. A. Gorham, A. D. Salman, Powder Technol. 120 (2001) 281-291, as in Lethe"
    ),
    "wu": "finite elements of C.-Y. Wu, as in `chung-ooi`; points of the figure as in Kratos",
    "contactmechanics": "L. Pastewka et al., ContactMechanics, test_reference_solutions.py",
    "jkr": "K. L. Johnson, K. Kendall, A. D. Roberts, Proc. R. Soc. Lond. A 324 (1971) 301-313",
    "kendall": "K. Kendall, J. Phys. D 4 (1971) 1186-1195",
    "maugis": "D. Maugis, Langmuir 11 (1995) 679-682",
    "popov-adhesion": (
        "V. L. Popov, M. Hess, Method of Dimensionality Reduction in Contact Mechanics and "
        "Friction, Springer 2015, chapter 4"
    ),
    "hay": "J. C. Hay, A. Bolshakov, G. M. Pharr, J. Mater. Res. 14 (1999) 2296-2305",
    "spence": "D. A. Spence, Proc. R. Soc. Lond. A 305 (1968) 55-80",
    "lebedev": (
        "N. N. Lebedev, Ia. S. Ufliand, J. Appl. Math. Mech. 22 (1958) 442-450, and W. C. Hayes et "
        "al., J. Biomech. 5 (1972) 541-551; integral equation solved in verification/layers.py"
    ),
    "hayes": (
        "W. C. Hayes et al., J. Biomech. 5 (1972) 541-551, factors for ν = 0.5; his numerical "
        "solution is low by 0.9 % at a/h = 2"
    ),
    "dimitriadis": "E. K. Dimitriadis et al., Biophys. J. 82 (2002) 2798-2810",
    "compressed-ball": (
        "A. I. Lur'e, Three-Dimensional Problems of the Theory of Elasticity, 1964: series of a "
        "solid sphere, evaluated in verification/compressed_ball.py; finite elements in "
        "tests/oracles/ball_elements.py agree to 5e-4"
    ),
    "conforming-balls": (
        "The gap of two exact spheres, in closed form and by series of the solid ball and of the "
        "cavity (A. I. Lur'e, 1964), evaluated in verification/conforming_balls.py"
    ),
    "layer-equation": (
        "The equation of `lebedev` for any profile: tests/oracles/layer_reference.py"
    ),
    "first-order": (
        "Limits of simpler models, from closed forms of F_N in tests/oracles/shapes.py"
    ),
    "transverse-slip": (
        "Boundary elements with the displacements of Cerruti and Coulomb's friction: "
        "verification/transverse_slip.py"
    ),
    "ring-elements": "Independent numerical solution, with bounds: verification/ring_elements.py",
}
