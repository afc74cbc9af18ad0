"""Unit conversions; the only module with conversion factors.

Inside everything is mm, s, rad, mm/s, mm/s².  A suffix in a name marks a foreign unit.
"""

from math import degrees, radians

__all__ = ["MICROSECONDS", "deg_from_rad", "rad_from_deg", "seconds_from_us"]

MICROSECONDS = 1e-6
"""One microsecond in seconds."""

rad_from_deg = radians
deg_from_rad = degrees


def seconds_from_us(value_us: float) -> float:
    """Microseconds to seconds."""
    return value_us * MICROSECONDS
