"""The stages of a program or queue that `nccompile export-dxf` draws."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np

from nccompile.cli.inputs import ProgramOptions, finish, machine_of, read_program
from nccompile.cli.options import Report
from nccompile.cli.queues import is_queue, read_queue
from nccompile.toolchain import Compilation
from nccompile.toolpath import Toolpath

__all__ = ["stages"]

PASSES = "_PASSES"


def stages(
    path: Path, machine: Path | None, settings: tuple[str | None, list[str] | None, bool], form: Report
) -> Iterator[tuple[str, Iterable[Toolpath]]]:
    """Layer suffix and toolpath of every stage worth drawing.

    A queue has one.  A program has the toolpath as programmed and, if the passes changed its geometry, as
    they left it.
    """
    if is_queue(path):
        yield "", read_queue(path).chunks()
        return
    options = ProgramOptions(*settings).resolve(machine_of(machine))
    compilation = Compilation(read_program(path), options)
    decoded = list(compilation.decoded())
    finish(compilation, form)
    yield "", decoded
    planned = list(Compilation(read_program(path), options).planned())
    if not _same_path(Toolpath.join(decoded), Toolpath.join(planned)):
        yield PASSES, planned


def _same_path(a: Toolpath, b: Toolpath) -> bool:
    return (
        np.array_equal(a.kind, b.kind)
        and np.array_equal(a.target, b.target)
        and np.array_equal(a.curves.parameters, b.curves.parameters)
    )
