"""Planning rules of other controllers as oracles, written from their published descriptions.

Each takes the moves of a path (straight, in X, Y, Z) and gives the job time; nothing is shared with the
planner under test.  Units: mm, s.

klipper   docs/Kinematics.md: trapezoids with one acceleration, corners by the centripetal model, moves taken as
          chords of a circle
grbl      the same corner model with the deviation as a setting, accelerations per axis along each line
least     a lower bound for axes that keep acceleration and tolerance, whatever the rule
linuxcnc  arcs that blend corners inside a path tolerance, half of the shorter move at most, 200 moves ahead
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, inf, sin, sqrt

import numpy as np
import numpy.typing as npt

from nccompile.toolpath.columns import Kind, Toolpath

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Moves:
    """Straight moves: step (n, 3) [mm], feed (n,) [mm/s], rapid (n,)."""

    step: Floats
    feed: Floats
    rapid: npt.NDArray[np.bool_]

    @property
    def length(self) -> Floats:
        out: Floats = np.sqrt((self.step**2).sum(axis=1))
        return out

    @property
    def direction(self) -> Floats:
        out: Floats = self.step / self.length[:, None]
        return out

    @property
    def time_at_feed(self) -> float:
        return float((self.length / self.feed).sum())

    def toolpath(self) -> Toolpath:
        n = len(self.feed)
        empty = Toolpath.empty()
        return empty.replace(
            kind=np.where(self.rapid, Kind.POSITIONING, Kind.LINE).astype(np.uint8),
            target=np.cumsum(self.step, axis=0), curve=np.full(n, -1, np.int32), length=self.length,
            feed=self.feed, accel=np.zeros(n), decel=np.zeros(n), radius=np.zeros(n),
            mark=np.zeros(n, np.uint16), profile=np.zeros(n, np.uint16), line=np.arange(1, n + 1, dtype=np.int32),
        )  # fmt: skip

    @classmethod
    def of(cls, path: Toolpath, rapid: float) -> Moves:
        """The moves of a path of lines and positionings; rapids at a velocity of their own."""
        step = (path.target - path.starts())[:, :3]
        keep = (path.kind <= Kind.LINE) & (path.length > 0.0)
        is_rapid = path.kind[keep] == Kind.POSITIONING
        return cls(step[keep], np.where(is_rapid, rapid, path.feed[keep]), is_rapid)


def trapezoids(moves: Moves, accel: Floats, corner: Floats) -> float:
    """Job time with the corner velocities' squares (n - 1,) as caps: one pass back, one forth."""
    length, top = moves.length, moves.feed
    v2 = np.zeros(len(length) + 1)
    v2[1:-1] = np.minimum(corner, np.minimum(top[1:], top[:-1]) ** 2)
    for i in range(len(length) - 1, -1, -1):
        v2[i] = min(v2[i], v2[i + 1] + 2 * accel[i] * length[i])
    for i in range(len(length)):
        v2[i + 1] = min(v2[i + 1], v2[i] + 2 * accel[i] * length[i])
    peak2 = np.minimum(top**2, 0.5 * (v2[:-1] + v2[1:]) + accel * length)
    peak, first, last = np.sqrt(peak2), np.sqrt(v2[:-1]), np.sqrt(v2[1:])
    rest = length - (2 * peak2 - v2[:-1] - v2[1:]) / (2 * accel)
    return float(((2 * peak - first - last) / accel + np.maximum(rest, 0.0) / peak).sum())


def _half_angles(moves: Moves) -> tuple[Floats, Floats]:
    """sin and cos of half the angle between reversed incoming and outgoing direction of every corner."""
    t = moves.direction
    cosine = np.clip((t[1:] * t[:-1]).sum(axis=1), -1.0, 1.0)
    return np.sqrt((1 + cosine) / 2), np.sqrt((1 - cosine) / 2)


def klipper(moves: Moves, accel: float, square_corner: float) -> float:
    """Job time by Klipper's rules; square_corner: velocity at a corner of 90 degrees [mm/s]."""
    deviation = square_corner**2 * (sqrt(2.0) - 1.0) / accel
    sine, other = _half_angles(moves)
    with np.errstate(divide="ignore", invalid="ignore"):
        corner = accel * deviation * sine / (1 - sine)
        chord = 0.5 * np.minimum(moves.length[1:], moves.length[:-1]) * accel * sine / other
        corner = np.minimum(corner, chord)
    corner[sine**2 - other**2 > 0.999999] = inf
    return trapezoids(moves, np.full(len(moves.feed), accel), corner)


