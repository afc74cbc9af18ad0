"""Quantities over time from CSV files: an override as of a hand wheel, the way of a workpiece.

time,override      a first line that is no numbers is a heading; times in seconds, rising
0,1
2.5,-0.4
"""

from __future__ import annotations

import csv
from math import isfinite
from pathlib import Path

import numpy as np

from nccompile.errors import UsageError
from nccompile.runtime.interpolator import OVERRIDE_MAX
from nccompile.runtime.schedule import Command
from nccompile.toolpath.columns import Floats

__all__ = ["overrides", "read_profile"]


def read_profile(path: Path) -> tuple[Floats, Floats]:
    """Times [s] and values, Shape (n,), n >= 1.  Raises: UsageError with the line that is wrong."""
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise UsageError(f"{path} cannot be read: {getattr(error, 'strerror', None) or error}") from error
    rows: list[tuple[float, float]] = []
    for number, fields in enumerate(csv.reader(text.splitlines()), 1):
        if not fields:
            continue
        pair = _pair(fields)
        if pair is None and not rows and number == 1:
            continue
        if pair is None:
            raise UsageError(f"{path}:{number}: expected a time in seconds, a comma and a value")
        if rows and pair[0] <= rows[-1][0]:
            raise UsageError(f"{path}:{number}: the times do not rise")
        rows.append(pair)
    if not rows:
        raise UsageError(f"{path} holds no times and values")
    times, values = zip(*rows, strict=True)
    return np.array(times), np.array(values)


def _pair(fields: list[str]) -> tuple[float, float] | None:
    try:
        time, value = (float(field) for field in fields)
    except ValueError:
        return None
    return (time, value) if isfinite(time) and isfinite(value) and time >= 0.0 else None


def overrides(path: Path, least: float) -> list[Command]:
    """The commands of an override profile: every value holds until the next time.

    Raises: UsageError, also for values that are not in least .. OVERRIDE_MAX.
    """
    times, values = read_profile(path)
    if values.min() < least or values.max() > OVERRIDE_MAX:
        raise UsageError(f"{path}: overrides go from {least:g} to {OVERRIDE_MAX:g}")
    return [Command(t, "override", v) for t, v in zip(times.tolist(), values.tolist(), strict=True)]
