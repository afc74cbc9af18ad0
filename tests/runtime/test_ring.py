"""The ring buffer against a plain list, for any sequence of pushes and drops."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nccompile.errors import UsageError
from nccompile.runtime.ring import RingBuffer
from nccompile.toolpath.columns import Curves, Kind, Toolpath
from tests.runtime.paths import planned

SWITCH, M = 0, 1


def numbered(first: int, n: int, rng: np.random.Generator) -> Toolpath:
    """n segments with numbers of their own in every column, some curved, some with events."""
    events = [
        (int(row), SWITCH, int(rng.integers(1, 33)), float(rng.random()), float(first + row), 2.0, -1)
        for row in sorted(rng.integers(0, n, int(rng.integers(0, n + 1))))
    ]
    path = planned(rng.random((n, 3)), rng.random(3).tolist(), events=events, first_line=first)
    curved = rng.random(n) < 0.4
    curve = np.full(n, -1, np.int32)
    curve[curved] = np.arange(curved.sum())[::-1]  # table order differs from row order
    return path.replace(
        kind=np.where(curved, Kind.ARC, Kind.LINE).astype(np.uint8),
        curve=curve,
        curves=Curves(rng.integers(0, 3, curved.sum()).astype(np.uint8), rng.random((curved.sum(), 12))),
        v_end=rng.random(n),
        v_junction=rng.random(n),
        v_limit=rng.random(n),
        length=rng.random(n),
    )


def as_records(path: Toolpath, begin: int, end: int) -> list[dict[str, Any]]:
    """What each row of a chunk says, one dictionary a row."""
    starts, e = path.starts(), path.events
    return [
        {
            "line": int(path.line[r]),
            "kind": int(path.kind[r]),
            "start": starts[r].tolist(),
            "target": path.target[r].tolist(),
            "v": (path.v_limit[r], path.v_junction[r], path.v_end[r]),  # type: ignore[index]
            "length": path.length[r],
            "curve": None
            if path.curve[r] < 0
            else (int(path.curves.plane[path.curve[r]]), path.curves.parameters[path.curve[r]].tolist()),
            "events": [
                (int(e.kind[i]), int(e.number[i]), e.position[i], e.k[i], e.l[i])
                for i in np.flatnonzero(e.segment == r)
            ],
        }
        for r in range(begin, end)
    ]


def as_seen(ring: RingBuffer) -> list[dict[str, Any]]:
    """The same from the reader's view of a ring buffer."""
    rows, head, tail, _, _ = ring.view()
    return [
        {
            "line": int(rows.line[r]),
            "kind": int(rows.kind[r]),
            "start": rows.start[r].tolist(),
            "target": rows.target[r].tolist(),
            "v": (rows.v_limit[r], rows.v_junction[r], rows.v_end[r]),
            "length": rows.length[r],
            "curve": None
            if rows.curve[r] < 0
            else (int(rows.plane[rows.curve[r]]), rows.parameters[rows.curve[r]].tolist()),
            "events": [(e.kind, e.number, e.position, e.k, e.l) for e in ring.events(r - head)],
        }
        for r in range(head, tail)
    ]


