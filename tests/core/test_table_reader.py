"""Profiles and curves in files are read as they are meant, or rejected with the line."""

import json
import math
from pathlib import Path
from time import process_time

import numpy as np
import pytest

from mdr_core import InputError, Tabulated, read_curve, read_table
from mdr_core.table_headings import CURVE, PROFILE
from mdr_core.table_reader import parse

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
    "heading",
    [
        "Contact depth [nm];Projected area [µm²]",
        "Contact Depth (nm);Contact Area (um^2)",
        "h_c [nm];A_c [µm²]",
        "hc / nm;Ac / µm²",
        "hc [nm];A(hc) [µm2]",
        "hc [nm];[µm²]",
        "Kontakttiefe [nm];Fläche [µm²]",
        "Profondeur (nm);Aire (µm²)",
    ],
)
def test_area_function_is_known_by_the_unit_or_the_name_of_the_area(heading: str) -> None:
    area = [0.01, 0.04, 0.09]
    rows = "".join(f"{10 * (i + 1)};{each}\n" for i, each in enumerate(area))
    table = parse(f"{heading}\n{rows}".encode(), PROFILE)
    assert [unit and unit[2] for _, unit, *_ in table.titles] == [1e-9, 1e-6]
    assert table.taken == {"area": [1], "height": [0]}
    radii = [(each / math.pi) ** 0.5 for each in area]
    assert table.values[0] == pytest.approx(radii, rel=1e-15, abs=0)
    assert table.values[1].tolist() == [10.0, 20.0, 30.0]


@pytest.mark.parametrize(
    ("heading", "unit"), [("r^2 [mm^2];f [µm]", "mm²"), ("A [nm];h [nm]", "nm")]
)
def test_unit_that_contradicts_the_name_is_refused(heading: str, unit: str) -> None:
    with pytest.raises(InputError, match=f"Line 1: the unit {unit} is none of"):
        parse(f"{heading}\n1;2\n3;4\n".encode(), PROFILE)


def test_power_of_ten_before_a_square_multiplies_the_area() -> None:
    area = parse(b"A [10^-12 m^2];h [nm]\n1;2\n3;4\n", PROFILE)
    assert area.values[0] == pytest.approx(np.sqrt(np.array([1.0, 3.0]) / np.pi), rel=1e-15, abs=0)
    assert area.titles[0].unit == ("area", "µm", 1e-6)
    with pytest.raises(InputError, match=r"Line 1: the unit 10\^-3 m\^2 is none of m², mm²"):
        parse(b"A [10^-3 m^2];h [nm]\n1;2\n3;4\n", PROFILE)


def test_column_a_is_a_radius_by_its_unit_alone() -> None:
    for heading, quantity in (("a [µm];h [nm]", "radius"), ("a [µm²];h [nm]", "area")):
        assert parse(f"{heading}\n1;2\n3;4\n".encode(), PROFILE).taken == {
            quantity: [0],
            "height": [1],
        }
    with pytest.raises(InputError, match="a may be a radius or an area: name it r or A, or give"):
        parse(b"a;h\n1;2\n3;4\n", PROFILE)
    # The columns that the user chooses are those of radii and heights.
    assert "radius" in parse(b"a;h\n1;2\n3;4\n", PROFILE, (1, 2)).taken


def test_row_of_units_between_blanks_has_one_for_each_column() -> None:
    # The form in which Gwyddion exports a profile.
    table = parse(b"#    x1    y1\n#   [m]   [m]\n1e-6  2e-9\n3e-6  4e-9\n", PROFILE)
    assert [title.unit for title in table.titles] == [("length", "m", 1.0)] * 2


def test_quoted_number_with_three_decimals_is_one_beside_another_decimal_comma() -> None:
    table = parse(b'r,f\n"0,5","0,125"\n"1,000","0,5"\n', PROFILE)
    assert np.array_equal(table.values, [[0.5, 1.0], [0.125, 0.5]])


