"""Velocity planning: limits, junctions and look-ahead; the last pass before the queue.

settings    what the planner needs to know of machine, program defaults and options
planner     the pass itself: a window over the chunks
"""

from nccompile.passes.velocity.planner import WINDOW, Planner, plan, row_times
from nccompile.passes.velocity.settings import PlanSettings

__all__ = ["WINDOW", "PlanSettings", "Planner", "plan", "row_times"]
