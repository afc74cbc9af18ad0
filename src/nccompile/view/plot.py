"""Pictures of a path and of its dynamics, drawn with matplotlib without a display.

+-----------------+--------------+      XY: rapids green, feed blue, switch points and M functions with
| XY              | path velocity|          their numbers, start and end
|                 +--------------+      isometric: only if Z moves
|                 | axes: mm/s   |      right: over time; path velocity under programmed feed and limit, the axes
+-----------------+--------------+          with the machine's limits as dashed lines where they are near
| isometric       | axes: mm/s²  |
|                 +--------------+      The same input gives the same bytes: no dates, no versions.
|                 | axes: mm/s³  |
+-----------------+--------------+
"""

from __future__ import annotations

import io
from collections.abc import Iterable
from math import cos, pi, sin
from pathlib import Path
from typing import Any, Protocol

import matplotlib as mpl
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure, SubFigure

from nccompile.errors import UsageError
from nccompile.toolpath.columns import Floats, Toolpath
from nccompile.view.drawing import Drawing, draw, thin
from nccompile.view.motion import Caps, Motion, envelope

__all__ = ["Limits", "plot_dynamics", "plot_path", "save"]

_RAPID, _FEED, _INK, _GRID = "#2f9e44", "#1c5fb8", "#222222", "#d9dde3"
_SWITCH, _M = "#d9480f", "#7048a8"
_BEFORE = "#c9ced6"
_AXIS_COLORS = ("#c92a2a", "#2f9e44", "#1c5fb8", "#e08700", "#7048a8", "#0b8793", "#a05a2c", "#d6338a",
                "#5c6770", "#80961a", "#3d2c8d")  # fmt: skip
_STYLE: Any = {
    "font.family": "DejaVu Sans", "font.size": 9.0, "axes.titlesize": 10.0, "axes.titleweight": "bold",
    "axes.titlelocation": "left", "axes.edgecolor": "#8a929c", "axes.labelcolor": _INK, "axes.grid": True,
    "axes.axisbelow": True, "axes.spines.top": False, "axes.spines.right": False, "grid.color": _GRID,
    "grid.linewidth": 0.6, "xtick.color": "#555c66", "ytick.color": "#555c66", "legend.frameon": False,
    "agg.path.chunksize": 20000, "svg.hashsalt": "nccompile",
}  # fmt: skip

_DPI = 110
_CELLS = 3000  # polyline points nearer than 1/3000 of the picture are one
_BINS = 1500  # stretches of time in a curve: about one a pixel
_DENSE = 10_000  # points above which thin lines keep the tracks apart
_LABELS = 40  # more labels than this cover the path
_NEAR = 2.0  # a limit is drawn if it is at most this many times the greatest value
_BEYOND = 2.0  # peaks of single cycles above this many times the greatest limit are cut off

_PROJECTION_ANGLE = pi / 6.0


class Limits(Protocol):
    """Limits of the axes, f8 (k,), inf where there is none (`machine.AxisLimits`)."""

    @property
    def velocity(self) -> Floats:
        """Shape (k,) [mm/s or deg/s]."""

    @property
    def acceleration(self) -> Floats:
        """Shape (k,) [mm/s² or deg/s²]."""

    @property
    def jerk(self) -> Floats | None:
        """Shape (k,) [mm/s³ or deg/s³]."""


def plot_path(
    chunks: Iterable[Toolpath], *, title: str = "", before: Iterable[Toolpath] | None = None
) -> Figure:  # fmt: skip
    """A figure of the path alone; before: the path before the path passes, light grey below it."""
    with mpl.rc_context(_STYLE):
        figure = _figure(11.0, 8.0, title)
        _path(figure, draw(chunks), stacked=False, before=None if before is None else draw(before))
    return figure


def plot_dynamics(
    motion: Motion, limits: Limits | None = None, caps: Caps | None = None, *, title: str = ""
) -> Figure:  # fmt: skip
    """A figure of path velocity, and of velocity, acceleration and jerk of the axes over time."""
    with mpl.rc_context(_STYLE):
        figure = _figure(11.0, 10.0, title)
        _dynamics(figure, motion, limits, caps)
    return figure