def test_argument_of_a_function_is_no_unit() -> None:
    for heading in (b"r [mm];f(r) [mm]", b"x [mm];z(x) [mm]"):
        table = parse(heading + b"\n0;0\n1;2\n2;8\n", PROFILE)
        assert np.array_equal(table.values, [[0.0, 1.0, 2.0], [0.0, 2.0, 8.0]])


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
        ("Ind_nm Defl_nN_Ex", "0.1 5\n0.2 6", "nm nN"),
        ("Time,Extension,Load\n(s),(mm),(N)", '"0","0.1","5"\n"1","0.2","6"', "mm N"),
        ("Prüfzeit;Standardweg;Standardkraft\ns;mm;N", "0;0,1;5\n1;0,2;6", "mm N"),
        ("Time,Force,Stroke\nsec,N,mm", "0.0,5,0.1\n1.0,6,0.2", "mm N"),
        ("Force\tDistance\tTime\ng\tmm\tsec", "5\t0.1\t0\n6\t0.2\t1", "mm g"),
        ("X_Value\tDisplacement (um)\tForce (N)\tComment", "0\t0.1\t5\t\n1\t0.2\t6", "µm N"),
        ("Depth (mu m);Load (muN)", "0.1;5\n0.2;6", "µm µN"),
        (";Kraft;Weg\n;N;mm", "a;5;0,1\nb;6;0,2", "mm N"),
        ("Depth [cm],Force [lbf]", "0.1,5\n0.2,6", "cm lbf"),
        ("Depth (corrected) [nm];Load [mN] (raw)", "0.1;5\n0.2;6", "nm mN"),
    ],
)
def test_curves_as_instruments_export_them(
    tmp_path: Path, heading: str, rows: str, unit: str | None
) -> None:
    file = tmp_path / "curve.txt"
    file.write_text(f"{heading}\n{rows}\n", "utf-8")
    sizes = {"m": 1, "mm": 1e-3, "cm": 1e-2, "µm": 1e-6, "nm": 1e-9}
    sizes |= {"N": 1, "mN": 1e-3, "µN": 1e-6, "nN": 1e-9, "lbf": 4.4482216152605}
    sizes |= {"g": 9.80665e-3}
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
        (
            'Depth [nm],Force [N]\n"1,000.5",0\n"3,000",1',
            "Line 2: a comma may stand before thousands",
        ),
        ('Depth [nm],Force [N]\n500,0\n"1,000",1', "Line 3: a comma may stand before thousands"),
        ('Depth [nm],Force [N]\n1,0\n"1,000,000",1', "Line 3: a comma may stand before thousands"),
        ("d [m];F [N]\n0,0;0,0\n1.234,5;0,5", "Line 3: 2 numbers are expected"),
        ("d [nm];F [mN]\n1;2\n2;4\nMean;3", "Line 4: 2 numbers are expected: correct the line"),
        ("t;d [nm];F [mN]\n0;1;2\n1;2;4\nMax;2;4", "Line 4: 3 numbers are expected"),
        ("# d [nm] F [mN]\n1 2\n# d [µm] F [mN]\n1 2", "Line 3: the columns change"),
        ("# d [nm] F [mN]\n1 2\n# F [mN] d [nm]\n2 1", "Line 3: the columns change"),
        ("Strain;Load\n%;N\n0,1;2\n0,2;3", "2 columns; name the depth d"),
        ("PK\x03\x04", "is a workbook"),
    ],
)
def test_what_is_not_understood_is_refused(tmp_path: Path, text: str, detail: str) -> None:
    file = tmp_path / "curve.csv"
    file.write_text(text, "utf-8")
    with pytest.raises(InputError, match=detail):
        read_curve(file, ("m", "N"))


@pytest.mark.parametrize(
    "rows", ["0,5;1,5\n1;2", "1,2E-1;2\n0,5;1,5E1\n3E-9;7E-3", "01.05.2024;0,5;2\n02.05.2024;1;2"]
)
def test_rows_before_a_row_without_decimals_are_read(rows: str) -> None:
    heading = "Date;d [nm];F [mN]" if "." in rows else "d [nm];F [mN]"
    assert parse(f"{heading}\n{rows}".encode(), CURVE).lines == list(range(2, rows.count("\n") + 3))


