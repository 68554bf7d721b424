"""Profiles and curves in files are read as they are meant, or refused with the line."""

import json
from pathlib import Path
from time import process_time

import pytest

from mdr_core import InputError, Tabulated, read_curve, read_table

TABLES = Path(__file__).parents[1] / "data" / "tables"
EXPECTED = json.loads((TABLES / "expected.json").read_text("utf-8"))


@pytest.mark.parametrize("file", EXPECTED["read"])
def test_tables_of_instruments_are_read(file: str) -> None:
    expected = EXPECTED["points"] | EXPECTED["read"][file]
    named = None not in expected["units"]
    table = read_table(TABLES / file, None if named else "m")
    assert table.r.tolist() == expected["r"]
    assert table.f.tolist() == expected["f"]
    millimetres = read_table(TABLES / file, None if named else "m", to="mm")
    assert millimetres.r.tolist() == [float(f"{1e3 * r:.15g}") for r in expected["r"]]


@pytest.mark.parametrize("file", EXPECTED["refused"])
def test_tables_that_cannot_be_read_are_refused_with_the_line(file: str) -> None:
    with pytest.raises(InputError) as refused:
        read_table(TABLES / file, "m")
    assert refused.value.detail == EXPECTED["refused"][file]


@pytest.mark.parametrize(
    ("file", "unit", "detail"),
    [
        ("plain.txt", None, "is required: no heading names the unit of r"),
        ("plain.txt", "foot", "foot is none of m, mm, µm, nm"),
        ("decimal_comma.csv", "mm", "is µm in the heading of f, and not mm"),
    ],
)
def test_unit_is_needed_once(file: str, unit: str | None, detail: str) -> None:
    with pytest.raises(InputError) as refused:
        read_table(TABLES / file, unit)
    assert refused.value.path == ("length_unit",)
    assert refused.value.detail == detail


def test_units_of_radii_and_heights_may_differ() -> None:
    table = read_table(TABLES / "plain.txt", ("mm", "µm"))
    assert table.r.tolist() == [0, 5e-8, 1e-7, 1.5e-7]
    assert table.f.tolist() == [0, 1.25e-13, 5e-13, 1.125e-12]


def test_table_is_a_profile() -> None:
    # A ball of radius 10 mm.
    profile = Tabulated(*read_table(TABLES / "tabs.txt"))
    assert float(profile.f(1e-4)) == pytest.approx(5e-7, rel=1e-3, abs=0)


NAMES = {
    "depth": ("Depth", "Displacement", "Pd", "Eindringtiefe"),
    "force": ("Load", "Fn", "Kraft"),
}
PREFIXES = {
    "n": (-9, "nano"),
    "µ": (-6, "micro"),
    "m": (-3, "milli"),
    "": (0, ""),
    "k": (3, "kilo"),
}
FORMS = (
    "{name} [{unit}]",
    "{name} ({unit})",
    "{name}/{unit}",
    "{name}_{unit}",
    "{name}_{word}_{base}",
    "{name} ({word} {base})",
    "{name} [10^{power} {base}]",
    "{name} (1e{power} {base})",
    "{name} [x10{power:+} {base}]",
    "{name} in {unit}",
)


def headings() -> list[tuple[str, str, float]]:
    return [
        (
            form.format(name=name, unit=prefix + base, base=base, word=word, power=power),
            quantity,
            power,
        )
        for quantity, base in (("depth", "m"), ("force", "N"))
        for name in NAMES[quantity][:2]
        for prefix, (power, word) in PREFIXES.items()
        for form in FORMS
        # Without a prefix some forms hold no unit, or a power of zero.
        if prefix or form in FORMS[:4]
    ]


@pytest.mark.parametrize("force_first", [False, True])
def test_headings_with_prefixes_and_powers_are_read_whole(
    tmp_path: Path, *, force_first: bool
) -> None:
    read = 0
    for heading, quantity, power in (every := headings()):
        other, scale = ("Load [mN]", 1e-3) if quantity == "depth" else ("Depth [nm]", 1e-9)
        titles = [heading, other] if (quantity == "force") == force_first else [other, heading]
        columns = (2.5, 7.5) if titles[0] == heading else (7.5, 2.5)
        file = tmp_path / "curve.csv"
        file.write_text(";".join(titles) + "\n0;0\n{};{}\n".format(*columns), "utf-8")
        try:
            curve = read_curve(file)
        except InputError:
            continue
        read += 1
        values = {"depth": curve.indentation_depth[1], "force": curve.normal_force[1]}
        assert values.pop(quantity) == pytest.approx(2.5 * 10.0**power, rel=1e-12, abs=0), heading
        assert values.popitem()[1] == pytest.approx(7.5 * scale, rel=1e-12, abs=0), heading
    assert read >= 0.9 * len(every)


