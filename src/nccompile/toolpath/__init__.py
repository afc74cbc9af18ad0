"""The toolpath IR: columns (`columns`), segment views (`views`), text form (`text`), verifier (`verify`)."""

from nccompile.toolpath.columns import (
    ADDITIONAL,
    AXIS_LETTERS,
    CHUNK,
    CURVE_PARAMETERS,
    Curves,
    EventKind,
    Events,
    Floats,
    Kind,
    Mark,
    Plane,
    Toolpath,
)

__all__ = [
    "ADDITIONAL",
    "AXIS_LETTERS",
    "CHUNK",
    "CURVE_PARAMETERS",
    "Curves",
    "EventKind",
    "Events",
    "Floats",
    "Kind",
    "Mark",
    "Plane",
    "Toolpath",
]
