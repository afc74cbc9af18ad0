"""The time law of one segment: ramp, cruise, ramp, in closed form (SoftMotion §6.2.8).

      v
   vp |      ________            ramp 1   t in 0 .. t1          v0 -> vp
      |     /        \\           cruise   t in t1 .. t1+t2      vp
   v1 |    /          \\          ramp 2   t in .. t1+t2+t3      vp -> v1
   v0 |___/
      +---------------------- t

Three laws share the times: a trapezoid ramp changes v linearly, a sigmoid ramp as sin², a parabolic one as
3 x² - 2 x³, whose acceleration is a parabola (SoftMotion §2.1.2).  Every one covers (va + vb) T / 2 from va to vb in
T, so all laws take the same time for the same path; the acceleration of the sigmoid is continuous and peaks at pi/2
times the linear one, that of the parabolic one at 3/2 times.

The offline sampler and the cyclic interpolator evaluate these functions, so they agree to the bit.
Own derivation from s' = v, v' = a.
"""

from __future__ import annotations

from math import pi, sin, sqrt

from nccompile.kernels import kernel

__all__ = [
    "LAW_NAMES",
    "PARABOLIC",
    "SIGMOID",
    "TRAPEZOID",
    "constant_jerk",
    "jerk_distance",
    "jerk_state",
    "jerk_time",
    "jerk_velocity",
    "law_distance",
    "law_state",
    "law_times",
    "law_velocity",
    "peak_factor",
]

TRAPEZOID = 0
SIGMOID = 1
PARABOLIC = 2

LAW_NAMES = ("trapezoid", "sigmoid", "parabolic")
"""The laws by the names that machine file, command line and queue use, in the order of their numbers."""

_PEAKS = (1.0, pi / 2.0, 1.5)

_SLACK = 1e-9
"""Relative rounding room in v² within which a ramp over the whole segment counts as the planned one."""


def peak_factor(law: int) -> float:
    """Greatest acceleration of a ramp over its mean: 1 for the trapezoid, pi/2 for the sigmoid, 3/2 parabolic."""
    return _PEAKS[law]


@kernel
def law_times(
    length: float, v0: float, v_top: float, v_end: float, accel: float, decel: float
) -> tuple[float, float, float, float, float]:
    """Times and velocities (t1, t2, t3, vp, v1) of the fastest law over `length` from v0 to v_end below v_top.

    Peak without cruise:  (vp² - v0²) / 2a + (vp² - v1²) / 2d = L
                          vp² = (2 a d L + d v0² + a v1²) / (a + d)

    What cannot be reached is approached as far as the ramps allow: v1 is the reached end velocity.  If v0 is
    above v_top (an override was lowered) ramp 1 brakes.  length > 0, accel, decel > 0.
    """
    v1 = v_end
    reach = sqrt(v0 * v0 + 2.0 * accel * length)
    v1 = min(v1, reach)
    brake2 = v0 * v0 - 2.0 * decel * length
    if brake2 - v1 * v1 > -_SLACK * v0 * v0:
        # One ramp all along.  Within rounding of the planned ramp the end velocity is kept exactly, so that a
        # planned stop is a stop; beyond it the segment is too short to get that slow.
        if brake2 - v1 * v1 > _SLACK * v0 * v0:
            v1 = sqrt(brake2)
        return 0.0, 0.0, 2.0 * length / (v0 + v1), v0, v1
    if v0 > v_top:
        ramp = (v0 * v0 - v_top * v_top) / (2.0 * decel)
        v1 = min(v1, v_top)
        last = (v_top * v_top - v1 * v1) / (2.0 * decel)
        if ramp + last < length:
            return (v0 - v_top) / decel, (length - ramp - last) / v_top, (v_top - v1) / decel, v_top, v1
        return 0.0, 0.0, 2.0 * length / (v0 + v1), v0, v1
    peak2 = (2.0 * accel * decel * length + decel * v0 * v0 + accel * v1 * v1) / (accel + decel)
    vp = min(v_top, sqrt(peak2))
    vp = max(vp, v0, v1)
    t1 = (vp - v0) / accel
    t3 = (vp - v1) / decel
    rest = length - 0.5 * (v0 + vp) * t1 - 0.5 * (vp + v1) * t3
    t2 = max(rest, 0.0) / vp if vp >= v_top else 0.0
    return t1, t2, t3, vp, v1


