"""`.ncq`, the OutQueue file: a planned toolpath as a zip of NumPy columns (docs/queue-format.md).

    bracket.ncq
      chunk000000/kind.npy ... v_end.npy, curves.*.npy, events.*.npy
      chunk000001/...
      meta.json

`numpy.load` opens it as it opens an `.npz`.  Members are stored, not compressed, and carry fixed
timestamps: equal toolpaths give equal bytes.  The CRC-32 of the zip guards every member, and the reader
accepts only the members, headers and sizes that `meta.json` announces.
"""

from __future__ import annotations

import zipfile
import zlib
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from struct import error as struct_error
from typing import Any, BinaryIO

import numpy as np

from nccompile.backend.files import replacing
from nccompile.backend.ncq_check import check_chunk
from nccompile.backend.ncq_layout import META, Counts, Member, columns, counts, member_data, members
from nccompile.backend.ncq_meta import Meta, Provenance
from nccompile.backend.npz import npz_entry
from nccompile.backend.totals import Totals, TotalsGatherer
from nccompile.errors import QueueError
from nccompile.toolpath import Curves, Events, Floats, Toolpath

__all__ = ["Meta", "Provenance", "Queue", "Totals", "read", "write"]

_GREATEST_META = 1 << 26
_ZIP_ERRORS = (
    zipfile.BadZipFile, zlib.error, struct_error, NotImplementedError, RuntimeError, EOFError, ValueError,
    KeyError, IndexError, OverflowError,
)  # fmt: skip
"""What Python's zipfile raises on files that are not sound zips."""


def write(
    path: Path,
    chunks: Iterable[Toolpath],
    provenance: Provenance,
    job_time: Callable[[], float],
    keep: Callable[[], bool] = lambda: True,
) -> Meta | None:
    """Writes planned chunks as they come; the file appears under its name only when it is complete.

    Args:     chunks: planned, consecutive, all with the same axes.  job_time: asked once, after the last
              chunk [s].  keep: asked after the last chunk; False leaves no file.
    Returns:  what was written, or None if `keep` said no.
    Raises:   UsageError: the place cannot be written.  Whatever `chunks` raises; no file is left then.
    """
    with replacing(path) as (file, commit):
        meta = _write_zip(file, chunks, provenance, job_time)
        if not keep():
            return None
        commit()
    return meta


def _write_zip(
    file: BinaryIO, chunks: Iterable[Toolpath], provenance: Provenance, job_time: Callable[[], float]
) -> Meta:
    gatherer = TotalsGatherer()
    table: list[Counts] = []
    axes: tuple[str, ...] = ("X", "Y", "Z")
    start: Floats = np.zeros(3)
    names: tuple[str, ...] = ()
    third_order = False
    with zipfile.ZipFile(file, "w", zipfile.ZIP_STORED) as archive:
        for number, chunk in enumerate(chunks):
            if not chunk.is_planned:
                raise ValueError("an OutQueue holds planned toolpaths only")
            if number == 0:
                axes, start, third_order = chunk.axes, chunk.start, chunk.is_third_order
            table.append(counts(chunk))
            names = max(names, chunk.names, key=len)
            gatherer.add(chunk)
            layout = members(number, table[-1], len(axes), third_order)
            for member, column in zip(layout, columns(chunk), strict=True):
                entry = npz_entry(member.name)
                entry.file_size = member.size
                with archive.open(entry, "w") as target:
                    target.write(member.header)
                    target.write(member_data(member, column))
        if not table:
            gatherer.add(Toolpath.empty())
        totals = gatherer.totals(job_time())
        meta = Meta(axes, tuple(start.tolist()), provenance, totals, names, tuple(table), third_order)
        archive.writestr(npz_entry(META), meta.to_json())
    return meta


