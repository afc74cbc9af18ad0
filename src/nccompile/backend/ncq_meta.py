"""`meta.json` of an OutQueue file: what the file holds, where it came from, and its totals.

{"format": "nccompile-outqueue", "version": 1, "producer": "nccompile 0.1.0",
 "axes": ["X", "Y", "Z"], "units": {...}, "start": {"X": 0.0, ...},
 "source": {"name": ..., "sha256": ...}, "machine": {"name": ..., "sha256": ...},
 "planning": {"angle_tolerance": 0.1, "time_law": "trapezoid", "third_order": true if so},
 "totals": {"segments": ..., "length": ..., "rapid_length": ..., "job_time": ..., "box": ...,
            "switches": ..., "m_functions": [...]},
 "names": [...], "chunks": [[segments, curves, events], ...]}
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from math import isfinite
from typing import Any

from nccompile.backend.ncq_layout import Counts
from nccompile.backend.totals import Totals
from nccompile.errors import QueueError
from nccompile.kernels.timelaw import LAW_NAMES
from nccompile.toolpath import AXIS_LETTERS
from nccompile.version import VERSION

__all__ = ["FORMAT", "FORMAT_VERSION", "Meta", "Provenance"]

FORMAT = "nccompile-outqueue"
FORMAT_VERSION = 1
UNITS = {"length": "mm", "rotary": "deg", "velocity": "mm/s", "acceleration": "mm/s2", "time": "s"}

_GREATEST_ROW_COUNT = 2**31 - 1


@dataclass(frozen=True, slots=True)
class Provenance:
    """Where a queue came from and how it was planned.

    source, machine: names without folders, so that equal inputs give equal bytes wherever they lie;
    the SHA-256 are those of the program's bytes and of the machine's canonical JSON;
    angle_tolerance [deg]; time_law: one of `LAW_NAMES`.
    """

    source: str
    source_sha256: str
    machine: str
    machine_sha256: str
    angle_tolerance: float
    time_law: str


@dataclass(frozen=True, slots=True)
class Meta:
    """The description of an OutQueue; `start` [mm or deg] has one value an axis.

    third_order: its chunks have the columns a_end and jerk.
    """

    axes: tuple[str, ...]
    start: tuple[float, ...]
    provenance: Provenance
    totals: Totals
    names: tuple[str, ...]
    chunks: tuple[Counts, ...]
    third_order: bool = False
    producer: str = f"nccompile {VERSION}"

    def as_dict(self) -> dict[str, Any]:
        """The content of `meta.json`."""
        p = self.provenance
        return {
            "format": FORMAT,
            "version": FORMAT_VERSION,
            "producer": self.producer,
            "axes": list(self.axes),
            "units": UNITS,
            "start": dict(zip(self.axes, self.start, strict=True)),
            "source": {"name": p.source, "sha256": p.source_sha256},
            "machine": {"name": p.machine, "sha256": p.machine_sha256},
            "planning": {"angle_tolerance": p.angle_tolerance, "time_law": p.time_law}
            | ({"third_order": True} if self.third_order else {}),
            "totals": asdict(self.totals),
            "names": list(self.names),
            "chunks": [list(c) for c in self.chunks],
        }

    def to_json(self) -> bytes:
        """UTF-8 bytes of `meta.json`; equal descriptions give equal bytes."""
        return json.dumps(self.as_dict(), ensure_ascii=False, allow_nan=False, indent=1).encode()

    @classmethod
    def from_json(cls, data: bytes) -> Meta:
        """Reads `meta.json`; raises QueueError in one sentence for everything that does not hold."""
        try:
            content = json.loads(data, parse_constant=_refuse_constant)
        except (ValueError, RecursionError) as error:
            raise QueueError("its meta.json is not JSON") from error
        if not isinstance(content, dict) or content.get("format") != FORMAT:
            raise QueueError("it is not an OutQueue: meta.json does not name the format")
        _check_version(content.get("version"))
        try:
            return cls._from_dict(content)
        except (KeyError, TypeError, ValueError, AttributeError, OverflowError) as error:
            raise QueueError(f"its meta.json is not complete or has a wrong value ({error!r})") from error

    @classmethod
    def _from_dict(cls, content: dict[str, Any]) -> Meta:
        axes = tuple(content["axes"])
        if axes[:3] != ("X", "Y", "Z") or list(axes) != sorted(set(axes), key=AXIS_LETTERS.index):
            raise ValueError(f"axes {axes}")
        start = content["start"]
        if tuple(start) != axes or content["units"] != UNITS:
            raise ValueError("start or units do not fit the axes")
        planning = content["planning"]
        if planning["time_law"] not in LAW_NAMES:
            raise ValueError(f"time law {planning['time_law']}")
        source, machine = content["source"], content["machine"]
        return cls(
            axes=axes,
            start=tuple(_number(v) for v in start.values()),
            provenance=Provenance(
                _text(source["name"]), _text(source["sha256"]),
                _text(machine["name"]), _text(machine["sha256"]),
                _number(planning["angle_tolerance"]), planning["time_law"],
            ),
            totals=_totals(content["totals"], axes),
            names=tuple(_text(n) for n in content["names"]),
            chunks=tuple(Counts(*(_count(v) for v in row)) for row in content["chunks"]),
            third_order=_flag(planning.get("third_order", False)),
            producer=_text(content["producer"]),
        )  # fmt: skip


def _check_version(version: object) -> None:
    if not isinstance(version, int) or isinstance(version, bool) or version < 1:
        raise QueueError("its meta.json has no format version")
    if version > FORMAT_VERSION:
        raise QueueError(
            f"it has queue format {version}, this nccompile reads up to {FORMAT_VERSION}: update nccompile"
        )


def _totals(content: dict[str, Any], axes: tuple[str, ...]) -> Totals:
    box = {axis: (_number(low), _number(high)) for axis, (low, high) in content["box"].items()}
    if tuple(box) != axes:
        raise ValueError("the box does not fit the axes")
    return Totals(
        segments=_count(content["segments"]),
        length=_number(content["length"]),
        rapid_length=_number(content["rapid_length"]),
        job_time=_number(content["job_time"]),
        box=box,
        switches=_count(content["switches"]),
        m_functions=tuple(_whole(n) for n in content["m_functions"]),
    )


def _refuse_constant(text: str) -> float:
    raise ValueError(text)


def _number(value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not isfinite(value):
        raise ValueError(f"{value!r} is not a number")
    return float(value)


def _whole(value: object) -> int:
    if isinstance(value, bool) or not isinstance(value, int):
        raise ValueError(f"{value!r} is not a whole number")
    return value


def _flag(value: object) -> bool:
    if not isinstance(value, bool):
        raise ValueError(f"{value!r} is neither true nor false")
    return value


def _count(value: object) -> int:
    whole = _whole(value)
    if not 0 <= whole <= _GREATEST_ROW_COUNT:
        raise ValueError(f"{value!r} is not a count")
    return whole


def _text(value: object) -> str:
    if not isinstance(value, str):
        raise ValueError(f"{value!r} is not text")
    return value
