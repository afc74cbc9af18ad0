"""Random closed contours of lines and arcs for tool radius correction, and distances from them by own formulas."""

from __future__ import annotations

from math import atan, atan2, hypot, pi, sin

import numpy as np
import shapely
from hypothesis import strategies as st

from nccompile.passes.measure import samples
from nccompile.toolpath.columns import Floats, Kind, Toolpath
from tests.passes.paths import Sketch

__all__ = ["closed_contours", "distances", "feed_points", "outline"]


@st.composite
def closed_contours(draw: st.DrawFn, *, low: float = 6.0, most: int = 10, arcs: bool = True) -> Toolpath:
    """A contour around the origin, counter-clockwise, of lines and arcs; it may cross itself where arcs bulge."""
    n = draw(st.integers(3, most))
    turn = [2 * pi * (i + draw(st.floats(0.0, 0.8))) / n for i in range(n)]
    radii = draw(st.lists(st.floats(low, 30.0), min_size=n, max_size=n))
    points = [(r * np.cos(w), r * np.sin(w)) for r, w in zip(radii, turn, strict=True)]
    sketch = Sketch((*points[0], 0.0, 0.0))
    for i in range(n):
        x, y = points[(i + 1) % n]
        bulge = draw(st.floats(-0.6, 0.6)) if arcs and draw(st.booleans()) else 0.0
        sweep = 4.0 * atan(bulge)
        dx, dy = x - sketch.at[0], y - sketch.at[1]
        if abs(sweep) < 0.05:
            sketch.to(x, y)
            continue
        sketch.heading = atan2(dy, dx) - 0.5 * sweep
        sketch.arc(hypot(dx, dy) / (2.0 * sin(0.5 * abs(sweep))), sweep)
        # Rounding leaves the end off by 1e-15: the contour is to be closed, and the chain to hold.
        sketch.at[:2] = x, y
    return sketch.path()


def feed_points(path: Toolpath, count: int = 60) -> Floats:
    """Dense samples of the feed rows in X-Y, in order, and where the last one ends."""
    points, owner, _ = samples(path, np.full(len(path), count))
    feed = np.flatnonzero(path.kind != Kind.POSITIONING)
    flat: Floats = np.vstack([points[np.isin(owner, feed)][:, :2], path.target[feed[-1:], :2]])
    return flat


def distances(points: Floats, path: Toolpath) -> Floats:
    """Distance [mm] of each point from the lines and arcs of a path, by the formulas of the textbook. Shape (m,)."""
    best = np.full(len(points), np.inf)
    starts = path.starts()
    for i in range(len(path)):
        a, b = starts[i, :2], path.target[i, :2]
        best = np.minimum(best, np.hypot(*(points - a).T))
        best = np.minimum(best, np.hypot(*(points - b).T))
        if path.kind[i] == Kind.ARC:
            cx, cy, r, start, sweep = path.curves.parameters[path.curve[i], :5]
            way = (np.arctan2(points[:, 1] - cy, points[:, 0] - cx) - start) * np.sign(sweep)
            on = np.mod(way, 2 * pi) <= abs(sweep)
            off = np.abs(np.hypot(points[:, 0] - cx, points[:, 1] - cy) - r)
        else:
            step = b - a
            t = ((points - a) @ step) / (step @ step)
            on = (t >= 0.0) & (t <= 1.0)
            off = np.abs((points - a) @ np.array([-step[1], step[0]])) / np.hypot(*step)
        best = np.where(on, np.minimum(best, off), best)
    return best


def outline(path: Toolpath, count: int = 300) -> shapely.LinearRing:
    """A closed contour as a ring of chords."""
    return shapely.LinearRing(samples(path, np.full(len(path), count))[0][:, :2])
