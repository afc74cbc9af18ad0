"""Time-optimal plans against toppra (Pham and Pham's own package) on stretches of a path that do not stop.

The path is cut where it must stop (positionings, waits, bends above the angle tolerance); each stretch with a
curve in it goes to toppra on a fine grid.  Directions and curvatures are computed here, from the curve table, with
numpy; of the planner only the times of the rows are used.
"""

from __future__ import annotations

import logging
from dataclasses import dataclass, replace
from math import inf, pi, radians
from typing import Any

import numpy as np
from toppra import algorithm
from toppra.constraint import LinearConstraint

from nccompile.machine.limits import AxisLimits
from nccompile.passes.velocity import TIME_OPTIMAL, PlanSettings
from nccompile.passes.velocity.planner import plan, row_times
from nccompile.toolpath.columns import Floats, Kind, Plane, Toolpath

__all__ = ["ACCEL", "BEND", "Comparison", "compare", "equal_limits"]

logging.getLogger("toppra").setLevel(logging.ERROR)

VELOCITY, ACCEL, BEND = 166.667, 1000.0, radians(1.0)
_CONTINUES = 0x8000
_TURN = radians(0.25)  # of a grid interval
_LINE = 100  # grid intervals of a line
_CURVE = 96  # least number of a curve
_LONGEST = 20_000  # grid points that one stretch may have
_PLANES = {Plane.XY: (0, 1), Plane.ZX: (2, 0), Plane.YZ: (1, 2), Plane.SPACE: (0, 1, 2)}
_GAUSS = np.polynomial.legendre.leggauss(8)


def equal_limits(path: Toolpath) -> PlanSettings:
    """166.667 mm/s and 1000 mm/s² for every axis, bends up to 1 degree are passed, nothing else."""
    free = np.full(len(path.axes), inf)
    limits = AxisLimits(np.full(len(path.axes), VELOCITY), np.full(len(path.axes), ACCEL), free, free)
    return PlanSettings(limits, 25.0, 1e6, 1e6, BEND, 1e-3, 0, planner=TIME_OPTIMAL, window=None)


@dataclass
class Comparison:
    """Seconds of the stretches that toppra solved, ours and toppra's; stretches solved and not; grid points."""

    ours: float = 0.0
    best: float = 0.0
    solved: int = 0
    unsolved: int = 0
    points: int = 0
    worst: float = 0.0

    @property
    def excess(self) -> float:
        """Our time over toppra's, less 1."""
        return self.ours / self.best - 1.0 if self.best else 0.0


class _Stretch(LinearConstraint):  # type: ignore[misc]
    """The constraints of a stretch, each interval with its own two ends, and the stretch itself as a path.

    d1, d2: Shape (m, 2, k), q' and q'' at both ends of the intervals; top (m,) [mm/s].
    """

    def __init__(self, s: Floats, d1: Floats, d2: Floats, top: Floats) -> None:
        super().__init__()
        self.s, self.d1, self.d2, self.top = s, d1, d2, top
        self.dof = d1.shape[2]
        self.path_interval = np.array([s[0], s[-1]])
        self.waypoints = None

    def compute_constraint_params(self, path: Any, gridpoints: Floats, *args: Any, **kwargs: Any) -> Any:
        step = np.diff(self.s)[:, None]
        a = np.concatenate([self.d1[:, 0], self.d1[:, 1] + 2.0 * step * self.d2[:, 1]], axis=1)
        b = np.concatenate([self.d2[:, 0], self.d2[:, 1]], axis=1)
        a, b = np.vstack([a, a[-1:]]), np.vstack([b, b[-1:]])
        m = a.shape[1]
        sides = np.vstack([np.eye(m), -np.eye(m)])
        shape = (len(self.s), 2 * m, m)
        with np.errstate(divide="ignore"):
            top = np.minimum(self.top, (VELOCITY / np.abs(self.d1).max(axis=1)).min(axis=1))
        bound = np.minimum(np.append(top, inf), np.append(inf, top)) ** 2
        x = np.column_stack([np.zeros(len(self.s)), bound])
        return (
            a, b, np.zeros_like(a), np.broadcast_to(sides, shape), np.full(shape[:2], ACCEL), None, x,
        )  # fmt: skip

    def __call__(self, position: Any, order: int = 0) -> Floats:
        """toppra asks for the number of degrees of freedom only."""
        return np.zeros((len(np.atleast_1d(position)), self.dof))


