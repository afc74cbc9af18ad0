"""All registered passes as the tests of all passes turn them on: for the whole path, with values that act."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import inf, radians

import numpy as np

from nccompile.geometry.frames import rotation
from nccompile.passes.base import Pass
from nccompile.passes.option import parse
from nccompile.toolpath.columns import Floats, Kind, Toolpath
from tests.passes.paths import Probe

__all__ = ["EVERY", "Turned", "dense"]


def _stays(points: Floats) -> Floats:
    return points


@dataclass(frozen=True)
class Turned:
    """A pass turned on.

    spec: as on the command line;  slack: how far [mm] the place of an event may be from where it was, inf: it may lie
    on a part that is cut out;  place: where the pass moves points on purpose, Shape (n, 3);  closed: needs a closed
    contour.
    """

    spec: str
    slack: float = 1e-6
    place: Callable[[Floats], Floats] = _stays
    closed: bool = False

    @property
    def made(self) -> Pass:
        """The pass."""
        (only,) = parse(self.spec).passes
        return only

    def __str__(self) -> str:
        return self.spec


def _turned(points: Floats) -> Floats:
    back = points * [1.0, -1.0, 1.0] - [3.0, 0.0, 0.0]
    return 2.0 * back @ rotation(0.0, 0.0, radians(30.0)).T + [8.0, 0.0, 0.0]


def _tilted(points: Floats) -> Floats:
    return np.asarray(points @ rotation(*(radians(a) for a in (20.0, 30.0, 40.0))).T)


def _sheared(points: Floats) -> Floats:
    return np.asarray(points @ np.array([[1.0, 0.5, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 1.0]]).T)


EVERY = [
    Turned("transform{rotate=30,x=5,scale=2,mirror=y,cx=3}", 1e-6, _turned),
    Turned("transform{roll=20,pitch=30,yaw=40,tolerance=0.01}", 0.03, _tilted),
    Turned("transform{matrix=1 0.5 0; 0 2 0; 0 0 1,tolerance=0.01}", 25.0, _sheared),
    Turned("reverse"),
    Turned("move-start{segment=2}", closed=True),
    Turned("split{segment=1,at=0.3}"),
    Turned("compress"),
    Turned("tool-radius{radius=0.3,everywhere,gouge=warn}", inf),
    Turned("avoid-loops{everywhere}", inf),
    Turned("round-corners{radius=1,everywhere}", 4.0),
    Turned("smooth-corners{distance=1,everywhere}", 4.0),
    Turned("fit-arcs", 0.1),
    Turned("fit-splines", 0.1),
    Turned("flatten{tolerance=0.01,arcs}", 0.03),
    Turned("flatten{length=2,angle=20}", 2.0),
    Turned("limit-arc-feed{accel=100,jump=50,per-radius=20}"),
]


def dense(path: Toolpath, step: float) -> Floats:
    """Points on the moving segments, at most `step` apart. Shape (m, 3)."""
    points = [np.zeros((0, 3))]
    for i in np.flatnonzero((path.kind <= Kind.POLYNOMIAL) & (path.length > 0.0)):
        probe = Probe(path, int(i))
        count = int(np.ceil(probe.length / step)) + 1
        points.append(np.array([probe.point(float(s)) for s in np.linspace(0.0, probe.length, count)]))
    return np.vstack(points)
