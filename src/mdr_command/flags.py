"""Requests of numbers as options, such as ``--kind paraboloid --radius 0.01``.

The options are the query parameters of the service, with hyphens in place of underscores.
"""

import argparse
from typing import Final

from pydantic import ValidationError

from mdr_service import problems
from mdr_service.query_parameters import PARAMETERS, Parameters

_PREFIX: Final = "parameter:"


def declare(parser: argparse.ArgumentParser, command: str) -> None:
    """Declare an option for every parameter of a query, none for queries that take JSON only."""
    if command not in PARAMETERS:
        return
    group = parser.add_argument_group("request by options, in place of a file")
    for name, field in PARAMETERS[command].model_fields.items():
        if name not in {"format", "size"}:
            group.add_argument(
                f"--{name.replace('_', '-')}",
                dest=_PREFIX + name,
                default=argparse.SUPPRESS,
                metavar="TEXT" if name in {"kind", "scale", "answers", "quantities"} else "NUMBER",
                help=(field.description or "").replace("%", "%%"),
            )


def parameters(arguments: argparse.Namespace) -> Parameters | None:
    """Return the parameters that are given as options, None if there are none.

    Raises
    ------
    ServiceError : an option is invalid.
    """
    given = {
        name.removeprefix(_PREFIX): value
        for name, value in vars(arguments).items()
        if name.startswith(_PREFIX)
    }
    if not given:
        return None
    try:
        return PARAMETERS[arguments.command].model_validate(given)
    except ValidationError as error:
        raise problems.from_validation(error) from None
