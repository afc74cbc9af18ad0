"""What every dialect's decoder has: modal state, findings, and the segments made so far."""

from __future__ import annotations

from dataclasses import dataclass

from nccompile.decoder.builder import ChunkBuilder, Row
from nccompile.decoder.options import LARGE_CHUNK, DecodeOptions
from nccompile.decoder.variables import Variables
from nccompile.diagnostics import Diagnostics, Severity
from nccompile.geometry import Curve
from nccompile.source import LargeSource, Source, Span
from nccompile.toolpath.columns import CHUNK, EventKind, Kind

__all__ = ["LIMIT", "Core", "Modal"]

LIMIT = 1e9
"""Greatest value of a word and greatest coordinate [mm, degrees]: a thousand kilometres is a typing error."""


@dataclass(slots=True)
class Modal:
    """What a block leaves behind for the next ones.

    position: end of the last segment on all axes;  drive: last drive instruction, None before the first;
    absolute: G90;  centre_absolute: G98;  feed [mm/s], accel, decel [mm/s²], radius [mm]: 0 if not programmed;
    profile: bit i set if axis i runs in the S-profile;
    leaving: direction in X-Y in which the last segment ended (a curve stands for its end tangent), None if the
    next one need not go on smoothly.
    """

    position: list[float]
    drive: int | None = None
    absolute: bool = True
    centre_absolute: bool = False
    feed: float = 0.0
    accel: float = 0.0
    decel: float = 0.0
    radius: float = 0.0
    profile: int = 0
    leaving: Curve | tuple[float, float] | None = None


class Core:
    """The state that the parts of a decoder share."""

    def __init__(
        self, source: Source, axes: tuple[str, ...], options: DecodeOptions, diagnostics: Diagnostics, jumps: bool
    ) -> None:  # fmt: skip
        self.source = source
        self.options = options
        self.axes = axes
        self.index = {letter: at for at, letter in enumerate(axes)}
        given = {letter.upper(): float(value) for letter, value in options.start.items()}
        start = [given.get(letter, 0.0) for letter in axes]
        self.modal = Modal(start)
        usual = LARGE_CHUNK if isinstance(source, LargeSource) else CHUNK
        self.path = ChunkBuilder(axes, start, options.chunk or usual)
        self.variables = Variables(options.defines)
        self.incomplete = False
        """A block was left out because of an error: what it would have set is unknown."""
        self._diagnostics = diagnostics
        self._seen: set[tuple[str, Span]] | None = set() if jumps else None
        self._jump: tuple[list[float], int] | None = None

    def error(self, code: str, message: str, span: Span, help: str = "") -> None:
        """Reports an error; of a block that runs several times once."""
        self._report(code, Severity.ERROR, message, span, help)

    def warn(self, code: str, message: str, span: Span, help: str = "") -> None:
        """Reports a warning; of a block that runs several times once."""
        self._report(code, Severity.WARNING, message, span, help)

    def _report(self, code: str, severity: Severity, message: str, span: Span, help: str) -> None:
        if self._seen is not None:
            if (code, span) in self._seen:
                return
            self._seen.add((code, span))
        self._diagnostics.report(code, severity, message, self.source, span, help)

    def add(
        self, kind: Kind, target: list[float], length: float, line: int, curve: Curve | None = None
    ) -> int:  # fmt: skip
        """Adds a segment with the modal values in force; a set position that is still open comes before it."""
        if self._jump is not None:
            self.flush_position()
        modal = self.modal
        row = Row(kind, length, modal.feed, modal.accel, modal.decel, modal.radius, modal.profile, line)
        modal.position = target
        return self.path.add(row, target, curve)

    @property
    def has_jump(self) -> bool:
        """Whether a set position is open."""
        return self._jump is not None

    def set_position(self, target: list[float], line: int) -> None:
        """Sets the position without motion: the start of the path, or a jump (SoftMotion §3.2, G92).

        Of several in a row only the last becomes a segment.
        """
        if len(self.path) == 0:
            self.path.start = target
        else:
            self._jump = (target, line)
        self.modal.position = target
        self.modal.leaving = None

    def flush_position(self) -> None:
        """Makes the open set position a segment."""
        if self._jump is not None:
            target, line = self._jump
            self._jump = None
            self.add(Kind.SET_POSITION, target, 0.0, line)

    def wait(
        self, kind: Kind, event: EventKind, number: int, line: int, k: float, l: float = 0.0,  # noqa: E741
        name: str | None = None,
    ) -> None:  # fmt: skip
        """Adds a segment at which the path waits, with the event that says for what."""
        row = self.add(kind, self.modal.position, 0.0, line)
        self.path.event(row, event, number, 0.0, k, l, name)