@dataclass(frozen=True)
class Queue:
    """A read OutQueue: its description at once, its chunks when they are asked for."""

    path: Path
    meta: Meta

    @property
    def axes(self) -> tuple[str, ...]:
        """The axis letters, X, Y, Z first."""
        return self.meta.axes

    @property
    def total(self) -> Totals:
        """The totals as its writer counted them."""
        return self.meta.totals

    def chunks(self) -> Iterator[Toolpath]:
        """The planned chunks in order, each checked before it is handed out; raises QueueError."""
        start = np.array(self.meta.start)
        first = 0
        with _opened(self.path) as archive:
            for number, rows in enumerate(self.meta.chunks):
                chunk = self._chunk(archive, number, rows, start, first)
                with _naming(self.path):
                    check_chunk(chunk)
                start, first = chunk.end, first + len(chunk)
                yield chunk

    def check(self) -> Queue:
        """Reads everything once; raises QueueError where the file is not sound.  Returns the queue."""
        gatherer = TotalsGatherer()
        for chunk in self.chunks():
            gatherer.add(chunk)
        told = self.meta.totals
        counted = gatherer.totals(told.job_time)
        if (counted.segments, counted.switches, counted.m_functions) != (
            told.segments, told.switches, told.m_functions,
        ):  # fmt: skip
            raise QueueError(f"{self.path} is not a sound OutQueue: its totals do not fit its segments")
        return self

    def _chunk(
        self, archive: zipfile.ZipFile, number: int, rows: Counts, start: Floats, first: int
    ) -> Toolpath:
        arrays: dict[str, Any] = {}
        for member in members(number, rows, len(self.axes), self.meta.third_order):
            name = member.name.partition("/")[2].removesuffix(".npy")
            arrays[name] = _load(archive, self.path, member)
        curves = {k.partition(".")[2]: arrays.pop(k) for k in list(arrays) if k.startswith("curves.")}
        events = {k.partition(".")[2]: arrays.pop(k) for k in list(arrays) if k.startswith("events.")}
        return Toolpath(
            axes=self.axes,
            start=start,
            curves=Curves(**curves) if curves else Curves.empty(),
            events=Events(**events) if events else Events.empty(),
            first=first,
            names=self.meta.names,
            **arrays,
        )


def read(path: Path) -> Queue:
    """Opens an OutQueue and checks its members against its description; raises QueueError."""
    with _opened(path) as archive:
        sizes = {entry.filename: entry.file_size for entry in archive.infolist()}
        if len(sizes) != len(archive.infolist()):
            raise _unsound(path, "it has two members of one name")
        for entry in archive.infolist():
            if entry.compress_type != zipfile.ZIP_STORED or entry.file_size != entry.compress_size:
                raise _unsound(path, f"its member {entry.filename} is compressed")
        if META not in sizes:
            raise _unsound(path, "it has no meta.json")
        if sizes[META] > _GREATEST_META:
            raise _unsound(path, "its meta.json is too large")
        with _naming(path):
            meta = Meta.from_json(archive.read(META))
    if len(meta.chunks) > len(sizes):
        raise _unsound(path, "its chunk table names more chunks than it has members")
    expected = {
        member.name: member.size
        for number, rows in enumerate(meta.chunks)
        for member in members(number, rows, len(meta.axes), meta.third_order)
    }
    _compare(path, expected, {name: size for name, size in sizes.items() if name != META})
    if meta.totals.segments != sum(rows.segments for rows in meta.chunks):
        raise _unsound(path, "its totals do not fit its chunk table")
    return Queue(path, meta)


def _compare(path: Path, expected: dict[str, int], found: dict[str, int]) -> None:
    """Members and their sizes must be those that the chunk table announces."""
    if missing := sorted(expected.keys() - found.keys()):
        raise _unsound(path, f"its member {missing[0]} is missing")
    if extra := sorted(found.keys() - expected.keys()):
        raise _unsound(path, f"it has an unknown member {extra[0][:80]!r}")
    for name, size in expected.items():
        if found[name] != size:
            raise _unsound(path, f"its member {name} has {found[name]} bytes, not {size}")


def _load(archive: zipfile.ZipFile, path: Path, member: Member) -> Any:
    content = archive.read(member.name)
    if len(content) != member.size or not content.startswith(member.header):
        shape = " x ".join(str(n) for n in member.shape)
        raise _unsound(path, f"its member {member.name} is not a {member.dtype} array of {shape}")
    return np.frombuffer(content, member.dtype, offset=len(member.header)).reshape(member.shape)


@contextmanager
def _opened(path: Path) -> Iterator[zipfile.ZipFile]:
    """The zip, with every failure of opening and reading turned into a QueueError."""
    try:
        with zipfile.ZipFile(path) as archive:
            yield archive
    except _ZIP_ERRORS as error:
        raise _unsound(path, "it is not a whole, unaltered zip file") from error
    except OSError as error:
        raise QueueError(f"{path} cannot be read: {error.strerror or error}") from error


@contextmanager
def _naming(path: Path) -> Iterator[None]:
    """Puts the file's name before a reason."""
    try:
        yield
    except QueueError as error:
        raise _unsound(path, str(error)) from error


def _unsound(path: Path, reason: str) -> QueueError:
    return QueueError(f"{path} is not a sound OutQueue: {reason}")
