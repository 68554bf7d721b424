"""``mdr normal``, ``mdr wear`` and so on: responses of the service, without a server.

The request is a file or, if it consists of numbers, options such as ``--radius 0.01``: the query
parameters of the service, with hyphens in place of underscores. ``--table`` reads the profile from
a file of an instrument.
"""

import argparse
import logging
import re
import sys
from pathlib import Path
from typing import Final

import numpy as np
from pydantic.fields import FieldInfo

from mdr_command import ExitStatus
from mdr_core.errors import InputError
from mdr_core.profiles.tabulated import tip_points
from mdr_core.table_headings import CURVE
from mdr_core.table_reader import MeasuredCurve, Points, metres, read_curve, read_table
from mdr_service import content_negotiation, problems
from mdr_service.dispatch import respond
from mdr_service.problems import ServiceError
from mdr_service.queries.contacts import pointing
from mdr_service.query_parameters import NUMBERS, PARAMETERS, parameters_of
from mdr_service.schemas.fits import FitQuery
from mdr_service.schemas.profiles import OF_NUMBERS
from mdr_service.sentences import NOT_NUMBERS
from mdr_service.serializers import FORMATS
from mdr_service.settings import SETTINGS

_STATUS: Final = {
    problems.INTERNAL: ExitStatus.INTERNAL_ERROR,
    problems.ACCURACY: ExitStatus.ACCURACY_NOT_REACHABLE,
}
_STANDARD_INPUT: Final = "-"
# A fit takes options beside the file of its curve, which a URL does not hold.
_PARAMETERS: Final = PARAMETERS | {"fit": parameters_of(FitQuery)}
# Heights between which an area function describes a tip.
_HEIGHTS: Final = ("largest_height", "lowest_height")
# Help of the options of files, in place of parameters.
_OF_FILES: Final = {
    "table": "CSV file of a measured profile, in place of --kind; it is converted to metres",
    "length_unit": "unit of the table (m, mm, um or nm), where its heading names none; two, as "
    "mm,um, for r and f; and of a tip's area function",
    "area_coefficients": "C0,C1,... of a tip with the area A(h) = C0 h^2 + C1 h + C2 h^(1/2) + "
    "..., in place of --kind",
    "largest_height": "height h up to which the area function describes the tip",
    "lowest_height": "height h from which the area function is valid (default: 0); below, the tip "
    "is continued smoothly",
    "curve_units": "DEPTH,FORCE: units of the curve in FILE, such as nm,uN, where its headings "
    "name none; a curve is converted to metres and newtons, the units of the other options",
}
# Options beside the parameters of the request.
_OTHER_OPTIONS: Final = frozenset({"output", "size", "units", *_OF_FILES})
# Names of parameters that cannot be words of a sentence.
_NAME: Final = re.compile(r"\w+_\w+")
_ONCE: Final = (
    "is given more than once; several loads are a list such as 1.0,2.0, or a range (--help)"
)
_REQUEST: Final = "a request is a JSON object"
_NOT_NUMBERS: Final = "a table needs --table, a series a request in JSON"
_BY_OPTIONS: Final = "; give a table with --table, and numbers with options (--help)"

_logger: Final = logging.getLogger(__name__)