@pytest.mark.parametrize("blank", ["\x0b\x0c", "\x1c", "\u2009"])
def test_line_of_any_blanks_is_blank(tmp_path: Path, blank: str) -> None:
    file = tmp_path / "curve.csv"
    file.write_text(f"{blank}\nd [m];F [N]\n0;0\n{blank}\n1;2\n", "utf-8")
    assert read_curve(file).normal_force.tolist() == [0, 2]


@pytest.mark.parametrize("line", [" " * 300_000, "\t" * 300_000, "[" * 300_000, "a " * 150_000])
def test_long_lines_take_linear_time(tmp_path: Path, line: str) -> None:
    file = tmp_path / "curve.csv"
    file.write_text(f"{line}\n# {line}\nd [m];F [N]\n0;0\n1;2\n", "utf-8")
    begin = process_time()
    assert read_curve(file).normal_force.tolist() == [0, 2]
    assert process_time() - begin < 2


#: Own imitations of the files of makers: text and units; each ends with 0.2 and 6.
FILES = {
    "Hysitron": (
        (
            "Test 12\n"
            "\n"
            "Peak Load: 1000 µN\tMax depth 120 nm\n"
            "Number of Points = 3\n"
            "\n"
            "Depth (nm)\tLoad (µN)\tTime (s)\tDepth (V)\tLoad (V)\n"
            "0.1\t5\t0\t0.001\t0.1\n"
            "0.2\t6\t0.005\t0.002\t0.2\n"
        ),
        "nm µN",
    ),
    "Anton Paar": (
        (
            "Indentation 1\n"
            "Date: 12/11/2020 10:15\n"
            "Max load: 10 mN\n"
            "Loading rate: 20 mN/min\n"
            "\n"
            "Time [s]\tPd [nm]\tFn [mN]\n"
            "0.000\t0.1\t5\n"
            "0.100\t0.2\t6\n"
        ),
        "nm mN",
    ),
    "MTS": (
        (
            "Sample,Fused silica,,\n"
            "Date 2020 11 12\n"
            "Displacement Into Surface,Load On Sample,Time On Sample,Segment Type\n"
            "nm,mN,s,\n"
            "0.1,5,0,Load\n"
            "0.2,6,1,Load\n"
        ),
        "nm mN",
    ),
    "Instron": (
        (
            '"Specimen label","A 1"\n'
            '"Maximum Load","12.5","N"\n'
            "\n"
            '"Time","Extension","Load"\n'
            '"(s)","(mm)","(N)"\n'
            '"0.0","0.1","5"\n'
            '"0.1","0.2","6"\n'
        ),
        "mm N",
    ),
    "Zwick": (
        (
            "Prüfdatum;12.11.2020\n"
            "Vorkraft;0,5;N\n"
            "Prüfgeschwindigkeit;10;mm/min\n"
            "Prüfzeit;Standardweg;Standardkraft\n"
            "s;mm;N\n"
            "0,0;0,1;5,0\n"
            "0,1;0,2;6,0\n"
        ),
        "mm N",
    ),
    "JPK": (
        (
            "# xPosition: 1.2e-5\n"
            "# k: 0.045 N/m\n"
            "# columns: height vDeflection verticalTipPosition\n"
            "# units: m N m\n"
            "# segment: extend\n"
            "0.1 5 -0.1\n"
            "0.2 6 -0.2\n"
        ),
        "m N",
    ),
    "texture analyser": (
        (
            "Test ID,gel 3\n"
            "Trigger force 5 g 2 s\n"
            "Force (N),Distance (mm),Time (sec)\n"
            "5,0.1,0.0\n"
            "6,0.2,0.005\n"
        ),
        "mm N",
    ),
    "Shimadzu": (
        (
            '"Key Word","Date 2020 11 12"\n'
            '"Speed",1,2\n'
            "Time,Force,Stroke\n"
            "sec,N,mm\n"
            "0,5,0.1\n"
            "0.01,6,0.2\n"
        ),
        "mm N",
    ),
    "KLA": (
        (
            "Run 3 5 7\n"
            "DEPTH\tLOAD\tSTIFFNESS\tMODULUS\n"
            "nm\tmN\tN/m\tGPa\n"
            "0.1\t5\t300\t72\n"
            "0.2\t6\t310\t73\n"
        ),
        "nm mN",
    ),
    "blanks": (
        "Date 2020 11 12\nOperator A B\nMax load: 10 mN\ndepth_nm load_mN\n0.1 5\n0.2 6\n",
        "nm mN",
    ),
    "profilometer": (
        "Profil Nr 7\nDatum;12.11.2020\nTaststrecke Lt;0,8 mm\nX [mm];Z [µm]\n0,0;0,1\n0,2;6\n",
        "mm µm",
    ),
    "AFM section": (
        "Channel: Height\nScan size 500 500 nm\nx\tz\nnm\tnm\n0.1\t5\n0.2\t6\n",
        "nm nm",
    ),
    "French": (
        (
            "Essai n° 4\n"
            "Date\t12/11/2020\n"
            "Charge max.\t500 mN\n"
            "Enfoncement (µm)\tCharge (mN)\n"
            "0,1\t5\n"
            "0,2\t6\n"
        ),
        "µm mN",
    ),
}


