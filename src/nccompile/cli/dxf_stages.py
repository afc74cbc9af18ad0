"""The stages of a program or queue that `nccompile export-dxf` draws."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

from nccompile.cli.inputs import finish, machine_of, read_program, require_no_options
from nccompile.cli.options import ProgramOptions, Report
from nccompile.cli.queues import is_queue, read_queue
from nccompile.toolchain import Compilation
from nccompile.toolpath import Toolpath

__all__ = ["stages"]

PASSES = "_PASSES"


def stages(
    path: Path, machine: Path | None, chosen: ProgramOptions, form: Report
) -> Iterator[tuple[str, Iterable[Toolpath]]]:
    """Layer suffix and toolpath of every stage.

    A queue has one.  A program has the toolpath as programmed and, if passes are asked for, as they leave it.
    """
    if is_queue(path):
        require_no_options(path, chosen)
        yield "", read_queue(path).chunks()
        return
    source, options = read_program(path), chosen.resolve(machine_of(machine))
    compilation = Compilation(source, options)
    passed = list(compilation.passed())
    finish(compilation, form)
    if not chosen.passes:
        yield "", passed
        return
    yield "", Compilation(source, options).decoded()
    yield PASSES, passed
