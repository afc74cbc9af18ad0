"""`nccompile machine check`: is a machine file sound?"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

__all__ = ["check"]


def check(file: Annotated[Path, typer.Argument(help="The machine file (TOML).")]) -> None:
    """Check a machine file and print its axes."""
    from nccompile.cli.queues import refuse_device
    from nccompile.machine.model import load

    refuse_device(file, "a machine file")
    machine = load(file)
    print(f"{file}: {machine.name}, {len(machine.axes)} axes, cycle {machine.cycle_us} us")
    for letter, axis in machine.axes.items():
        travel = f"{axis.low:g} .. {axis.high:g} {axis.unit}"
        print(
            f"  {letter}  {axis.kind:<7} travel {travel:<20} velocity {axis.velocity:g} {axis.unit}/s, "
            f"acceleration {axis.acceleration:g} {axis.unit}/s2"
        )