def save(
    file: Path,
    chunks: Iterable[Toolpath],
    motion: Motion | None = None,
    limits: Limits | None = None,
    caps: Caps | None = None,
    *,
    title: str = "",
    before: Iterable[Toolpath] | None = None,
) -> None:
    """Writes the picture of a path, and of its dynamics if samples are given, as PNG, SVG or PDF.

    before: the path as it was before the path passes, drawn light grey below it.

    Raises:   UsageError: a file name that ends in something else.  OSError: the file cannot be written.
    """
    kind = file.suffix.lower().lstrip(".") or "png"
    stamps = {"png": {"Software": None}, "svg": {"Date": None}, "pdf": {"CreationDate": None}}
    if kind not in stamps:
        raise UsageError(f"{file.name}: pictures are written as png, svg or pdf")
    if motion is None:
        figure = plot_path(chunks, title=title, before=before)
    else:
        with mpl.rc_context(_STYLE):
            figure = _figure(16.0, 9.0, title)
            halves: Any = figure.subfigures(1, 2)
            left, right = halves
            _path(left, draw(chunks), stacked=True, before=None if before is None else draw(before))
            _dynamics(right, motion, limits, caps)
    picture = io.BytesIO()
    with mpl.rc_context(_STYLE):
        figure.savefig(picture, format=kind, dpi=_DPI, metadata=stamps[kind])
    file.write_bytes(picture.getvalue())


def _figure(width: float, height: float, title: str) -> Figure:
    figure = Figure(figsize=(width, height), layout="constrained", facecolor="white")
    FigureCanvasAgg(figure)
    if title:
        figure.suptitle(title, fontsize=12.0, fontweight="bold", color=_INK)
    return figure


def _path(
    figure: Figure | SubFigure, drawing: Drawing, *, stacked: bool, before: Drawing | None = None
) -> None:
    """The XY view, and the isometric one below or beside it if Z moves."""
    low, high = drawing.box()
    solid = high[2] - low[2] > 0.0
    if not solid:
        plane = figure.subplots(1, 1)
    elif stacked:
        plane, iso = figure.subplots(2, 1, height_ratios=(1.5, 1.0))
    else:
        plane, iso = figure.subplots(1, 2, width_ratios=(1.3, 1.0))
    _view(plane, drawing, np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]), labels=True, before=before)
    plane.set(title="Path, X-Y", xlabel="X [mm]", ylabel="Y [mm]")
    if solid:
        c, s = cos(_PROJECTION_ANGLE), sin(_PROJECTION_ANGLE)
        _view(iso, drawing, np.array([[c, -c, 0.0], [s, s, 1.0]]), labels=False, before=before)
        iso.set(title=f"Path, isometric   (Z {low[2]:g} .. {high[2]:g} mm)", xticks=[], yticks=[])
        for spine in iso.spines.values():
            spine.set_visible(False)
        _triad(iso, (c, s))


def _view(
    axes: Any, drawing: Drawing, projection: Floats, *, labels: bool, before: Drawing | None
) -> None:  # fmt: skip
    """The polylines and marks in one projection, Shape (2, 3)."""
    corners = [thin(line @ projection.T, 1e-300) for line in (drawing.rapid, drawing.feed)]
    points = np.vstack([*corners, np.array([drawing.start, drawing.end]) @ projection.T])
    span = float(np.max(np.nanmax(points, axis=0) - np.nanmin(points, axis=0))) or 1.0
    rapid, feed = (thin(line, span / _CELLS) for line in corners)
    if before is not None:
        old = thin(thin(before.feed @ projection.T, 1e-300), span / _CELLS)
        axes.plot(*old.T, color=_BEFORE, linewidth=2.0, label="before passes", zorder=1)
    axes.plot(*rapid.T, color=_RAPID, linewidth=0.9, dashes=(5, 3), label="rapid", zorder=2)
    axes.plot(
        *feed.T,
        color=_FEED,
        linewidth=1.2 if len(feed) < _DENSE else 0.6,
        solid_joinstyle="round",
        label="feed",
        zorder=3,
    )
    for kind, name, color, marker in (
        ("switch", "switch point", _SWITCH, "o"),
        ("m", "M function", _M, "D"),
    ):
        spots = [spot for spot in drawing.spots if spot.kind == kind]
        if spots:
            at = np.array([spot.point for spot in spots]) @ projection.T
            axes.plot(*at.T, marker, color=color, markersize=4.5, label=name, zorder=5)
    start, end = (np.array(point) @ projection.T for point in (drawing.start, drawing.end))
    axes.plot(*start, "o", markersize=8, markerfacecolor="none", color=_INK, label="start", zorder=4)
    axes.plot(*end, "s", markersize=8, markerfacecolor="none", color=_INK, label="end", zorder=4)
    if labels:
        _labels(axes, drawing, projection)
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.09), ncols=6, fontsize=8, columnspacing=1.2)
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.06)


def _labels(axes: Any, drawing: Drawing, projection: Floats) -> None:
    """The numbers of switches and M functions; those at one place in one label, each number once."""
    places: dict[tuple[float, float], list[str]] = {}
    for spot in drawing.spots:
        x, y = np.array(spot.point) @ projection.T
        names = places.setdefault((round(float(x), 6), round(float(y), 6)), [])
        if spot.label not in names:
            names.append(spot.label)
    for place, names in list(places.items())[:_LABELS]:
        text = " ".join(names[:4]) + (" .." if len(names) > 4 else "")
        color = _M if names[0].startswith("M") else _SWITCH
        axes.annotate(
            text, place, xytext=(5, 5), textcoords="offset points", fontsize=7.5, color=color, zorder=6,
            bbox={"boxstyle": "round,pad=0.15", "facecolor": "white", "edgecolor": "none", "alpha": 0.75},
        )  # fmt: skip