@pytest.mark.parametrize("maker", FILES)
def test_measurement_data_above_a_table_are_no_rows_and_no_names(maker: str) -> None:
    text, units = FILES[maker]
    kind = PROFILE if maker in {"profilometer", "AFM section"} else CURVE
    table = parse(text.encode(), kind)
    assert [(table.titles[i].unit or ("", ""))[1] for (i,) in table.taken.values()] == units.split()
    assert [values[-1] for values in table.values] == [0.2, 6.0]
    assert table.lines[-1] == text.count("\n")


def test_first_point_with_whole_numbers_is_not_lost() -> None:
    table = parse(b"d;F\n0;0,5\n1;1\n", CURVE)
    assert np.array_equal(table.values, [[0.0, 1.0], [0.5, 1.0]])


@pytest.mark.parametrize(
    ("text", "kind", "detail"),
    [
        ("0 0\n10 30\n20 90", CURVE, "name the depth d and the force F .* d .nm.;F .mN."),
        ("0 0\n10 3000\n20 12000", PROFILE, "rises 600 times as much as the first"),
        ("h A\n0 0\n10 3000", PROFILE, None),
        ("0 0\n10 1\n20 4", PROFILE, None),
    ],
)
def test_columns_without_names_are_asked_for(
    text: str, kind: tuple[str, str], detail: str | None
) -> None:
    if detail is None:
        assert parse(text.encode(), kind).values[1][0] == 0
        return
    with pytest.raises(InputError, match=f"Line 1: .*{detail}"):
        parse(text.encode(), kind)


def test_file_of_four_megabytes_takes_linear_time() -> None:
    rows = [f"{i * 1e-6:.6e},{i * i * 1e-12:.6e}\n" for i in range(150_000)]

    def seconds(count: int) -> float:
        text = "".join(["d [m],F [N]\n", *rows[:count]]).encode()
        begin = process_time()
        assert len(parse(text, CURVE).lines) == count
        return process_time() - begin

    assert seconds(150_000) < 30 * min(seconds(15_000) for _ in range(3))


def test_many_lines_of_text_take_little_more_time_than_the_most_that_are_searched() -> None:
    def seconds(count: int) -> float:
        text = "".join(f"# event {i}; d\n" for i in range(count))
        begin = process_time()
        found = parse(f"{text}d [m];F [N]\n1;2\n{text}2;3\n".encode(), CURVE)
        assert found.values[1].tolist() == [2, 3]
        return process_time() - begin

    # Without a limit the ratio is 10.
    assert seconds(90_000) < 5 * min(seconds(9_000) for _ in range(3))