def _curve(path: Toolpath, j: int) -> tuple[Floats, Floats, Floats]:
    """Lengths (m,), q' and q'' (m, 2, k) of the intervals of a curved row."""
    kind, p = int(path.kind[j]), path.curves.parameters[path.curve[j]]
    plane = Plane(int(path.curves.plane[path.curve[j]]))
    columns = list(_PLANES[plane])
    coarse = _derivatives(kind, p, np.linspace(0.0, 1.0, 257))[0]
    unit = coarse / np.linalg.norm(coarse, axis=1)[:, None]
    turn = float(np.arccos(np.clip((unit[1:] * unit[:-1]).sum(axis=1), -1.0, 1.0)).sum())
    u = np.linspace(0.0, 1.0, max(_CURVE, int(np.ceil(turn / _TURN))) + 1)
    nodes = (u[:-1, None] + np.diff(u)[:, None] * (0.5 + 0.5 * _GAUSS[0])[None, :]).ravel()
    speed = np.linalg.norm(_derivatives(kind, p, nodes)[0], axis=1).reshape(-1, 8)
    flat = (speed * _GAUSS[1]).sum(axis=1) * 0.5 * np.diff(u)
    first, second = _derivatives(kind, p, u)
    size2 = (first**2).sum(axis=1)[:, None]
    share = flat.sum() / path.length[j]
    k = len(path.axes)
    d1, d2 = np.zeros((len(u), k)), np.zeros((len(u), k))
    d1[:] = (path.target[j] - path.starts()[j]) / path.length[j]
    d1[:, columns] = share * (first / np.sqrt(size2))[:, : len(columns)]
    bend = (second - first * (first * second).sum(axis=1)[:, None] / size2) / size2
    d2[:, columns] = share * share * bend[:, : len(columns)]
    return flat / share, np.stack([d1[:-1], d1[1:]], axis=1), np.stack([d2[:-1], d2[1:]], axis=1)


def _derivatives(kind: int, p: Floats, u: Floats) -> tuple[Floats, Floats]:
    """P' and P'' (m, 3) of a curve row at u."""
    zero = np.zeros_like(u)
    if kind == Kind.POLYNOMIAL:
        c = p.reshape(3, 4)
        first = np.stack([c[i, 1] + u * (2 * c[i, 2] + 3 * c[i, 3] * u) for i in range(3)], axis=1)
        return first, np.stack([2 * c[i, 2] + 6 * c[i, 3] * u for i in range(3)], axis=1)
    main, sub, tilt, begin, sweep = (
        (p[2], p[2], 0.0, p[3], p[4]) if kind == Kind.ARC else (p[2], p[3], p[4], p[5], p[6])
    )
    angle = begin + sweep * u
    x, y = -main * sweep * np.sin(angle), sub * sweep * np.cos(angle)
    x2, y2 = -main * sweep**2 * np.cos(angle), -sub * sweep**2 * np.sin(angle)
    c, s = np.cos(tilt), np.sin(tilt)
    return (
        np.stack([c * x - s * y, s * x + c * y, zero], axis=1),
        np.stack([c * x2 - s * y2, s * x2 + c * y2, zero], axis=1),
    )


def _line(path: Toolpath, j: int) -> tuple[Floats, Floats, Floats]:
    slope = (path.target[j] - path.starts()[j]) / path.length[j]
    d1 = np.broadcast_to(slope, (_LINE, 2, len(slope)))
    return np.full(_LINE, path.length[j] / _LINE), d1, np.zeros_like(d1)


