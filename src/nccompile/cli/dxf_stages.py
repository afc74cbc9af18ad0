"""The stages of a program or queue that `nccompile export-dxf` draws."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from nccompile.cli.inputs import ProgramOptions, finish, machine_of, read_program
from nccompile.cli.options import Report
from nccompile.cli.queues import is_queue, read_queue
from nccompile.errors import UsageError
from nccompile.toolchain import Compilation
from nccompile.toolpath import Toolpath

__all__ = ["stages"]

PASSES = "_PASSES"


def stages(
    path: Path, machine: Path | None, settings: dict[str, Any], form: Report
) -> Iterator[tuple[str, Iterable[Toolpath]]]:
    """Layer suffix and toolpath of every stage.

    A queue has one.  A program has the toolpath as programmed and, if passes are asked for, as they leave it.
    Args: settings: options of the program by name, as `ProgramOptions` has them.
    """
    chosen = ProgramOptions(**settings)
    if is_queue(path):
        if chosen.given:
            raise UsageError(f"{path} is an OutQueue: {', '.join(chosen.given)} acts on programs only")
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
