"""A toolpath segment as the steps that DIN 66025 has instructions for: lines, arcs and ellipse arcs in XY."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, pi

import numpy as np
import numpy.typing as npt

from nccompile.geometry.biarcs import arcs_of_cubics
from nccompile.geometry.sampling import sample_curves
from nccompile.toolpath import Kind, Plane
from nccompile.toolpath.lengths import PLANE_AXES

__all__ = ["Step", "steps_of"]

Floats = npt.NDArray[np.float64]

WIDE = pi * (1.0 + 1e-9)
FULL = 2 * pi - 1e-12


@dataclass(frozen=True, slots=True)
class Step:
    """One block's motion: G code, target on all axes, and for curves start, centre, sweep [rad] and shape.

    share: its part of the segment's length.
    """

    code: str
    target: Floats
    share: float = 1.0
    start: complex = 0j
    centre: complex = 0j
    sweep: float = 0.0
    direction: float = 0.0
    ratio: float = 1.0


def steps_of(
    kind: int, plane: Plane, row: Floats | None, start: Floats, target: Floats, tolerance: float
) -> list[Step]:
    """The steps of one drive segment.

    Args: row: its row of the curve table, None if straight;  start, target: positions on all axes [mm];
          tolerance: of curves that the language lacks [mm].
    """
    if row is None:
        return [Step("G0" if kind == Kind.POSITIONING else "G1", target)]
    if plane is not Plane.XY:
        return _lines(kind, plane, row, start, target, tolerance)
    if kind == Kind.POLYNOMIAL:
        return _cubic(row, start, target, tolerance)
    centre = complex(row[0], row[1])
    begin = complex(start[0], start[1])
    if kind == Kind.ARC:
        code, sweep = ("G3" if row[4] > 0 else "G2"), float(row[4])
        whole = Step(code, target, 1.0, begin, centre, sweep)
    else:
        code, sweep = ("G9" if row[6] > 0 else "G8"), float(row[6])
        whole = Step(code, target, 1.0, begin, centre, sweep, float(row[4]), float(row[3] / row[2]))
    return [whole] if abs(sweep) <= WIDE or abs(sweep) >= FULL else _halved(kind, row, start, whole)


def _halved(kind: int, row: Floats, start: Floats, whole: Step) -> list[Step]:
    """A step above a half turn as two."""
    point = sample_curves(np.array([kind], np.uint8), row[None, :], np.array([0.5]))[0, 0]
    middle = 0.5 * (start + whole.target)
    middle[0], middle[1] = point[0], point[1]
    parts = []
    for begin, end in ((start, middle), (middle, whole.target)):
        at = complex(begin[0], begin[1])
        parts.append(
            Step(whole.code, end, 0.5, at, whole.centre, 0.5 * whole.sweep, whole.direction, whole.ratio)
        )
    return parts


def _cubic(row: Floats, start: Floats, target: Floats, tolerance: float) -> list[Step]:
    """A cubic as biarcs; the other axes go along in proportion to the length."""
    x, y = row[0:4], row[4:8]
    c = [complex(x[k], y[k]) for k in range(4)]
    points = np.array([[c[0], c[0] + c[1] / 3, c[0] + (2 * c[1] + c[2]) / 3, sum(c)]])
    arcs = arcs_of_cubics(points, tolerance)
    bend = np.where(
        arcs.sweep == 0, 1.0, arcs.sweep / (2 * np.sin(np.where(arcs.sweep == 0, 1.0, arcs.sweep) / 2))
    )
    length = np.abs(arcs.end - arcs.start) * bend
    if not len(length):
        return [Step("G1", target)]
    share = length / length.sum()
    along = np.cumsum(share)
    steps = []
    for i, sweep in enumerate(arcs.sweep.tolist()):
        end = start + (target - start) * along[i]
        end[0], end[1] = arcs.end[i].real, arcs.end[i].imag
        if i == len(share) - 1:
            end = target
        code = "G1" if sweep == 0 else ("G3" if sweep > 0 else "G2")
        steps.append(Step(code, end, float(share[i]), complex(arcs.start[i]), 0j, sweep))
    return steps


def _lines(
    kind: int, plane: Plane, row: Floats, start: Floats, target: Floats, tolerance: float
) -> list[Step]:
    """A curve in another plane, or in space, as lines."""
    kinds, rows = np.array([kind], np.uint8), row[None, :]
    probe = sample_curves(kinds, rows, np.linspace(0.0, 1.0, 65))[0]
    bend = np.abs(np.diff(probe, 2, axis=0)).max(initial=0.0)
    count = max(1, ceil(64 * (bend / (2 * tolerance)) ** 0.5))
    points = sample_curves(kinds, rows, np.linspace(0.0, 1.0, count + 1))[0]
    chord = np.linalg.norm(np.diff(points, axis=0), axis=1)
    share = chord / chord.sum() if chord.sum() > 0 else np.full(count, 1.0 / count)
    along = np.cumsum(share)
    steps = []
    for i in range(count):
        end = start + (target - start) * along[i]
        if plane is Plane.SPACE:
            end[:3] = points[i + 1]
        else:
            u, v = PLANE_AXES[plane]
            end[u], end[v] = points[i + 1, 0], points[i + 1, 1]
        steps.append(Step("G1", target if i == count - 1 else end, float(share[i])))
    return steps
