"""Members of an OutQueue file: which columns a chunk has, their types and shapes, and their bytes.

A chunk is a folder of `.npy` members, `chunk000000/kind.npy` and so on.  Their headers follow from the
chunk table in `meta.json`, so a reader knows every byte of a header, and the size of every member, before it
reads the member; nothing in the file is unpickled, inflated or trusted to state its own size.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from nccompile.backend.npz import npy_header
from nccompile.toolpath import CURVE_PARAMETERS, Toolpath

__all__ = ["META", "Counts", "Member", "columns", "counts", "folder", "member_data", "members"]

META = "meta.json"
"""The member that describes the others; the last one of the file."""

_SEGMENT_COLUMNS = {
    "kind": "|u1",
    "target": "<f8",
    "curve": "<i4",
    "length": "<f8",
    "feed": "<f8",
    "accel": "<f8",
    "decel": "<f8",
    "mark": "<u2",
    "radius": "<f8",
    "profile": "<u2",
    "line": "<i4",
    "v_limit": "<f8",
    "v_junction": "<f8",
    "v_end": "<f8",
}
_THIRD_ORDER_COLUMNS = {"a_end": "<f8", "jerk": "<f8"}
"""Columns that only third-order plans have."""
_CURVE_COLUMNS = {"plane": "|u1", "parameters": "<f8"}
_EVENT_COLUMNS = {
    "segment": "<i4",
    "kind": "|u1",
    "number": "<i4",
    "position": "<f8",
    "k": "<f8",
    "l": "<f8",
    "o": "<i4",
}


class Counts(NamedTuple):
    """Rows of one chunk: segments, curve rows, event rows."""

    segments: int
    curves: int
    events: int


class Member(NamedTuple):
    """One `.npy` member: its name in the zip, type, shape, and the bytes before its data."""

    name: str
    dtype: str
    shape: tuple[int, ...]
    header: bytes

    @property
    def size(self) -> int:
        """Bytes of the whole member."""
        return len(self.header) + int(np.dtype(self.dtype).itemsize) * int(np.prod(self.shape, dtype=object))


def folder(chunk: int) -> str:
    """The folder of chunk `chunk`, from 0."""
    return f"chunk{chunk:06d}"


def counts(chunk: Toolpath) -> Counts:
    """The row counts of a chunk."""
    return Counts(len(chunk), len(chunk.curves), len(chunk.events))


def _segment_columns(third_order: bool) -> dict[str, str]:
    return _SEGMENT_COLUMNS | _THIRD_ORDER_COLUMNS if third_order else _SEGMENT_COLUMNS


def members(chunk: int, rows: Counts, axes: int, third_order: bool) -> Iterator[Member]:
    """The members of a chunk in their order in the file; tables without rows have none."""
    place = folder(chunk)
    for name, dtype in _segment_columns(third_order).items():
        shape = (rows.segments, axes) if name == "target" else (rows.segments,)
        yield _member(f"{place}/{name}.npy", dtype, shape)
    if rows.curves:
        for name, dtype in _CURVE_COLUMNS.items():
            wide = (rows.curves, CURVE_PARAMETERS) if name == "parameters" else (rows.curves,)
            yield _member(f"{place}/curves.{name}.npy", dtype, wide)
    if rows.events:
        for name, dtype in _EVENT_COLUMNS.items():
            yield _member(f"{place}/events.{name}.npy", dtype, (rows.events,))


def columns(chunk: Toolpath) -> Iterator[npt.NDArray[Any]]:
    """The arrays of a planned chunk in the order of `members`."""
    for name in _segment_columns(chunk.is_third_order):
        yield getattr(chunk, name)
    if len(chunk.curves):
        for name in _CURVE_COLUMNS:
            yield getattr(chunk.curves, name)
    if len(chunk.events):
        for name in _EVENT_COLUMNS:
            yield getattr(chunk.events, name)


def member_data(member: Member, array: npt.NDArray[Any]) -> memoryview:
    """What follows a member's header: the array, which must have its shape, in the type it is stored in."""
    if array.shape != member.shape:
        raise ValueError(f"{member.name} has shape {array.shape}, not {member.shape}")
    return np.ascontiguousarray(array, dtype=member.dtype).reshape(-1).view(np.uint8).data


def _member(name: str, dtype: str, shape: tuple[int, ...]) -> Member:
    return Member(name, dtype, shape, npy_header(dtype, shape))