def _triad(axes: Any, angle: tuple[float, float]) -> None:
    """The directions of X, Y and Z in the corner of the isometric view."""
    c, s = angle
    for name, (dx, dy) in (("X", (c, s)), ("Y", (-c, s)), ("Z", (0.0, 1.0))):
        axes.annotate(
            name, xy=(40, 8), xytext=(40 + 26 * dx, 8 + 26 * dy), xycoords="axes points",
            textcoords="axes points", fontsize=8, color="#555c66", ha="center", va="center",
            arrowprops={"arrowstyle": "<-", "color": "#8a929c", "linewidth": 0.9, "shrinkA": 5, "shrinkB": 0},
        )  # fmt: skip


def _dynamics(
    figure: Figure | SubFigure, motion: Motion, limits: Limits | None, caps: Caps | None
) -> None:  # fmt: skip
    """Four curves over time, above each other."""
    path, velocity, acceleration, jerk = figure.subplots(4, 1, sharex=True)
    curve = envelope(motion.t, motion.v, _BINS)
    path.fill_between(*curve, color=_FEED, alpha=0.15, linewidth=0)
    path.plot(*curve, color=_FEED, linewidth=1.0, label="velocity", zorder=3)
    path.set(title="Path velocity", ylabel="v [mm/s]")
    top = 1.15 * float(motion.v.max(initial=1e-9))
    if caps is not None:
        top = _caps(path, caps, top)
    path.set_ylim(0.0, top)
    moving = motion.moving()
    rotary = any(motion.axes[i] in "ABC" for i in moving)
    for axes, name, unit, values in (
        (velocity, "velocity", "/s", motion.velocities()),
        (acceleration, "acceleration", "/s²", motion.accelerations()),
        (jerk, "jerk", "/s³", motion.jerks()),
    ):
        _per_axis(axes, motion, values, moving, None if limits is None else getattr(limits, name))
        units = f"mm{unit}, deg{unit}" if rotary else f"mm{unit}"
        axes.set(title=f"Axis {name}", ylabel=f"{name[0]} [{units}]")
    jerk.set(xlabel="time [s]")
    jerk.margins(x=0.01)


def _caps(axes: Any, caps: Caps, top: float) -> float:
    """Programmed feed and limit over the path velocity; returns how far up the picture has to go."""
    for values, color, label in ((caps.feed, "#868e96", "programmed feed"), (caps.limit, "#e03131", "limit")):
        t, y = np.repeat(caps.t, 2)[1:-1], np.repeat(values[1:], 2)
        axes.plot(*envelope(t, y, _BINS), color=color, linewidth=0.9, label=label, zorder=2, alpha=0.9)
    axes.legend(loc="upper left", bbox_to_anchor=(0.2, 1.19), ncols=3, fontsize=8)
    slow = caps.feed[np.isfinite(caps.feed)]
    return min(1.15 * float(slow.max(initial=1e-9)), 2.0 * top) if len(slow) else top


def _per_axis(axes: Any, motion: Motion, values: Floats, moving: list[int], limit: Floats | None) -> None:
    """One curve an axis; its limit as dashed lines if it is near, in the legend always."""
    largest = float(np.nanmax(np.abs(values[:, moving]), initial=0.0)) if moving else 0.0
    highest = 0.0
    for i in moving:
        color = _AXIS_COLORS[i % len(_AXIS_COLORS)]
        label = motion.axes[i]
        if limit is not None and np.isfinite(limit[i]):
            highest = max(highest, float(limit[i]))
            label += f"  (limit ±{limit[i]:g})"
            if limit[i] <= _NEAR * largest:
                for side in (-limit[i], limit[i]):
                    axes.axhline(side, color=color, linewidth=0.9, dashes=(6, 3), alpha=0.7, zorder=1)
        axes.plot(
            *envelope(motion.t, values[:, i], _BINS), color=color, linewidth=0.9, alpha=0.8, label=label
        )
    if moving:
        axes.legend(loc="upper left", bbox_to_anchor=(0.2, 1.19), ncols=min(len(moving), 5), fontsize=8)
    if largest > _BEYOND * highest > 0.0:
        axes.set_ylim(-_BEYOND * highest, _BEYOND * highest)
        axes.annotate(
            f"peaks of single cycles up to {largest:.3g} are cut off", (0.99, 0.04), xycoords="axes fraction",
            ha="right", fontsize=7.5, color="#555c66",
        )  # fmt: skip
