"""The OutQueue file: written and read back to the bit, whole or not there."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from nccompile.backend import ncq
from nccompile.errors import InvalidToolpath, UsageError
from nccompile.toolpath import Toolpath
from nccompile.toolpath.text import format_toolpath, parse_toolpath
from nccompile.toolpath.verify import verify
from tests.backend.paths import PROVENANCE, planned, same, small
from tests.interpolator.third_order import levels, plan_of


def _write(path: Path, *chunks: Toolpath) -> ncq.Meta:
    meta = ncq.write(path, iter(chunks), PROVENANCE, lambda: 1.25)
    assert meta is not None
    return meta


def test_a_queue_reads_back_to_the_bit(tmp_path: Path) -> None:
    path = tmp_path / "part.ncq"
    written = _write(path, small())
    queue = ncq.read(path).check()
    assert queue.meta == written
    (chunk,) = queue.chunks()
    assert same(chunk, small())


def test_chunks_follow_each_other(tmp_path: Path) -> None:
    path = tmp_path / "part.ncq"
    whole = small()
    _write(path, whole.rows(0, 2), whole.rows(2, 3), whole.rows(3, 5))
    chunks = list(ncq.read(path).chunks())
    assert [len(c) for c in chunks] == [2, 1, 2]
    assert same(Toolpath.join(chunks), whole)


def test_totals(tmp_path: Path) -> None:
    totals = _write(tmp_path / "part.ncq", small()).totals
    assert (totals.segments, totals.switches, totals.m_functions) == (5, 1, (8,))
    assert (totals.length, totals.rapid_length, totals.job_time) == (3.0, 1.0, 1.25)
    assert totals.box["X"] == (0.0, 11.5)
    assert totals.box["Y"] == (-1.0, 1.0)


def test_totals_do_not_depend_on_the_chunk_size(tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    path = planned([1] * 100, rng.normal(size=(100, 3)).tolist()).replace(length=rng.random(100))
    one = _write(tmp_path / "one.ncq", path).totals
    many = _write(tmp_path / "many.ncq", *(path.rows(i, i + 7) for i in range(0, 100, 7))).totals
    assert one == many


def test_equal_toolpaths_give_equal_bytes(tmp_path: Path) -> None:
    _write(tmp_path / "one.ncq", small())
    _write(tmp_path / "two.ncq", small())
    assert (tmp_path / "one.ncq").read_bytes() == (tmp_path / "two.ncq").read_bytes()


def test_numpy_opens_a_queue(tmp_path: Path) -> None:
    path = tmp_path / "part.ncq"
    _write(path, small())
    with np.load(path, allow_pickle=False) as members:
        assert np.array_equal(members["chunk000000/target"], small().target)
        assert json.loads(members["meta.json"])["format"] == "nccompile-outqueue"


@pytest.mark.parametrize(
    "chunks", [[], [Toolpath.empty().replace(v_limit=np.zeros(0), v_junction=np.zeros(0), v_end=np.zeros(0))]]
)
def test_a_program_without_motion_is_a_queue(tmp_path: Path, chunks: list[Toolpath]) -> None:
    path = tmp_path / "empty.ncq"
    _write(path, *chunks)
    assert ncq.read(path).check().total.segments == 0


@pytest.mark.parametrize("exception", [ValueError, KeyboardInterrupt])
def test_an_exception_leaves_no_file(tmp_path: Path, exception: type[BaseException]) -> None:
    def broken() -> Iterator[Toolpath]:
        yield small()
        raise exception

    with pytest.raises(exception):
        ncq.write(tmp_path / "part.ncq", broken(), PROVENANCE, lambda: 0.0)
    assert list(tmp_path.iterdir()) == []


def test_a_refused_queue_leaves_the_old_one(tmp_path: Path) -> None:
    path = tmp_path / "part.ncq"
    path.write_text("old")
    assert ncq.write(path, iter([small()]), PROVENANCE, lambda: 0.0, keep=lambda: False) is None
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_the_file_obeys_the_umask(tmp_path: Path) -> None:
    old = os.umask(0o027)
    try:
        _write(tmp_path / "part.ncq", small())
    finally:
        os.umask(old)
    assert (tmp_path / "part.ncq").stat().st_mode & 0o777 == 0o640


def test_a_link_keeps_pointing(tmp_path: Path) -> None:
    target, link = tmp_path / "target.ncq", tmp_path / "link.ncq"
    target.write_text("old")
    link.symlink_to(target)
    _write(link, small())
    assert link.is_symlink()
    assert ncq.read(target).total.segments == 5


@pytest.mark.parametrize("place", [".", "no/such/folder/part.ncq"])
def test_a_place_that_cannot_be_written(tmp_path: Path, place: str) -> None:
    with pytest.raises(UsageError, match=r"cannot be written|is not a file"):
        _write(tmp_path / place, small())


def test_only_planned_paths_are_written(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="planned"):
        _write(tmp_path / "part.ncq", small().replace(v_end=None))
    assert list(tmp_path.iterdir()) == []


def test_a_third_order_plan_keeps_its_columns(tmp_path: Path) -> None:
    path = plan_of(levels([50.0, 20.0], [0.1, 0.1]), 2)
    verify(path)
    place = tmp_path / "part.ncq"
    _write(place, path.rows(0, 5), path.rows(5, len(path)))
    queue = ncq.read(place).check()
    assert queue.meta.third_order
    assert same(Toolpath.join(list(queue.chunks())), path)
    assert same(parse_toolpath(format_toolpath(path)), path)
    assert path.a_end is not None
    with pytest.raises(InvalidToolpath, match="v_end is not where the jerk leads to"):
        verify(path.replace(a_end=path.a_end * 0.9))
