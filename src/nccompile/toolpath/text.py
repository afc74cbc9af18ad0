"""The text form of a toolpath, exact to the bit: the language of dumps, golden files and pass tests.

    toolpath 1
    axes X Y Z
    start 0.0 0.0 0.0
    name "g_data"
    line 10.0 0.0 0.0 length 10.0 feed 20.0 source 3
      switch 2 at 0.25
    arc 10.0 10.0 0.0 length 15.7 feed 20.0 source 4 xy center 10.0 5.0 radius 5.0 start -1.57 sweep 3.14
    m_function 10.0 10.0 0.0 source 5
      m 10 k 1.5 o 0
    dwell 10.0 10.0 0.0 source 6
      wait 0 k 0.5

A row starts with the kind and the end position; then pairs of a word and its value follow, where what is left
out is 0.  `names` are numbered from 0 in the order of their lines, which stand before the rows that use them;
events follow their row.  A planned path has `planned` in its first line and the words v_limit, v_junction and
v_end in its rows, one of third order `planned third_order` and the words a_end and jerk too.  `first` is written
if it is not 0.  Blank lines and what follows a # are ignored.

Numbers are Python's shortest exact ones (repr).  The parser gives back the columns bit by bit, provided that
the rows of the curve table are in the order of their segments (an invariant, see `verify`).
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator

import numpy as np

from nccompile.errors import UsageError
from nccompile.toolpath.columns import CURVE_PARAMETERS, Curves, EventKind, Events, Kind, Plane, Toolpath

__all__ = ["format_toolpath", "format_toolpaths", "parse_toolpath"]

_KINDS = {kind.name.lower(): kind for kind in Kind}
_PLANES = {plane.name.lower(): plane for plane in Plane}
_EVENTS = {"switch": EventKind.SWITCH, "m": EventKind.M_FUNCTION, "wait": EventKind.DWELL}
_EVENT_WORDS = {kind: word for word, kind in _EVENTS.items()}

_REALS = ("length", "feed", "accel", "decel", "radius")
_WHOLE = ("mark", "profile", "line")
_PLANNED = ("v_limit", "v_junction", "v_end")
_FORMS = {
    "toolpath 1": (),
    "toolpath 1 planned": _PLANNED,
    "toolpath 1 planned third_order": (*_PLANNED, "a_end", "jerk"),
}
"""First lines, and the planned columns that rows have then."""
_DTYPES = {"mark": np.uint16, "profile": np.uint16, "line": np.int32}
_COLUMN_WORDS = {"radius": "tool_radius", "line": "source"}
"""Columns under another word: `radius` is that of an arc, `line` a kind."""

_SHAPES: dict[int, tuple[tuple[str, int], ...]] = {
    Kind.ARC: (("center", 2), ("radius", 1), ("start", 1), ("sweep", 1)),
    Kind.ELLIPSE: (
        ("center", 2), ("main", 1), ("sub", 1), ("direction", 1), ("start", 1), ("sweep", 1),
    ),
    Kind.POLYNOMIAL: (("u", 4), ("v", 4), ("w", 4)),
}  # fmt: skip
"""Words of a curve row and how many numbers each takes, in the order of the row."""


def format_toolpath(path: Toolpath) -> str:
    """The text of one chunk, with a newline at its end."""
    return "".join(line + "\n" for line in format_toolpaths([path]))


def format_toolpaths(chunks: Iterable[Toolpath]) -> Iterator[str]:
    """The lines of the text of consecutive chunks, which are written as one path."""
    head: Toolpath | None = None
    named = 0
    for chunk in chunks:
        if head is None:
            head = chunk
            yield next(form for form, columns in _FORMS.items() if columns == _planned_columns(chunk))
            yield "axes " + " ".join(chunk.axes)
            yield "start " + _numbers(chunk.start.tolist())
            if chunk.first:
                yield f"first {chunk.first}"
        if (chunk.axes, _planned_columns(chunk)) != (head.axes, _planned_columns(head)):
            raise UsageError("the chunks differ in their axes or in being planned: they are not one path")
        for name in chunk.names[named:]:
            yield f"name {json.dumps(name)}"
        named = max(named, len(chunk.names))
        yield from _rows(chunk)


def _planned_columns(chunk: Toolpath) -> tuple[str, ...]:
    """The planned columns that a chunk has."""
    if not chunk.is_planned:
        return ()
    return _FORMS["toolpath 1 planned third_order"] if chunk.is_third_order else _PLANNED


def _rows(chunk: Toolpath) -> Iterator[str]:
    words = [(_COLUMN_WORDS.get(n, n), getattr(chunk, n).tolist()) for n in (*_REALS, *_WHOLE)]
    words += [(name, getattr(chunk, name).tolist()) for name in _planned_columns(chunk)]
    targets = chunk.target.tolist()
    kinds = [name for name, _ in sorted(_KINDS.items(), key=lambda item: item[1])]
    curves = _curves(chunk)
    events = _events(chunk)
    at, event = next(events, (-1, ""))
    for i, kind in enumerate(chunk.kind.tolist()):
        parts = [kinds[kind], _numbers(targets[i])]
        parts += [f"{word} {value!r}" for word, column in words if (value := column[i]) or _is_minus(value)]
        if chunk.curve[i] >= 0:
            parts.append(next(curves))
        yield " ".join(parts)
        while at == i:
            yield event
            at, event = next(events, (-1, ""))


def _is_minus(value: float) -> bool:
    """Whether a zero is -0.0, which may not be left out."""
    return isinstance(value, float) and repr(value) == "-0.0"


def _curves(chunk: Toolpath) -> Iterator[str]:
    """The words of the curve of every curved row, in order."""
    rows = np.flatnonzero(chunk.curve >= 0)
    table = chunk.curve[rows]
    planes, parameters = chunk.curves.plane[table].tolist(), chunk.curves.parameters[table].tolist()
    for kind, plane, p in zip(chunk.kind[rows].tolist(), planes, parameters, strict=True):
        parts = [Plane(plane).name.lower()]
        at = 0
        for word, count in _SHAPES[kind]:
            values = p[at : at + count]
            at += count
            if word != "w" or plane == Plane.SPACE:
                parts.append(f"{word} {_numbers(values)}")
        yield " ".join(parts)


def _events(chunk: Toolpath) -> Iterator[tuple[int, str]]:
    """(row, line) of every event."""
    e = chunk.events
    columns = (e.segment, e.kind, e.number, e.position, e.k, e.l, e.o)
    for segment, kind, number, position, k, l, o in zip(*(c.tolist() for c in columns), strict=True):  # noqa: E741
        parts = [f"  {_EVENT_WORDS[kind]} {number}"]
        for word, value in (("at", position), ("k", k), ("l", l)):
            if value or _is_minus(value):
                parts.append(f"{word} {value!r}")
        if o != -1:
            parts.append(f"o {o}")
        yield segment, " ".join(parts)


def _numbers(values: Iterable[float]) -> str:
    return " ".join(map(repr, values))


def parse_toolpath(text: str) -> Toolpath:
    """The toolpath of a text, as one chunk.

    Raises:   UsageError: a line that is not of this language, with its number.
    """
    reader = _Reader()
    number = 0
    for number, line in enumerate(text.split("\n"), 1):
        if content := _without_comment(line).strip():
            try:
                reader.take(content)
            except (ValueError, IndexError, KeyError, OverflowError) as error:
                raise UsageError(
                    f"line {number} of the toolpath text: {_reason(error)}: {line.strip()}"
                ) from error
    try:
        return reader.path()
    except ValueError as error:
        raise UsageError(f"line {number} of the toolpath text: {error}") from error


def _without_comment(line: str) -> str:
    """The line up to a # that is not inside a quoted name."""
    if "#" not in line:
        return line
    return line if line.lstrip().startswith("name ") else line.split("#", 1)[0]


