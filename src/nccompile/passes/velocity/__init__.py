"""Velocity planning: limits, junctions and look-ahead; the last pass before the queue.

settings    what the planner needs to know of machine, program defaults and options
planner     the pass itself: a window over the chunks; whoever plans nothing does not load it
"""

from nccompile.passes.velocity.settings import (
    JERK,
    LAWS,
    LOOK_AHEAD,
    PLANNERS,
    SOFTMOTION,
    TIME_OPTIMAL,
    WINDOW,
    PlanSettings,
)

__all__ = [
    "JERK", "LAWS", "LOOK_AHEAD", "PLANNERS", "SOFTMOTION", "TIME_OPTIMAL", "WINDOW", "PlanSettings",
]  # fmt: skip
