"""`nccompile info`: what an OutQueue holds."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from nccompile.backend.ncq import Meta

__all__ = ["info"]


def info(
    queue: Annotated[Path, typer.Argument(help="The OutQueue (.ncq).")],
    as_json: Annotated[bool, typer.Option("--json", help="meta.json as it stands in the file.")] = False,
) -> None:
    """Print totals, source and machine of an OutQueue; the whole file is checked first."""
    from nccompile.cli.queues import read_queue

    meta = read_queue(queue).meta
    if as_json:
        print(json.dumps(meta.as_dict(), indent=1, ensure_ascii=False))
        return
    print(f"{queue}: OutQueue, written by {meta.producer}")
    for name, value in _rows(meta):
        print(f"  {name:<12} {value}")


def _rows(meta: Meta) -> Iterator[tuple[str, str]]:
    where, totals = meta.provenance, meta.totals
    yield "source", f"{where.source}, sha256 {where.source_sha256[:16]}"
    yield "machine", f"{where.machine}, sha256 {where.machine_sha256[:16]}"
    yield "planning", f"{where.time_law}, angle tolerance {where.angle_tolerance:g} deg"
    yield "segments", f"{totals.segments} in {len(meta.chunks)} chunk{'s' * (len(meta.chunks) != 1)}"
    yield "length", f"{totals.length:.3f} mm, of it rapid {totals.rapid_length:.3f} mm"
    yield "job time", f"{totals.job_time:.3f} s"
    for axis, at in zip(meta.axes, meta.start, strict=True):
        low, high = totals.box[axis]
        yield f"axis {axis}", f"{low:.3f} .. {high:.3f}, starts at {at:.3f}"
    if totals.switches:
        yield "switches", f"{totals.switches} switch points"
    if totals.m_functions:
        yield "M functions", " ".join(f"M{n}" for n in totals.m_functions)