def _reason(error: Exception) -> str:
    if isinstance(error, KeyError):
        return f"unknown word {error.args[0]!r}"
    return "a number is missing" if isinstance(error, IndexError) else str(error)


class _Reader:
    """Collects the lines of a text as columns."""

    def __init__(self) -> None:
        self.axes: tuple[str, ...] = ()
        self.start: list[float] = []
        self.planned: tuple[str, ...] | None = None
        self.first = 0
        self.names: list[str] = []
        self.kinds: list[int] = []
        self.targets: list[list[float]] = []
        self.words: list[dict[str, float]] = []
        self.curve: list[int] = []
        self.curves: list[tuple[int, list[float]]] = []
        self.events: list[tuple[int, int, int, float, float, float, int]] = []

    def take(self, line: str) -> None:
        """Reads one line without comment."""
        head, _, rest = line.partition(" ")
        if self.planned is None:
            if line not in _FORMS:
                raise ValueError('a toolpath text starts with "toolpath 1" or "toolpath 1 planned"')
            self.planned = _FORMS[line]
        elif head == "axes":
            self.axes = tuple(rest.split())
        elif head == "start":
            self.start = [float(value) for value in rest.split()]
        elif head == "first":
            self.first = int(rest)
        elif head == "name":
            self.names.append(str(json.loads(rest)))
        elif head in _EVENTS:
            self._event(_EVENTS[head], rest.split())
        else:
            self._row(_KINDS[head], rest.split())

    def _row(self, kind: Kind, parts: list[str]) -> None:
        """One segment: position, then words, with the plane before the words of a curve."""
        k = len(self.axes)
        if k != len(self.start) or not k:
            raise ValueError("axes and start with as many numbers must come before the first row")
        if len(parts) < k:
            raise IndexError
        target = [float(value) for value in parts[:k]]
        at = next((i for i in range(k, len(parts)) if parts[i] in _PLANES), len(parts))
        words = self._words(parts[k:at])
        curve = -1
        if at < len(parts):
            curve = len(self.curves)
            row = (int(_PLANES[parts[at]]), _curve_row(kind, parts[at + 1 :]))
            self.curves.append(row)
        self.kinds.append(kind)
        self.targets.append(target)
        self.words.append(words)
        self.curve.append(curve)

    def _words(self, parts: list[str]) -> dict[str, float]:
        """Pairs of word and number of a row."""
        if len(parts) % 2:
            raise IndexError
        allowed = {_COLUMN_WORDS.get(name, name): name for name in (*_REALS, *_WHOLE)}
        allowed |= {name: name for name in self.planned or ()}
        words: dict[str, float] = {}
        for word, value in zip(parts[::2], parts[1::2], strict=True):
            name = allowed[word]
            words[name] = int(value) if name in _DTYPES else float(value)
            if name in _DTYPES:
                _DTYPES[name](words[name])
        return words

    def _event(self, kind: EventKind, parts: list[str]) -> None:
        """One event of the last row."""
        if not self.kinds:
            raise ValueError("an event before the first row")
        values: dict[str, float] = {"at": 0.0, "k": 0.0, "l": 0.0, "o": -1}
        if len(parts) % 2 == 0:
            raise IndexError
        for word, value in zip(parts[1::2], parts[2::2], strict=True):
            values[word] = int(value) if isinstance(values[word], int) else float(value)
        number = int(np.int32(int(parts[0])))
        row = len(self.kinds) - 1
        self.events.append((row, int(kind), number, values["at"], values["k"], values["l"], int(values["o"])))

    def path(self) -> Toolpath:
        """What was read."""
        if self.planned is None:
            raise ValueError("the text is empty")
        if not self.axes or len(self.axes) != len(self.start):
            raise ValueError("axes or start is missing, or they differ in number")

        def column(name: str) -> np.ndarray:
            return np.array([words.get(name, 0) for words in self.words], _DTYPES.get(name, np.float64))

        empty = Toolpath.empty(self.axes, np.array(self.start))
        return empty.replace(
            kind=np.array(self.kinds, np.uint8),
            target=np.array(self.targets, np.float64).reshape(len(self.kinds), len(self.axes)),
            curve=np.array(self.curve, np.int32),
            curves=Curves.from_rows(self.curves),
            events=Events.from_rows(self.events),
            first=self.first,
            names=tuple(self.names),
            **{name: column(name) for name in (*_REALS, *_WHOLE)},
            **{name: column(name) for name in self.planned},
        )


def _curve_row(kind: Kind, parts: list[str]) -> list[float]:
    """The parameters of a curve from its words, which stand in the order of the row."""
    row: list[float] = []
    at = 0
    for word, count in _SHAPES.get(kind, ()):
        if at == len(parts) and word == "w":
            break
        if parts[at] != word:
            raise ValueError(f"{word} expected instead of {parts[at]}")
        values = parts[at + 1 : at + 1 + count]
        if len(values) < count:
            raise IndexError
        row += [float(value) for value in values]
        at += 1 + count
    if at != len(parts) or not row:
        raise ValueError(f"{kind.name.lower()} does not take {' '.join(parts[at:]) or 'a plane'}")
    return row + [0.0] * (CURVE_PARAMETERS - len(row))
