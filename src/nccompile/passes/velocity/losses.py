"""Where the time of a job goes: what it would take at the programmed feed, and what limits cost on top.

    job time = time at feed + lost to limits + lost to corners + waits

    limits     a segment cannot run at its feed: an axis's velocity, or the bend of a curve
    corners    ramps up and down: stops, sharp bends, changes of the feed, short segments between them
    waits      dwells

Of the time at feed, `feed` says how much is due to the program's F: what segments would save at the velocity that
machine and geometry allow.  Rapids count with the velocity that they are given.  All numbers are seconds at override 1.
"""

from __future__ import annotations

import heapq
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from nccompile.passes.velocity.planner import row_times
from nccompile.passes.velocity.settings import PlanSettings
from nccompile.toolpath.columns import Floats, Kind, Toolpath

__all__ = ["CURVES", "Losses", "Place"]

CURVES = "curves"
"""What is named in place of an axis where the bend of a curve limits the velocity."""

_PLACES = 10
_LEAST = 1e-6  # seconds: less is no place


@dataclass(frozen=True, order=True)
class Place:
    """A source line and the time it loses [s]; cause: "corners", an axis letter or `CURVES`."""

    lost: float
    line: int
    cause: str


@dataclass
class Losses:
    """Adds up planned chunks on their way.

    at_feed, feed, corners, waits [s];  limits: seconds by axis letter or `CURVES`;
    places: the slowest ones.
    """

    settings: PlanSettings
    at_feed: float = 0.0
    feed: float = 0.0
    corners: float = 0.0
    waits: float = 0.0
    limits: dict[str, float] = field(default_factory=dict)
    places: list[Place] = field(default_factory=list)

    @property
    def job_time(self) -> float:
        """All of it [s]."""
        return self.at_feed + self.corners + self.waits + sum(self.limits.values())

    def add(self, chunk: Toolpath, v_before: float) -> None:
        """Counts a planned chunk; v_before: the end velocity of the one before it [mm/s]."""
        assert chunk.v_limit is not None
        assert chunk.v_end is not None
        time = row_times(chunk, v_before)
        moving = (chunk.length > 0.0) & (chunk.kind < Kind.SET_POSITION)
        self.waits += float(time[~moving].sum())
        if not moving.any():
            return
        length, feed = chunk.length[moving], chunk.feed[moving]
        top = np.minimum(feed, chunk.v_limit[moving])
        by_limit = length / top - length / feed
        by_corner = np.maximum(time[moving] - length / top, 0.0)
        self.at_feed += float((length / feed).sum())
        allowed = np.maximum(top, chunk.v_limit[moving])
        cutting = chunk.kind[moving] != Kind.POSITIONING
        self.feed += float((length / top - length / allowed)[cutting].sum())
        self.corners += float(by_corner.sum())
        names = np.array([*chunk.axes, CURVES])
        axis = self._slowest_axis(chunk)[moving]
        for at in np.unique(axis[by_limit > _LEAST]):
            name = str(names[at])
            self.limits[name] = self.limits.get(name, 0.0) + float(by_limit[axis == at].sum())
        self._rank(chunk.line[moving], by_limit, by_corner, names[axis])

    def _slowest_axis(self, chunk: Toolpath) -> np.ndarray[Any, np.dtype[np.intp]]:
        """Column of the axis that limits the velocity of each row; one more than there are: the curve itself."""
        travel = np.abs(chunk.target - chunk.starts())
        with np.errstate(divide="ignore", invalid="ignore"):
            room: Floats = np.where(travel > 0.0, self.settings.limits.velocity / travel, np.inf)
        slowest: np.ndarray[Any, np.dtype[np.intp]] = np.argmin(room, axis=1)
        slowest[chunk.curve >= 0] = len(chunk.axes)
        return slowest

    def _rank(self, line: Any, by_limit: Floats, by_corner: Floats, axis: Any) -> None:
        """Keeps the lines that lose most; rows of a line that follow each other count together."""
        first = np.flatnonzero(np.append(True, line[1:] != line[:-1]))
        limit, corner = np.add.reduceat(by_limit, first), np.add.reduceat(by_corner, first)
        lost = limit + corner
        for i in np.argsort(-lost, kind="stable")[:_PLACES]:
            if lost[i] > _LEAST:
                cause = "corners" if corner[i] >= limit[i] else str(axis[first[i]])
                self.places.append(Place(float(lost[i]), int(line[first[i]]), cause))
        self.places = heapq.nlargest(_PLACES, self.places)

    def as_dict(self) -> dict[str, Any]:
        """The report as JSON holds it [s]."""
        return {
            "planner": self.settings.planner,
            "job_time": self.job_time,
            "time_at_feed": self.at_feed,
            "of_it_lost_to_feed": self.feed,
            "lost_to_corners": self.corners,
            "lost_to_limits": dict(sorted(self.limits.items())),
            "waits": self.waits,
            "slowest": [{"line": p.line, "lost": p.lost, "cause": p.cause} for p in self.places],
        }
