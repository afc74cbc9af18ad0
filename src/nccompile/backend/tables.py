"""Set positions as tables: CSV for people and spreadsheets, npz for programs.

    t [s], one column an axis [mm or deg], v: path velocity over the last cycle [mm/s], line: source line,
    status: SMC_INT_STATUS (SoftMotion §6.2.8), switches: the switch word

Positions are written with all their digits: reading a table gives the same bits.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from io import TextIOWrapper
from pathlib import Path
from typing import TextIO

import numpy as np

from nccompile.backend.files import replacing
from nccompile.backend.npz import write_npz
from nccompile.backend.samples import SampleBlock

__all__ = ["write_samples", "write_samples_csv"]


def write_samples_csv(out: TextIO, axes: Sequence[str], blocks: Iterable[SampleBlock]) -> int:
    """Writes samples as CSV as they come; returns the number of rows."""
    out.write(",".join(["t", *axes, "v", "line", "status", "switches"]) + "\n")
    rows = 0
    for block in blocks:
        columns = [[f"{t:.6f}" for t in block.t.tolist()]]
        columns += [[repr(x) for x in axis] for axis in block.position.T.tolist()]
        columns += [[repr(v) for v in block.velocity.tolist()]]
        columns += [[str(n) for n in c.tolist()] for c in (block.line, block.status, block.switches)]
        out.write("".join(",".join(row) + "\n" for row in zip(*columns, strict=True)))
        rows += len(block.t)
    return rows


def write_samples(path: Path, axes: Sequence[str], blocks: Iterable[SampleBlock]) -> int:
    """Writes samples to a file, `.npz` (held in memory until the end) or CSV; returns the number of rows.

    Raises: UsageError: the file cannot be written; it is whole or not there.
    """
    with replacing(path) as (file, commit):
        if path.suffix.lower() == ".npz":
            rows = _write_npz(file, axes, blocks)
        else:
            text = TextIOWrapper(file, encoding="ascii", newline="\n")
            rows = write_samples_csv(text, axes, blocks)
            text.flush()
            text.detach()
        commit()
    return rows


def _write_npz(file: object, axes: Sequence[str], blocks: Iterable[SampleBlock]) -> int:
    held = list(blocks)
    none = np.zeros(0)
    t = np.concatenate([none, *(b.t for b in held)])
    position = np.concatenate([np.zeros((0, len(axes))), *(b.position for b in held)])
    write_npz(
        file,
        {
            "t": t,
            **{axis: np.ascontiguousarray(position[:, i]) for i, axis in enumerate(axes)},
            "v": np.concatenate([none, *(b.velocity for b in held)]),
            "line": np.concatenate([none.astype(np.int32), *(b.line for b in held)]),
            "status": np.concatenate([none.astype(np.uint8), *(b.status for b in held)]),
            "switches": np.concatenate([none.astype(np.uint32), *(b.switches for b in held)]),
        },
    )
    return len(t)
