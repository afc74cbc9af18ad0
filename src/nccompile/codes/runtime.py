"""NC7xx: the cyclic task and the drives."""

from nccompile.codes.page import Page

__all__ = ["PAGES"]

_BRAKES = (
    " The faulted axis goes to errorstop and brakes with its acceleration; the path brakes with "
    "[path] quick_deceleration until it stands, and the run ends."
)

PAGES: tuple[Page, ...] = (
    Page(
        "NC701",
        "a drive faulted: velocity",
        "The difference of two set positions over the cycle time exceeds the axis's `velocity`. A queue that was "
        "planned for this machine file stays below it; one that was compiled for a faster machine does not."
        + _BRAKES,
    ),
    Page(
        "NC702",
        "a drive faulted: acceleration",
        "The velocity changed in one cycle by more than `acceleration` times the cycle plus `velocity_step`, the "
        "jump at a junction that drive and mechanics take. Compile the program for this machine file. During an "
        "emergency stop this check is off, since that stop holds the set position at once." + _BRAKES,
    ),
    Page(
        "NC703",
        "a drive faulted: travel",
        "A set position is below `min` or above `max` of the axis. `compile` reports this as NC402 if it is given "
        "the same machine file." + _BRAKES,
    ),
    Page(
        "NC704",
        "a drive faulted: following error",
        "Set minus actual position exceeds `following_error`. The virtual drive follows with the time constant "
        "`lag`, so at constant velocity the following error is about velocity times lag." + _BRAKES,
    ),
    Page(
        "NC705",
        "a stop that is not released",
        "A scheduled command set slow_stop, quick_stop, emergency_stop or wait_at_next_stop, the path stands, and "
        "no later command releases it, so the run ends there.",
    ),
    Page(
        "NC706",
        "an M function that is not acknowledged",
        "The interpolator waits at an M function until it is acknowledged (SoftMotion §6.2.8). Automatic "
        "acknowledge is switched off and no scheduled command ack_m=1 is left, so the run ends there.",
    ),
    Page(
        "NC707",
        "segments were missing",
        "The interpolator plans only as fast as the segments at hand let it stop. It had to brake, or to wait, "
        "because the slow task had not supplied the next ones, or because the ring buffer is too short for the "
        "way that braking takes. The path stays exact; only time is lost. Raise [runtime] queue and low_water.",
    ),
    Page(
        "NC708",
        "cycles missed their deadline",
        "In real time the work of a cycle was not done when its set position was due, or the computer woke the "
        "task more than a cycle late. Then the following deadlines are moved, so that set positions are never "
        "handed out in a rush. Raise [machine] cycle_us or relieve the computer.",
    ),
)