@kernel
def _ramp_distance(law: int, t: float, duration: float, va: float, vb: float) -> float:
    """Distance after `t` of a ramp from va to vb that lasts `duration`.

    trapezoid  s = va t + (vb - va) t² / (2 T)
    sigmoid    s = va t + (vb - va) (t / 2 - T / (2 pi) sin(pi t / T))
    parabolic  s = va t + (vb - va) T (x³ - x⁴ / 2),  x = t / T
    """
    if duration <= 0.0:
        return 0.0
    if law == SIGMOID:
        return va * t + (vb - va) * (0.5 * t - duration / (2.0 * pi) * sin(pi * t / duration))
    if law == PARABOLIC:
        x = t / duration
        return va * t + (vb - va) * duration * x * x * x * (1.0 - 0.5 * x)
    return va * t + (vb - va) * t * t / (2.0 * duration)


@kernel
def law_distance(
    law: int, t: float, t1: float, t2: float, t3: float, v0: float, vp: float, v1: float
) -> float:
    """Distance covered `t` seconds after the start of a law."""
    if t <= t1:
        return _ramp_distance(law, t, t1, v0, vp)
    s = 0.5 * (v0 + vp) * t1
    if t <= t1 + t2:
        return s + vp * (t - t1)
    t_ramp = min(t - t1 - t2, t3)
    return s + vp * t2 + _ramp_distance(law, t_ramp, t3, vp, v1)


@kernel
def law_velocity(
    law: int, t: float, t1: float, t2: float, t3: float, v0: float, vp: float, v1: float
) -> float:
    """Path velocity `t` seconds after the start of a law."""
    if t < t1:
        part = t / t1
        va, vb = v0, vp
    elif t <= t1 + t2:
        return vp
    elif t < t1 + t2 + t3:
        part = (t - t1 - t2) / t3
        va, vb = vp, v1
    else:
        return v1
    if law == SIGMOID:
        root = sin(0.5 * pi * part)
        return va + (vb - va) * root * root
    if law == PARABOLIC:
        return va + (vb - va) * part * part * (3.0 - 2.0 * part)
    return va + (vb - va) * part


@kernel
def jerk_time(length: float, v0: float, v1: float, a0: float, a1: float) -> float:
    """Duration of a constant jerk over `length` from (v0, a0) to (v1, a1), velocities and accelerations.

    L = (v0 + v1) T / 2 + (a0 - a1) T² / 12     T = 2 L / (m + sqrt(m² + (a0 - a1) L / 3)),  m = (v0 + v1) / 2

    Without v1 there are two: braking to a stop and, in half of the time, to half of the velocity.  This root is the
    one for every law whose acceleration keeps its sign.  0 if the path does not get that far.
    """
    mean = 0.5 * (v0 + v1)
    square = mean * mean + (a0 - a1) * length / 3.0
    below = mean + sqrt(square) if square > 0.0 else mean
    return 2.0 * length / below if below > 0.0 else 0.0


@kernel
def constant_jerk(length: float, v0: float, v1: float, a0: float, a1: float) -> tuple[float, float]:
    """The time [s] of `jerk_time` and the jerk [mm/s³]; 0 and 0 where there is no way."""
    total = jerk_time(length, v0, v1, a0, a1)
    return total, (a1 - a0) / total if total > 0.0 else 0.0


@kernel
def jerk_distance(t: float, v0: float, a0: float, jerk: float) -> float:
    """Distance covered `t` seconds after the start of a constant jerk."""
    return t * (v0 + t * (0.5 * a0 + t * jerk / 6.0))


@kernel
def jerk_state(t: float, v0: float, a0: float, jerk: float) -> tuple[float, float, float]:
    """Distance, velocity and acceleration `t` seconds after the start of a constant jerk."""
    return jerk_distance(t, v0, a0, jerk), jerk_velocity(t, v0, a0, jerk), a0 + t * jerk


@kernel
def law_state(
    law: int, t: float, t1: float, t2: float, t3: float, v0: float, vp: float, v1: float
) -> tuple[float, float]:
    """Distance and velocity `t` seconds after the start of a law."""
    return law_distance(law, t, t1, t2, t3, v0, vp, v1), law_velocity(law, t, t1, t2, t3, v0, vp, v1)


@kernel
def jerk_velocity(t: float, v0: float, a0: float, jerk: float) -> float:
    """Velocity `t` seconds after the start of a constant jerk."""
    return v0 + t * (a0 + 0.5 * t * jerk)