@pytest.mark.parametrize(
    ("heading", "unit"),
    [("Time [s]", 1.0), ("t (ms)", 1e-3), ("Zeit [min]", 60.0), ("Temps/s", 1.0), ("Temps", None)],
)
def test_times_are_in_seconds_and_need_a_unit(heading: str, unit: float | None) -> None:
    rows = "".join(f"{i};{i};{2 * i}\n" for i in range(3))
    table = parse(f"{heading};d [nm];F [mN]\n{rows}".encode(), CURVE)
    assert table.time is None if unit is None else table.time.tolist() == [0.0, unit, 2 * unit]
    falling = f"{heading};d [nm];F [mN]\n{rows}{rows}"
    assert parse(falling.encode(), CURVE).time is None


@pytest.mark.parametrize(
    ("cells", "kinds"),
    [
        (["Load", "Hold", "Unload"], ["loading", "hold", "unloading"]),
        (["Load Segment", "Peak Hold", ""], ["loading", "hold", "hold"]),
        (["Belasten", "Halten", "Entlasten"], ["loading", "hold", "unloading"]),
        (["charge", "maintien", "décharge"], ["loading", "hold", "unloading"]),
        (["extend", "pause", "retract"], ["loading", "hold", "unloading"]),
        (["Load", "Load", "Load"], None),
        (["Load", "?", "Unload"], None),
    ],
)
def test_column_of_segments_names_their_kinds(cells: list[str], kinds: list[str] | None) -> None:
    rows = "".join(f"{i};{2 * i};{cell}\n" for i, cell in enumerate(cells))
    assert parse(f"d [nm];F [mN];Part\n{rows}".encode(), CURVE).segments == kinds


@pytest.mark.parametrize(
    "heading",
    [
        "Tip-Sample Separation [nm];Vertical Deflection [pN]",
        "tipSampleSeparation_nm;vDeflection_pN",
        "Sep (nm);Force (pN)",
        "Separation_nm_Ex;Defl_pN_Ex",
        "Vertical Tip Position (smoothed) [nm];Vertical Deflection [pN]",
        "Tip-surface distance/nm;F/pN",
        "Gap [nm];Normal force [pN]",
    ],
)
def test_separation_is_the_negative_of_the_depth(tmp_path: Path, heading: str) -> None:
    file = tmp_path / "curve.csv"
    file.write_text(f"{heading}\n50;0\n0;0\n-20;7\n", "utf-8")
    curve = read_curve(file)
    assert curve.is_reversed
    assert curve.indentation_depth.tolist() == [-5e-8, 0, 2e-8]
    assert curve.normal_force.tolist() == [0, 0, 7e-12]


@pytest.mark.parametrize(
    "heading",
    [
        "Height (measured) [nm];Vertical Deflection [pN]",
        "Head Height (measured & smoothed);Vertical Deflection [pN]",
        "smoothedStrainGaugeHeight [nm];vDeflection [pN]",
        "Calc_Ramp_Ex_nm;Defl_pN_Ex",
        "Height_Sensor_nm_Ex;Defl_pN_Ex",
        "Defl_nm_Ex;Defl_pN_Ex",
        "ZSnsr (nm);Force (pN)",
        "Piezo (nm);Load (pN)",
        "Z Scan (nm);Force (pN)",
        "Position [nm];Deflection [pN]",
        "Z Position;Deflection [pN]",
    ],
)
def test_position_of_a_cantilever_is_no_depth_unless_it_is_chosen(heading: str) -> None:
    # A cantilever of 0.1 N/m that presses with 10 nN bends by 100 nm.
    rows = "0;0\n10;5\n20;12\n"
    with pytest.raises(InputError, match="Line 2: column 1 is a position or a deflection of"):
        parse(f"{heading}\n{rows}".encode(), CURVE)
    chosen = parse(f"{heading}\n{rows}".encode(), CURVE, [1, 2])
    assert chosen.values[0].tolist() == [0, 10, 20]
    named = f"d [nm];{heading.partition(';')[2]}\n{rows}"
    assert np.array_equal(parse(named.encode(), CURVE).values, [[0, 10, 20], [0, 5, 12]])


