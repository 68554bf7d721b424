"""What a sweep will cost, and the size of its chunks, before anything is computed."""

from collections.abc import Iterable
from dataclasses import dataclass
from math import log2
from typing import Final

from mdr_sweep.study import Study
from mdr_sweep.tables import ROW_GROUP

# Microseconds a scene on one core, as measured; they set the sizes of chunks, and the estimate.
_CLOSED: Final = 1.0
_SOLVED: Final = 5.0
_HARD: Final = 30.0
_BASE: Final = {
    "cone": _CLOSED,
    "paraboloid": _CLOSED,
    "flat_punch": _CLOSED,
    "truncated_paraboloid": _CLOSED,
    "power": _CLOSED,
    "spherical_tip_cone": _HARD,
    "capped_paraboloid": _HARD,
    # One call a profile.
    "series": 500.0,
    "tabulated": 3000.0,
}
_CLOSED_LOSS: Final = frozenset({"cone", "paraboloid", "flat_punch", "power"})
_LOSS: Final = 50.0
_PEAK: Final = 1500.0
_WEAR: Final = 2500.0
_DEAREST: Final = 5.0
# A chunk takes about this long, so that little is lost with a worker, but no longer than its
# table is handy.
_SECONDS: Final = 1.0
_FEWEST: Final = 64
_MOST: Final = ROW_GROUP
# Bytes of a process that has everything loaded, and of a scene on its way.
PROCESS: Final = 190 * 1024**2
_CELL: Final = 8
_COPIES: Final = 6


@dataclass(frozen=True)
class Plan:
    """How a sweep is cut, and what it is thought to cost."""

    rows: int
    chunk: int
    cost: float
    """Seconds a scene on one core."""
    columns: int
    workers: int

    @property
    def chunks(self) -> int:
        """How many there are."""
        return -(-self.rows // self.chunk)

    @property
    def seconds(self) -> float:
        """All of it, on all workers."""
        return self.rows * self.cost / self.workers

    @property
    def memory(self) -> int:
        """Bytes of all processes on this machine at the most."""
        on_their_way = self.chunk * self.columns * _CELL * _COPIES
        return (self.workers + 1) * PROCESS + self.workers * on_their_way

    @property
    def disk(self) -> int:
        """Bytes of the chunks that are kept, and of the result as long as both are there."""
        return 2 * self.rows * self.columns * _CELL

    @property
    def lines(self) -> Iterable[str]:
        """The plan as it is printed."""
        yield f"scenes   {self.rows:,}"
        yield f"chunks   {self.chunks:,} of {self.chunk:,} scenes"
        yield f"cost     about {_told(self.seconds)} on {self.workers} workers"
        yield f"memory   about {self.memory / 1024**2:,.0f} MiB"
        yield f"disk     at most {self.disk / 1024**2:,.0f} MiB while it runs"


def plan(study: Study, kinds: Iterable[str], rows: int, columns: int, workers: int) -> Plan:
    """Return the plan of a sweep over profiles of some kinds; the dearest one sets the chunks."""
    cost = max((seconds(study, kind) for kind in kinds), default=_CLOSED * 1e-6)
    fitting = 2 ** int(log2(max(_SECONDS / cost, 1.0)))
    return Plan(rows, min(max(fitting, _FEWEST), _MOST), cost, columns, workers)


def seconds(study: Study, kind: str) -> float:
    """Return what a scene with a profile of this kind is thought to take on one core."""
    dearest = _DEAREST if kind in {"spherical_tip_cone", "capped_paraboloid"} else 1.0
    if study.query == "wear":
        return (_WEAR + _BASE.get(kind, _SOLVED)) * dearest * 1e-6
    cost = _BASE.get(kind, _SOLVED)
    if "dissipated_energy" in study.answers and kind not in _CLOSED_LOSS:
        cost += _LOSS * dearest
    if kind != "paraboloid":
        cost += _PEAK * len(study.largest)
    return cost * 1e-6


def _told(length: float) -> str:
    for unit, size in (("days", 86_400), ("hours", 3_600), ("minutes", 60)):
        if length >= 2 * size:
            return f"{length / size:.1f} {unit}"
    return f"{length:.1f} seconds"