@settings(max_examples=60, deadline=None)
@given(
    capacity=st.integers(1, 12),
    seed=st.integers(0, 2**32 - 1),
    steps=st.lists(st.tuples(st.booleans(), st.integers(0, 15)), max_size=40),
)
def test_any_pushes_and_drops_equal_a_list(capacity: int, seed: int, steps: list[tuple[bool, int]]) -> None:
    rng = np.random.default_rng(seed)
    ring, line = RingBuffer(("X", "Y", "Z"), capacity), 1
    model: list[dict[str, Any]] = []
    for push, n in steps:
        if push and n:
            chunk = numbered(line, n, rng)
            begin = int(rng.integers(0, n))
            taken = ring.push(chunk, begin)
            assert taken == min(n - begin, capacity - len(model))
            model += as_records(chunk, begin, begin + taken)
            line += n
        elif not push:
            n = min(n, len(model))
            ring.drop(n)
            model = model[n:]
        assert ring.count == len(model)
        assert ring.free == capacity - len(model)
        assert as_seen(ring) == model


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), event_capacity=st.integers(1, 6))
def test_rows_wait_for_room_for_their_events(seed: int, event_capacity: int) -> None:
    rng = np.random.default_rng(seed)
    per_row = rng.integers(0, event_capacity + 1, 30)
    events = [(row, SWITCH, 1, 0.5, 0.0, 0.0, -1) for row in range(30) for _ in range(per_row[row])]
    chunk = planned(rng.random((30, 3)), events=events)
    ring, taken, seen = RingBuffer(("X", "Y", "Z"), 8, event_capacity), 0, 0
    while seen < 30:
        more = ring.push(chunk, taken)
        taken += more
        assert ring.count > 0  # never stuck: a row's events fit into an empty buffer
        assert sum(per_row[seen:taken]) <= event_capacity
        assert [len(ring.events(r)) for r in range(ring.count)] == per_row[seen:taken].tolist()
        gone = int(rng.integers(1, ring.count + 1))
        ring.drop(gone)
        seen += gone


def test_a_reader_keeps_its_rows_while_others_are_pushed() -> None:
    ring = RingBuffer(("X", "Y", "Z"), 4)
    rng = np.random.default_rng(7)
    ring.push(numbered(1, 4, rng))
    for line in range(5, 400):
        ring.drop(1)
        view = ring.view()
        columns: tuple[npt.NDArray[Any], ...] = (view.rows.line, view.rows.target, view.rows.event_begin)
        before = [column[view.head : view.tail].copy() for column in columns]
        ring.push(numbered(line, 1, rng))
        for column, kept in zip(columns, before, strict=True):
            np.testing.assert_array_equal(column[view.head : view.tail], kept)
        assert ring.view().rows.line[ring.view().head] == line - 3


def test_rewind_brings_dropped_rows_back() -> None:
    ring = RingBuffer(("X", "Y", "Z"), 4)
    ring.push(planned([[1, 0, 0], [2, 0, 0], [3, 0, 0]]))
    mark = ring.mark()
    before = as_seen(ring)
    ring.drop(2)
    ring.rewind(mark)
    assert as_seen(ring) == before
    ring.push(planned([[4, 0, 0]], [3, 0, 0]))
    with pytest.raises(UsageError, match="pushed since the mark"):
        ring.rewind(mark)


def test_events_carry_parameters_and_names() -> None:
    ring = RingBuffer(("X", "Y", "Z"), 4)
    ring.push(
        planned([[0, 0, 0]], kind=Kind.M_FUNCTION, events=[(0, M, 7, 0.0, 1.5, -2.5, 0)], names=("clamp",))
    )
    (event,) = ring.events(0)
    assert (event.kind, event.number, event.k, event.l, event.o) == (M, 7, 1.5, -2.5, "clamp")


def test_closing_is_seen_by_the_reader() -> None:
    ring = RingBuffer(("X", "Y", "Z"), 4)
    assert not ring.view().complete
    ring.close()
    assert ring.view().complete
    assert ring.end_of_list


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: RingBuffer(("X",), 0), "at least one segment"),
        (lambda: RingBuffer(("X", "Y", "Z"), 2).drop(1), "cannot drop 1 of 0"),
        (lambda: RingBuffer(("X", "Y"), 2).push(planned([[1, 0, 0]])), "for axes X Y, not X Y Z"),
        (lambda: RingBuffer(("X", "Y", "Z"), 2).push(Toolpath.empty()), "only a planned toolpath"),
        (
            lambda: RingBuffer(("X", "Y", "Z"), 2, 1).push(
                planned(
                    [[1, 0, 0]], events=[(0, 0, 1, 0.1, 0, 0, -1), (0, 0, 2, 0.2, 0, 0, -1)], first_line=9
                )
            ),
            "line 9 has more switch points",
        ),
    ],
)
def test_wrong_use_is_refused(call: Any, message: str) -> None:
    with pytest.raises(UsageError, match=message):
        call()