def test_columns_of_approach_and_retraction_are_two_segments(tmp_path: Path) -> None:
    names = "Height_Sensor_nm_Ex Height_Sensor_nm_Rt Separation_nm_Rt Separation_nm_Ex"
    file = tmp_path / "curve.txt"
    file.write_text(f"{names} Defl_pN_Ex Defl_pN_Rt\n0 8 -3 5 0 9\n8 0 4 -2 9 1\n", "utf-8")
    curve = read_curve(file)
    assert curve.indentation_depth.tolist() == [-5e-9, 2e-9, 3e-9, -4e-9]
    assert curve.normal_force.tolist() == [0, 9e-12, 9e-12, 1e-12]
    assert curve.segments == ["loading", "loading", "unloading", "unloading"]
    assert curve.time is None
    # Of a force on both branches the depth of one leaves the other open.
    file.write_text("d_nm_Ex Defl_pN_Ex Defl_pN_Rt\n0 0 9\n8 9 1\n", "utf-8")
    with pytest.raises(InputError, match="Defl Ex and Defl Rt may each be the force"):
        read_curve(file)


def test_segments_named_in_comments_are_those_of_the_rows_beneath(tmp_path: Path) -> None:
    columns = "# columns: tipSampleSeparation vDeflection seriesTime time\n# units: m N s s\n"
    parts = {"extend": "5 0 1 1\n-2 9 2 2\n", "pause": "-3 9 3 1\n", "retract": "4 1 4 1\n"}
    text = "\n".join(f"#\n# segment: {name}\n{columns}#\n{parts[name]}" for name in parts)
    file = tmp_path / "curve.txt"
    file.write_text(f"# TEXT EXPORT\n{text}", "utf-8")
    curve = read_curve(file)
    assert curve.indentation_depth.tolist() == [-5, 2, 3, -4]
    assert curve.segments == ["loading", "loading", "hold", "unloading"]
    # The time of the series, not that of each segment, which begins anew.
    assert curve.time is not None
    assert curve.time.tolist() == [0, 1, 2, 3]


@pytest.mark.parametrize(
    ("heading", "taken"),
    [
        ("Raw Displacement;Raw Load;Displacement Into Surface;Load On Sample", (2, 3)),
        ("Displacement;Load;Displacement Into Surface;Load On Sample", (2, 3)),
        ("RAW DEPTH;RAW LOAD;DEPTH;LOAD", (2, 3)),
        ("Lateral force [N];Piezo [nm];Indentation [nm];Fz [N]", (2, 3)),
        ("Lateral Deflection [N];Height [m];Tip Position [m];Vertical Deflection [N]", (2, 3)),
        ("Fx, N;Position (x), mm;Position (z), mm;Fz, N", (2, 3)),
        ("Sep (m);ZSnsr (m);Ind (m);Force (N)", (2, 3)),
        ("X [µm];Fx [N];Z [µm];Fz [N]", (2, 3)),
        ("Position [µm];Tangential force [N];Depth [nm];Normal force [N]", (2, 3)),
        ("Weg [µm];Kraft [N];Eindringtiefe [nm];Normalkraft [N]", (2, 3)),
        ("Position [µm];Force [N];Profondeur [nm];Force normale [N]", (2, 3)),
        ("Lateral displacement [µm];Friction force [N];Depth [nm];Load [N]", (2, 3)),
        ("Travel [mm];Force [N];Pd [nm];Normal load [N]", (2, 3)),
    ],
)
def test_corrected_columns_have_priority_over_raw_and_lateral_ones(
    heading: str, taken: tuple[int, int]
) -> None:
    table = parse(f"{heading}\n1;2;3;4\n2;3;4;5\n".encode(), CURVE)
    assert table.taken == {"depth": [taken[0]], "force": [taken[1]]}
