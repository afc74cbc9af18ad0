"""What a run did, as a table that fits on a screen."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence

import typer

from nccompile.cli.options import Report
from nccompile.diagnostics import render, to_json
from nccompile.runtime.report import AxisReport, RunReport

__all__ = ["finish_run", "report_lines"]

SHOWN = 6
"""Events of a kind that the table lists; all of them are in the JSON report and the trace."""

_HEADING = (
    f"{'axis':<4} {'peak velocity':>17} {'of limit':>8} {'peak acceleration':>22} {'of limit':>8} "
    f"{'following error':>16} {'end position':>16}"
)


def report_lines(result: RunReport) -> Iterator[str]:
    """The lines of the table."""
    yield (
        f"{result.machine}: {result.outcome} after {result.job_time:.3f} s, "
        f"{result.cycles} cycles of {result.cycle * 1e6:.0f} us"
    )
    if result.axes:
        yield _HEADING
    for axis in result.axes:
        yield _axis_line(axis)
    switches = result.switches
    yield from _events(
        "switches", switches.count, [f"H{s.number:+d} at {s.time:.3f} s" for s in switches.entries[:SHOWN]]
    )
    waits = result.m_functions
    yield from _events(
        "M functions",
        waits.count,
        [f"M{m.number} at {m.time:.3f} s, {m.waited:.3f} s" for m in waits.entries[:SHOWN]],
    )
    for fault in result.faults[:SHOWN]:
        yield (
            f"fault: axis {fault.axis} at {fault.time:.3f} s, line {fault.line}: {fault.code} "
            f"{fault.value:g}, limit {fault.limit:g}"
        )
    if result.jitter is not None:
        j = result.jitter
        yield (
            f"jitter: mean {j.mean_us:.1f} us, median {j.p50_us:.0f}, 99 % {j.p99_us:.0f}, "
            f"worst {j.max_us:.0f} in cycle {j.worst_cycle}; {j.overruns} overruns"
        )
    end = " ".join(f"{axis}{value:.6f}" for axis, value in result.end_position.items())
    yield f"path position at the end: {end}"


def finish_run(result: RunReport, form: Report) -> None:
    """Writes the findings of a run; exit code 1 if it ended on a fault or has errors."""
    found = list(result.diagnostics)
    if form is Report.JSON:
        print(to_json(found), file=sys.stderr)
    else:
        for diagnostic in found[:SHOWN]:
            print(render(diagnostic), file=sys.stderr)
    if result.outcome == "fault" or result.diagnostics.errors:
        raise typer.Exit(1)


def _axis_line(axis: AxisReport) -> str:
    unit = axis.unit
    return (
        f"{axis.axis:<4} {f'{axis.peak_velocity:.3f} {unit}/s':>17} {axis.velocity_ratio:>8.1%} "
        f"{f'{axis.peak_acceleration:.1f} {unit}/s2':>22} {axis.acceleration_ratio:>8.1%} "
        f"{f'{axis.max_following_error:.4f} {unit}':>16} {f'{axis.end_position:.4f} {unit}':>16}"
    )


def _events(name: str, count: int, texts: Sequence[str]) -> Iterator[str]:
    if count:
        more = f", {count - len(texts)} more" if count > len(texts) else ""
        yield f"{name}: {count} ({'; '.join(texts)}{more})"
