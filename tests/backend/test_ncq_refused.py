"""Files that are not sound OutQueues: each is refused in one sentence, never read as something else."""

from __future__ import annotations

import io
import json
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from nccompile.backend import ncq
from nccompile.backend.ncq_layout import columns, counts, member_data, members
from nccompile.errors import QueueError
from nccompile.toolpath import Toolpath
from tests.backend.paths import PROVENANCE, same, small


@pytest.fixture(scope="module")
def sound(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    path = tmp_path_factory.mktemp("sound") / "part.ncq"
    ncq.write(path, iter([small()]), PROVENANCE, lambda: 1.25)
    return path.read_bytes()


def _is_refused(path: Path, data: bytes) -> bool:
    path.write_bytes(data)
    try:
        list(ncq.read(path).check().chunks())
    except QueueError:
        return True
    return False


def _is_equal(path: Path) -> bool:
    """Whether the file is read as the queue that was written."""
    queue = ncq.read(path).check()
    (chunk,) = queue.chunks()
    return same(chunk, small()) and queue.meta.provenance == PROVENANCE and queue.total.job_time == 1.25


@settings(max_examples=400, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.data())
def test_every_flipped_bit(tmp_path: Path, sound: bytes, data: st.DataObject) -> None:
    bit = data.draw(st.integers(0, 8 * len(sound) - 1))
    altered = bytearray(sound)
    altered[bit // 8] ^= 1 << bit % 8
    place = tmp_path / "part.ncq"
    assert _is_refused(place, bytes(altered)) or _is_equal(place)


@settings(max_examples=100, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.data())
def test_every_truncation(tmp_path: Path, sound: bytes, data: st.DataObject) -> None:
    length = data.draw(st.integers(0, len(sound) - 1))
    assert _is_refused(tmp_path / "part.ncq", sound[:length])


@settings(max_examples=100, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.binary(max_size=200))
def test_any_bytes(tmp_path: Path, data: bytes) -> None:
    assert _is_refused(tmp_path / "part.ncq", data)


def _rebuilt(sound: bytes, change: Callable[[dict[str, bytes]], None], compression: int = 0) -> bytes:
    """A zip with valid CRCs whose members were changed."""
    with zipfile.ZipFile(io.BytesIO(sound)) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    change(members)
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", compression) as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    return file.getvalue()


def _meta(change: Callable[[dict[str, Any]], None]) -> Callable[[dict[str, bytes]], None]:
    def apply(members: dict[str, bytes]) -> None:
        content = json.loads(members["meta.json"])
        change(content)
        members["meta.json"] = json.dumps(content).encode()

    return apply


def _npy(array: Any) -> bytes:
    file = io.BytesIO()
    np.lib.format.write_array(file, np.asarray(array), version=(1, 0))
    return file.getvalue()


def _put(name: str, content: bytes) -> Callable[[dict[str, bytes]], None]:
    return lambda members: members.__setitem__(name, content)


ALTERED = {
    "no meta": lambda m: m.pop("meta.json"),
    "meta is no JSON": _put("meta.json", b"{"),
    "meta nests too deep": _put("meta.json", b"[" * 100_000),
    "meta is a list": _put("meta.json", b"[]"),
    "another format": _meta(lambda c: c.__setitem__("format", "other")),
    "no version": _meta(lambda c: c.pop("version")),
    "a newer version": _meta(lambda c: c.__setitem__("version", 2)),
    "no totals": _meta(lambda c: c.pop("totals")),
    "totals that do not fit": _meta(lambda c: c["totals"].__setitem__("segments", 4)),
    "switches that do not fit": _meta(lambda c: c["totals"].__setitem__("switches", 4)),
    "unknown axis": _meta(lambda c: c.__setitem__("axes", ["X", "Y", "Z", "E"])),
    "axes in disorder": _meta(lambda c: c.__setitem__("axes", ["Y", "X", "Z"])),
    "an unknown time law": _meta(lambda c: c["planning"].__setitem__("time_law", "cubic")),
    "NaN": _meta(lambda c: c["start"].__setitem__("X", float("nan"))),
    "a negative count": _meta(lambda c: c.__setitem__("chunks", [[-5, 1, 3]])),
    "an absurd count": _meta(lambda c: c.__setitem__("chunks", [[2**40, 1, 3]])),
    "counts beyond the members": _meta(lambda c: c.__setitem__("chunks", [[2**31 - 1, 1, 3]])),
    "more chunks than members": _meta(lambda c: c.__setitem__("chunks", [[0, 0, 0]] * 5000)),
    "a missing member": lambda m: m.pop("chunk000000/kind.npy"),
    "a foreign member": _put("readme.txt", b"hello"),
    "an array of another type": _put("chunk000000/line.npy", _npy(np.zeros(5, np.float32))),
    "an array of another length": _put("chunk000000/kind.npy", _npy(np.zeros(6, np.uint8))),
    "an array of objects": _put("chunk000000/kind.npy", b"\x93NUMPY\x01\x00"),
}


@pytest.mark.parametrize("name", ALTERED)
def test_altered_members(tmp_path: Path, sound: bytes, name: str) -> None:
    path = tmp_path / "part.ncq"
    path.write_bytes(_rebuilt(sound, ALTERED[name]))
    with pytest.raises(QueueError, match=r"part\.ncq is not a sound OutQueue: ") as caught:
        ncq.read(path).check()
    assert len(str(caught.value).splitlines()) == 1


def test_a_compressed_member_is_refused_before_it_is_inflated(tmp_path: Path, sound: bytes) -> None:
    path = tmp_path / "part.ncq"
    path.write_bytes(_rebuilt(sound, lambda m: None, zipfile.ZIP_DEFLATED))
    with pytest.raises(QueueError, match="compressed"):
        ncq.read(path)


def _event(**columns: list[float]) -> Callable[[Toolpath], Toolpath]:
    def apply(path: Toolpath) -> Toolpath:
        events = path.events
        changed = {n: np.array(v, getattr(events, n).dtype) for n, v in columns.items()}
        return path.replace(events=type(events)(**(vars(events) | changed)))

    return apply


def _column(name: str, row: int, value: float) -> Callable[[Toolpath], Toolpath]:
    def apply(path: Toolpath) -> Toolpath:
        column = getattr(path, name).copy()
        column[row] = value
        return path.replace(**{name: column})

    return apply


def _curve(at: int, value: float) -> Callable[[Toolpath], Toolpath]:
    def apply(path: Toolpath) -> Toolpath:
        parameters = path.curves.parameters.copy()
        parameters[0, at] = value
        return path.replace(curves=type(path.curves)(path.curves.plane, parameters))

    return apply


UNSOUND = {
    "NaN in target": _column("target", 1, np.nan),
    "inf in v_end": _column("v_end", 1, np.inf),
    "inf in the curve table": _curve(2, np.inf),
    "unknown kind": _column("kind", 1, 99),
    "negative length": _column("length", 1, -1.0),
    "not planned": _column("accel", 1, 0.0),
    "no feed": _column("feed", 1, 0.0),
    "unknown mark": _column("mark", 1, 256),
    "unknown axis in profile": _column("profile", 1, 8),
    "curve index too great": _column("curve", 2, 1),
    "curve index missing": _column("curve", 2, -1),
    "curve index at a line": _column("curve", 1, 0),
    "unknown plane": lambda p: p.replace(curves=type(p.curves)(np.array([4], np.uint8), p.curves.parameters)),
    "an arc in space": lambda p: p.replace(
        curves=type(p.curves)(np.array([3], np.uint8), p.curves.parameters)
    ),
    "event of no segment": _event(segment=[1, 3, 5]),
    "events in disorder": _event(segment=[3, 1, 4]),
    "unknown event": _event(kind=[0, 2, 3]),
    "event outside its segment": _event(position=[1.5, 0, 0]),
    "event with NaN": _event(k=[0, np.nan, 0]),
    "event names nothing": _event(o=[-1, -1, 1]),
    "dwell without event": _event(kind=[0, 0, 1]),
    "M function twice": _event(segment=[4, 3, 4]),
}


@pytest.mark.parametrize("name", UNSOUND)
def test_rows_that_do_not_hold_together(tmp_path: Path, sound: bytes, name: str) -> None:
    def put_columns(content: dict[str, bytes]) -> None:
        unsound = UNSOUND[name](small())
        for member, column in zip(
            members(0, counts(unsound), 3, unsound.is_third_order), columns(unsound), strict=True
        ):
            content[member.name] = member.header + bytes(member_data(member, column))

    path = tmp_path / "part.ncq"
    path.write_bytes(_rebuilt(sound, put_columns))
    with pytest.raises(QueueError, match=r"part\.ncq is not a sound OutQueue: ") as caught:
        ncq.read(path).check()
    assert len(str(caught.value).splitlines()) == 1


@pytest.mark.parametrize("what", ["missing.ncq", "."])
def test_what_is_no_file(tmp_path: Path, what: str) -> None:
    with pytest.raises(QueueError, match="cannot be read"):
        ncq.read(tmp_path / what)