def grbl(moves: Moves, accel: float, deviation: float) -> float:
    """Job time by grbl's rules with the same acceleration for every axis."""
    t = moves.direction
    sine, _ = _half_angles(moves)
    across = np.diff(t, axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        across /= np.linalg.norm(across, axis=1)[:, None]
        corner = accel / np.abs(across).max(axis=1) * deviation * sine / (1 - sine)
    corner[np.isnan(corner)] = inf
    return trapezoids(moves, accel / np.abs(t).max(axis=1), corner)


def linuxcnc(moves: Moves, accel: float, tolerance: float, ahead: int = 200) -> float:
    """Job time by LinuxCNC's blend arcs: inside the tolerance, no longer than half of either move."""
    t, length = moves.direction, moves.length
    sine, other = _half_angles(moves)
    along = accel / np.abs(t).max(axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        radius = np.minimum(
            tolerance * sine / (1 - sine), 0.5 * np.minimum(length[1:], length[:-1]) * sine / other
        )
        corner = 0.5 * sqrt(3.0) * accel * radius
    corner[other < 1e-9] = inf
    reach = np.concatenate([[0.0], np.cumsum(2 * along * length)])
    last = np.minimum(np.arange(len(corner)) + 1 + ahead, len(length))
    return trapezoids(moves, along, np.minimum(corner, reach[last] - reach[1:-1]))


def least(moves: Moves, accel: float, tolerance: float) -> float:
    """What no motion can beat that stays within `tolerance` of the path and inside `accel` on every axis.

    Where an axis stands on the next move, or turns back, it comes to rest between the places `tolerance` before and
    behind the corner, so it enters with at most sqrt(2 a 2 d); leaving likewise.  The greater of both counts for
    both sides, all other bends are free, and the 2 d at the corner take no time.  Rules for corners can come out a
    little below it: they let the blend at a corner add to the braking before it.
    """
    t = moves.direction
    before, after = np.abs(t[:-1]), np.abs(t[1:])
    turns = t[:-1] * t[1:] < 0.0
    enter = np.where((before > 1e-9) & ((after <= 1e-9) | turns), before, 0.0).max(axis=1)
    leave = np.where((after > 1e-9) & ((before <= 1e-9) | turns), after, 0.0).max(axis=1)
    long = np.minimum(moves.length[1:], moves.length[:-1]) > 4.0 * tolerance
    bound = (enter > 0.0) & (leave > 0.0) & long
    with np.errstate(divide="ignore"):
        corner = np.where(bound, 4.0 * accel * tolerance / np.minimum(enter, leave) ** 2, inf)
    slower = np.minimum(moves.feed[1:], moves.feed[:-1])
    bound &= corner < slower**2
    time = trapezoids(moves, accel / np.abs(t).max(axis=1), corner)
    return time - float((2.0 * tolerance / slower[bound]).sum())


def finishing(passes: int = 3, seed: int = 1) -> Moves:
    """Finishing passes over a wavy surface in chords of half a millimetre, with links of 0.2 mm and three feeds."""
    rng = np.random.default_rng(seed)
    points, feeds, rapid = [np.array([0.0, 0.0, 10.0])], [], []

    def surface(x: float, y: float) -> float:
        return 6 * sin(x / 24 + 0.3) * cos(y / 33) + 0.6 * sin(x / 4 + y / 5)

    def go(x: float, y: float, z: float, feed: float, by_rapid: bool = False) -> None:
        points.append(np.array([x, y, round(z, 3)]))
        feeds.append(feed)
        rapid.append(by_rapid)

    go(0.0, 0.0, surface(0.0, 0.0) + 2.0, 150.0, True)
    go(0.0, 0.0, surface(0.0, 0.0), 13.0)
    for row in range(passes):
        y, x, end = 0.2 * row, points[-1][0], 100.0 * (1 - row % 2)
        while x != end:
            step = round(float(rng.uniform(0.4, 0.6)), 3)
            x = min(x + step, end) if end else max(x - step, end)
            go(x, y, surface(x, y), (80.0, 60.0, 40.0)[int(x) // 30 % 3])
        go(x, y + 0.2, surface(x, y + 0.2), 30.0)
    return Moves(np.diff(np.array(points), axis=0), np.array(feeds), np.array(rapid))