def compare(path: Toolpath, settings: PlanSettings | None = None) -> Comparison:
    """The planner's times and toppra's on the stretches of a path, those with a curve in them."""
    settings = settings or equal_limits(path)
    whole = Toolpath.join(list(plan([path], replace(settings, window=None))))
    row = np.cumsum(np.append(0, (whole.profile[:-1] & _CONTINUES) == 0))
    ours: Floats = np.bincount(row, row_times(whole, 0.0), minlength=len(path)).astype(np.float64)
    out = Comparison()
    stretch: list[int] = []
    ends: Floats | None = None
    grids: list[tuple[Floats, Floats, Floats]] = []
    for j in range(len(path)):
        moves = Kind.LINE <= path.kind[j] <= Kind.POLYNOMIAL
        if moves and path.length[j] <= 0.0:
            continue
        grid = (_curve if path.curve[j] >= 0 else _line)(path, j) if moves else None
        if grid is None or (ends is not None and _angle(ends, grid[1][0, 0]) > BEND):
            _solve(path, stretch, grids, ours, settings, out)
            stretch, grids = [], []
        if grid is not None:
            stretch.append(j)
            grids.append(grid)
        ends = None if grid is None else grid[1][-1, 1]
    _solve(path, stretch, grids, ours, settings, out)
    return out


def _angle(a: Floats, b: Floats) -> float:
    """Between the directions in X, Y, Z [rad]."""
    a, b = a[:3], b[:3]
    size = float(np.linalg.norm(a) * np.linalg.norm(b))
    return float(np.arccos(np.clip(a @ b / size, -1.0, 1.0))) if size else pi


def _finer_ends(step: Floats, d1: Floats, d2: Floats, top: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """The same intervals, the first and the last one in parts that grow by 2 away from the standstill."""
    cuts = np.concatenate([[0.0], 0.5 ** np.arange(16, -1, -1.0)])
    last, m = 1.0 - cuts[::-1], len(step)
    for at, share in ((m - 1, last), (0, cuts)):
        ends = [a[at, 0] + (a[at, 1] - a[at, 0]) * share[:, None] for a in (d1, d2)]
        parts = [np.stack([e[:-1], e[1:]], axis=1) for e in ends]
        d1, d2 = (np.concatenate([a[:at], b, a[at + 1 :]]) for a, b in zip((d1, d2), parts, strict=True))
        step = np.concatenate([step[:at], step[at] * np.diff(share), step[at + 1 :]])
        top = np.concatenate([top[:at], np.full(len(share) - 1, top[at]), top[at + 1 :]])
    return step, d1, d2, top


def _solve(
    path: Toolpath, stretch: list[int], grids: list[tuple[Floats, Floats, Floats]], ours: Floats,
    settings: PlanSettings, out: Comparison,
) -> None:  # fmt: skip
    points = sum(len(grid[0]) for grid in grids)
    if not (path.curve[stretch] >= 0).any() or points > _LONGEST:
        return
    step, d1, d2 = (np.concatenate(part) for part in zip(*grids, strict=True))
    feed = np.where(path.feed[stretch] > 0.0, path.feed[stretch], settings.feed)
    top = np.repeat(feed, [len(grid[0]) for grid in grids])
    step, d1, d2, top = _finer_ends(step, d1, d2, top)
    s = np.append(0.0, np.cumsum(step))
    constraint = _Stretch(s, d1, d2, top)
    solver = algorithm.TOPPRA(
        [constraint], constraint, gridpoints=s, solver_wrapper="seidel", parametrizer="ParametrizeConstAccel"
    )
    v = solver.compute_parameterization(0, 0)[1]
    if v is None or not np.isfinite(v).all() or (v[1:-1] <= 0.0).any():
        out.unsolved += 1
        return
    best = float((2.0 * step / (v[1:] + v[:-1])).sum())
    mine = float(ours[stretch].sum())
    out.ours += mine
    out.best += best
    out.solved += 1
    out.points += points
    if abs(mine / best - 1.0) > abs(out.worst):
        out.worst = mine / best - 1.0