def declare(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments: the request, and the format of the response."""
    parser.add_argument(
        "file",
        nargs="?",
        help="request in JSON, as the service accepts it; - for standard input (default)",
    )
    parser.add_argument(
        "--format",
        choices=FORMATS,
        help="format of the response (default: by the suffix of FILE, json without one)",
    )
    parser.add_argument("--size", metavar="WxH", help=content_negotiation.SIZE)
    parser.add_argument("--units", metavar="L,F,P", help=content_negotiation.UNITS)
    parser.add_argument(
        "-o",
        "--output",
        type=Path,
        metavar="FILE",
        help="file for the response (default: standard output)",
    )
    parser.set_defaults(**dict.fromkeys(_OF_FILES))
    if fields := _options(parser.get_default("command")):
        group = parser.add_argument_group("request by options, in place of a file")
        for name, text in _OF_FILES.items():
            if name != "curve_units" or parser.get_default("command") == "fit":
                group.add_argument(_flag(name), help=text)
        # By default -1e-3 counts as an option; argparse has no public way to change that.
        parser._negative_number_matcher = re.compile(r"-\.?\d")  # noqa: SLF001
        for name, field in fields.items():
            group.add_argument(
                _flag(name),
                action="append",
                default=argparse.SUPPRESS,
                metavar="NUMBER" if field.annotation in NUMBERS else "TEXT",
                help=(field.description or "").replace("%", "%%"),
            )
    parser.description = (
        f"{parser.description}\n\nErrors go to standard error, one on a line, with the exit status "
        f"{ExitStatus.INVALID_INPUT},\nor {ExitStatus.ACCURACY_NOT_REACHABLE} if the accuracy "
        "cannot be reached."
    )


def run(arguments: argparse.Namespace) -> int:
    """Write the response and return the exit status."""
    try:
        content = _content(arguments)
    except OSError as error:
        _say(arguments, str(error.filename), str(error.strerror))
        return ExitStatus.INVALID_INPUT
    except problems.FAILURES as error:
        return _report(problems.to_problem(error), arguments)
    except Exception:
        _logger.exception("internal error")
        return _report(problems.INTERNAL_ERROR, arguments)
    try:
        _write(content, arguments.output)
    except OSError as error:
        if not arguments.output:
            raise
        _say(arguments, str(arguments.output), str(error.strerror))
        return ExitStatus.OUTPUT_FAILED
    return ExitStatus.OK


def _content(arguments: argparse.Namespace) -> bytes:
    """Return the response to the request, which a file or options give."""
    name = arguments.command
    suffix = arguments.output.suffix[1:].lower() if arguments.output else ""
    format_ = arguments.format or suffix or "json"
    if format_ not in FORMATS:
        detail = f"no format has the suffix .{suffix}; there are .{', .'.join(FORMATS)}; or give "
        raise InputError(("output",), f"{detail}--format")
    media_type = FORMATS[format_]
    look = content_negotiation.appearance(media_type, arguments.size, arguments.units)
    values = {each: vars(arguments)[each] for each in _options(name) if each in arguments}
    if several := [each for each, found in values.items() if len(found) > 1]:
        raise InputError((several[0],), _ONCE)
    given = {each: found[0] for each, found in values.items()}
    members = _table(arguments, given)
    if not given:
        return respond(name, _read(arguments.file or _STANDARD_INPUT), media_type, look)
    if name == "fit":
        members |= _curve(arguments, given)
    elif arguments.file:
        raise InputError((), "give the request by a file or by options, not both")
    parameters = _PARAMETERS[name].model_validate(given)
    with parameters.pointing():
        return respond(name, parameters.query(members), media_type, look, parameters.members)


def _curve(arguments: argparse.Namespace, given: dict[str, str]) -> dict[str, object]:
    """Return the lists of the curve in a file, in metres, newtons and seconds.

    If the file names the segments, they select the points, except in a fit with `drift`.
    """
    if not arguments.file:
        raise InputError((), "a fit by options needs the file of its curve: mdr fit curve.csv")
    units = (arguments.curve_units or ",").split(",")
    if len(units) != len(CURVE):
        raise InputError(("curve_units",), "gives the units of depth and force, such as nm,uN")
    with pointing({"units": ("curve_units",)}):
        curve = read_curve(arguments.file, [unit or None for unit in units])
    if curve.is_reversed:
        detail = "depths are the separations in the file with their sign reversed"
        _say(arguments, arguments.file, detail)
    used = np.ones(curve.normal_force.size, dtype=bool)
    if curve.segments and "segment" in given and "drift" not in given:
        branches = [kind for kind in dict.fromkeys(curve.segments) if kind != "hold"]
        if (wanted := given.pop("segment")) not in branches:
            detail = f"must be one of the segments in the file: {', '.join(branches)}"
            raise InputError(("segment",), detail)
        used = np.array(curve.segments) == wanted
    lists = zip(MeasuredCurve._fields, curve[:3], strict=False)
    arguments.points = np.flatnonzero(used).tolist()
    return {name: values[used].tolist() for name, values in lists if values is not None}


def _table(arguments: argparse.Namespace, given: dict[str, str]) -> dict[str, object]:
    """Return the profile given by a table or an area function; nothing if neither is given.

    The query parameters then need a placeholder for the kind of profile.
    """
    file, area, unit = arguments.table, arguments.area_coefficients, arguments.length_unit
    if not (file or area):
        if unit:
            raise InputError(("length_unit",), "is valid only with --table or --area-coefficients")
        return {}
    option = "table" if file else "area_coefficients"
    fields = _PARAMETERS[arguments.command].fields
    if replaced := [name for name in given if fields.get(name, "").startswith("profile.")]:
        raise InputError((option,), f"is a profile: leave out {_flag(replaced[0])}")
    given["kind"] = OF_NUMBERS[0]
    if file:
        r, f = read_table(file, unit.split(",") if unit and "," in unit else unit)
    else:
        r, f = _tip(area, [vars(arguments)[name] for name in _HEIGHTS], unit or "m")
    if (count := r.size) > (most := SETTINGS.max_table_points):
        # Choose evenly among the points, as many as a request may have.
        _say(arguments, file, f"{count} points, of which {most} are used")
        chosen = np.argsort(r)[np.linspace(0, count - 1, most).round().astype(int)]
        r, f = r[chosen], f[chosen]
    return {"profile": {"kind": "tabulated", "r": r.tolist(), "f": f.tolist()}}


def _tip(coefficients: str, heights: list[str | None], unit: str) -> Points:
    """Return the points of a tip, in metres, from the coefficients of its area function."""
    try:
        numbers = [float(each) for each in coefficients.split(",")]
        limits = [float(each or 0) for each in heights]
    except ValueError as error:
        detail = "gives numbers with commas between them, with --largest-height"
        raise InputError(("area_coefficients",), detail) from error
    r, f = tip_points(numbers, *limits)
    return Points(metres(unit) * r, metres(unit) * f)


def _options(command: str) -> dict[str, FieldInfo]:
    """Return the parameters that are options; every command has options for a picture."""
    fields = _PARAMETERS[command].model_fields if command in _PARAMETERS else {}
    return {
        name: field
        for name, field in fields.items()
        if name not in content_negotiation.ResponseParameters.model_fields
    }


def _read(file: str) -> bytes:
    most = SETTINGS.max_body_bytes
    if file == _STANDARD_INPUT:
        if sys.stdin.isatty():
            sys.stderr.write("mdr: reading the request from the terminal; end it with Ctrl-D\n")
        content = sys.stdin.buffer.read(most + 1)
    else:
        with Path(file).open("rb") as stream:
            content = stream.read(most + 1)
    if len(content) > most:
        raise InputError((), f"longer than the {most} bytes of MDR_MAX_BODY_BYTES")
    return content


def _write(content: bytes, file: Path | None) -> None:
    if file:
        file.write_bytes(content)
        return
    sys.stdout.buffer.write(content)
    if sys.stdout.isatty() and not content.endswith(b"\n"):
        sys.stdout.buffer.write(b"\n")
    sys.stdout.flush()


def _report(error: ServiceError, arguments: argparse.Namespace) -> int:
    """Print the errors, each with its option or its place in the file; return the exit status."""
    names = _options(arguments.command)
    by_options = any(name in arguments for name in names)
    file = arguments.file or _STANDARD_INPUT
    # Files that hold members of a request by options.
    files: dict[str, str] = {}
    if by_options and arguments.command == "fit":
        files = dict.fromkeys(("table", *MeasuredCurve._fields), file)
    if arguments.table:
        files |= dict.fromkeys(("kind", "profile", "table"), arguments.table)
    for pointer, detail in error.errors or [("", error.detail)]:
        place = pointer[1:].replace("/", ".")
        first, _, rest = place.partition(".")
        parts = ["standard input" if file == _STANDARD_INPUT else file, place, detail]
        if error.type == problems.MALFORMED_JSON:
            parts.append(_REQUEST + (_BY_OPTIONS if names else ""))
        elif arguments.area_coefficients and first in {"kind", "profile"}:
            parts = [_flag(rest if rest in _HEIGHTS else "area_coefficients"), detail]
        elif first in files:
            if first in MeasuredCurve._fields and rest:
                rest = str(arguments.points[int(rest)])
            parts = [files[first], rest, detail]
        elif by_options or place in _OTHER_OPTIONS:
            renamed = _NAME.sub(
                lambda each: _flag(each[0]) if each[0] in names else each[0], detail
            )
            parts = [_flag(place), renamed.replace(NOT_NUMBERS, _NOT_NUMBERS)]
        _say(arguments, *parts)
    return _STATUS.get(error.type, ExitStatus.INVALID_INPUT)


def _flag(name: str) -> str:
    """Return the option of a parameter; empty without a name."""
    return name and f"--{name.replace('_', '-')}"


def _say(arguments: argparse.Namespace, *parts: str) -> None:
    sys.stderr.write(": ".join(filter(None, (f"mdr {arguments.command}", *parts))) + "\n")