@pytest.mark.parametrize(
    ("heading", "rows", "unit"),
    [
        ("Load [N];Extension [mm]", "5;0,1\n6;0,2", "mm N"),
        ("Load;Extension", "5;0,1\n6;0,2", None),
        (
            "Time (s)\tPd (µm)\tFn (µN)\tFnRef (µN)\tSegment",
            "0\t0.1\t5\t4\tup\n1\t0.2\t6\t4\tup",
            "µm µN",
        ),
        ("Displacement (nm)\tLoad (mN)\tTime (s)", "0.1\t5\t0\n0.2\t6\t1", "nm mN"),
        ("Displacement Into Surface,Load On Sample,Time\nnm,mN,s", "0.1,5,0\n0.2,6,1", "nm mN"),
        ("Calc_Ramp_Ex_nm Defl_nN_Ex", "0.1 5\n0.2 6", "nm nN"),
        (
            "# columns: time vDeflection tipSampleSeparation\n# units: s N m",
            "0 5 0.1\n1 6 0.2",
            "m N",
        ),
        ("Time,Extension,Load\n(s),(mm),(N)", '"0","0.1","5"\n"1","0.2","6"', "mm N"),
        ("Prüfzeit;Standardweg;Standardkraft\ns;mm;N", "0;0,1;5\n1;0,2;6", "mm N"),
        ("Time,Force,Stroke\nsec,N,mm", "0.0,5,0.1\n1.0,6,0.2", "mm N"),
        ("Force (g),Distance (mm)", "5,0.1\n6,0.2", "refused"),
        (";Kraft;Weg\n;N;mm", "a;5;0,1\nb;6;0,2", "mm N"),
        ("Depth [cm],Force [lbf]", "0.1,5\n0.2,6", "cm lbf"),
    ],
)
def test_curves_as_instruments_export_them(
    tmp_path: Path, heading: str, rows: str, unit: str | None
) -> None:
    file = tmp_path / "curve.txt"
    file.write_text(f"{heading}\n{rows}\n", "utf-8")
    if unit == "refused":
        with pytest.raises(InputError, match="Line 1: the unit g is none of N, mN, µN, nN"):
            read_curve(file)
        return
    sizes = {"m": 1, "mm": 1e-3, "cm": 1e-2, "µm": 1e-6, "nm": 1e-9}
    sizes |= {"N": 1, "mN": 1e-3, "µN": 1e-6, "nN": 1e-9, "lbf": 4.4482216152605}
    depth, force = (sizes[each] for each in (unit or "m N").split())
    curve = read_curve(file, (None, None) if unit else ("m", "N"))
    expected = pytest.approx([0.1 * depth, 0.2 * depth], rel=1e-12, abs=0)
    assert curve.indentation_depth.tolist() == expected
    assert curve.normal_force.tolist() == pytest.approx([5 * force, 6 * force], rel=1e-12, abs=0)


@pytest.mark.parametrize(
    ("text", "detail"),
    [
        ("Alpha,Beta\n0.1,5\n0.2,6", "name the depth d and the force F"),
        ("Depth * 10^6,Force [N]\n0.1,5\n0.2,6", "the unit or factor in"),
        ("Load rate,Depth,Time\n1.0,2.0,3.0", "name the depth d and the force F"),
        ("Depth [nm],Force [N]\n0.1,5\n0.2,1e999", "Line 3: a number is too large"),
        ("PK\x03\x04", "is a workbook"),
    ],
)
def test_what_is_not_understood_is_refused(tmp_path: Path, text: str, detail: str) -> None:
    file = tmp_path / "curve.csv"
    file.write_text(text, "utf-8")
    with pytest.raises(InputError, match=detail):
        read_curve(file, ("m", "N"))


@pytest.mark.parametrize("line", [" " * 300_000, "\t" * 300_000, "[" * 300_000, "a " * 150_000])
def test_long_lines_take_linear_time(tmp_path: Path, line: str) -> None:
    file = tmp_path / "curve.csv"
    file.write_text(f"{line}\n# {line}\nd [m];F [N]\n0;0\n1;2\n", "utf-8")
    begin = process_time()
    assert read_curve(file).normal_force.tolist() == [0, 2]
    assert process_time() - begin < 2
