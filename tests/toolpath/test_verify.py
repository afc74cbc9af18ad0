"""Every invariant, broken once."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings

from nccompile.errors import InvalidToolpath
from nccompile.toolpath.columns import Curves, EventKind, Events, Kind, Plane, Toolpath
from nccompile.toolpath.verify import verify, verify_chain
from tests.toolpath.paths import paths, planned_line, rich


def changed(path: Toolpath, name: str, row: int | tuple[int, int], value: Any) -> Toolpath:
    """The path with one entry of a column (or of curves.x, events.x) exchanged."""
    table, _, column = name.rpartition(".")
    owner = getattr(path, table) if table else path
    array = getattr(owner, column).copy()
    array[row] = value
    if not table:
        return path.replace(**{column: array})
    names = (
        ("plane", "parameters")
        if table == "curves"
        else ("segment", "kind", "number", "position", "k", "l", "o")
    )
    values = [array if field == column else getattr(owner, field) for field in names]
    return path.replace(**{table: Curves(*values) if table == "curves" else Events(*values)})


def first_of(kind: Kind) -> int:
    return int(np.flatnonzero(rich().kind == kind)[0])


LINE, ARC, M, DWELL, G92 = (
    first_of(kind) for kind in (Kind.LINE, Kind.ARC, Kind.M_FUNCTION, Kind.DWELL, Kind.SET_POSITION)
)
SWITCHES = np.flatnonzero(rich().events.kind == EventKind.SWITCH).tolist()
ELLIPSE_ROW = int(rich().curve[first_of(Kind.ELLIPSE)])


def test_sound_paths_pass() -> None:
    verify(rich())
    verify(planned_line([1.0, 0.01, 5.0]))
    verify(Toolpath.empty())
    assert len(list(verify_chain([planned_line([1.0, 0.01, 5.0])]))) == 1


@settings(max_examples=40)
@given(paths())
def test_random_paths_pass(path: Toolpath) -> None:
    verify(path.replace(v_limit=None, v_junction=None, v_end=None))


DAMAGE: list[tuple[Callable[[Toolpath], Toolpath], str]] = [
    (lambda p: p.replace(kind=p.kind.astype(np.int64)), r"column kind has shape .* dtype int64"),
    (lambda p: p.replace(feed=p.feed[:-1]), "column feed has shape"),
    (lambda p: p.replace(target=p.target[:, :-1]), "column target has shape"),
    (lambda p: p.replace(v_end=p.feed), "only some of v_limit"),
    (lambda p: p.replace(axes=("X", "Y", "Z", "P", "A")), "axes X Y Z P A are not"),
    (lambda p: p.replace(axes=("X", "Y", "A", "B", "C")), "axes X Y A B C are not"),
    (lambda p: p.replace(start=p.start * np.nan), "the start position is not finite"),
    (lambda p: changed(p, "kind", LINE, 8), "a kind that does not exist"),
    (lambda p: changed(p, "target", LINE, np.inf), "the end position is not finite"),
    (lambda p: changed(p, "length", LINE, -1.0), "length is negative or not finite"),
    (lambda p: changed(p, "feed", LINE, -1.0), "feed is negative or not finite"),
    (lambda p: changed(p, "accel", LINE, np.nan), "accel is negative or not finite"),
    (lambda p: changed(p, "decel", LINE, -0.1), "decel is negative or not finite"),
    (lambda p: changed(p, "radius", LINE, np.nan), "radius is not finite"),
    (lambda p: changed(p, "line", LINE, -1), "the source line is negative"),
    (lambda p: changed(p, "profile", LINE, 1 << 5), "an S-profile bit beyond the axes"),
    (lambda p: changed(p, "mark", LINE, 256), "a mark that does not exist"),
    (lambda p: changed(p, "mark", LINE, 6), "exclude each other"),
    (lambda p: changed(p, "mark", LINE, 48), "exclude each other"),
    (lambda p: changed(p, "target", M, 9.0), "a wait moves"),
    (lambda p: changed(p, "curve", ARC, -1), "a curve without a row"),
    (lambda p: changed(p, "curve", LINE, 0), "a straight segment with a row"),
    (lambda p: changed(p, "curve", ARC, 1), "not in the order of the segments"),
    (lambda p: p.replace(curves=Curves.from_rows([(0, (1.0,))] * 20)), "20 rows in the curve table"),
    (lambda p: changed(p, "curves.parameters", 0, np.inf), "a curve parameter is not finite"),
    (lambda p: changed(p, "curves.plane", 0, 9), "a plane that does not exist"),
    (lambda p: changed(p, "curves.plane", 0, Plane.SPACE), "only polynomials run in space"),
    (lambda p: changed(p, "curves.parameters", (0, 11), 1.0), "an unused curve parameter is not 0"),
    (lambda p: changed(p, "curves.parameters", (0, 2), 0.0), "the radius is not above 0"),
    (lambda p: changed(p, "curves.parameters", (ELLIPSE_ROW, 3), -1.0), "a half-axis is not above 0"),
    (lambda p: changed(p, "curves.parameters", (0, 4), 7.0), "the sweep is 0 or over a turn"),
    (lambda p: changed(p, "curves.parameters", (0, 0), 10.0 + 1e-8), "misses the start .* by 1e-08 mm"),
    (lambda p: changed(p, "curves.parameters", (0, 4), -3.0), "misses the end of its segment"),
    (lambda p: changed(p, "curves.plane", 0, Plane.YZ), "misses the start of its segment"),
    (lambda p: changed(p, "length", ARC, float(p.length[ARC]) * (1 + 1e-11)), "the geometry's is"),
    (lambda p: changed(p, "length", G92, 1.0), "length 1.0 mm, the geometry's is 0.0 mm"),
    (
        lambda p: changed(p, "target", LINE, [0.0, 0.0, -1.0, 90.0, 0.0]).replace(length=p.length * 2),
        "geometry's",
    ),
    (lambda p: changed(p, "events.segment", -1, 99), "an event of a segment that is not in the chunk"),
    (lambda p: changed(p, "events.kind", 0, 3), "an event kind that does not exist"),
    (lambda p: changed(p, "events.position", SWITCHES[1], 1.5), r"an event outside 0\.\.1"),
    (lambda p: changed(p, "events.position", SWITCHES[1], np.nan), r"an event outside 0\.\.1"),
    (lambda p: changed(p, "events.k", 0, np.nan), "an event parameter is not finite"),
    (lambda p: changed(p, "events.o", 0, 2), "an event names data that is not in the names"),
    (lambda p: changed(p, "events.position", SWITCHES[0], 0.5), "events are not in order"),
    (lambda p: changed(p, "events.segment", SWITCHES[0], ARC), "events are not in order"),
    (
        lambda p: changed(p, "events.segment", SWITCHES[0], G92),
        "a switch point on a segment that does not move",
    ),
    (lambda p: changed(p, "events.number", SWITCHES[0], 0), "a switch point without a number"),
    (lambda p: changed(p, "events.k", -1, -1.0), "a dwell of negative time"),
    (
        lambda p: changed(p, "events.kind", SWITCHES[0], EventKind.M_FUNCTION),
        "M_FUNCTION rows and events do not",
    ),
    (lambda p: changed(p, "kind", DWELL, Kind.LINE), "DWELL rows and events do not match"),
]


@pytest.mark.parametrize(("damage", "message"), DAMAGE)
def test_damage_is_found(damage: Callable[[Toolpath], Toolpath], message: str) -> None:
    with pytest.raises(InvalidToolpath, match=message):
        verify(damage(rich()))


PLANNED_DAMAGE: list[tuple[Callable[[Toolpath], Toolpath], str]] = [
    (lambda p: changed(p, "v_limit", 1, np.nan), "v_limit is negative or not a number"),
    (lambda p: changed(p, "v_junction", 1, -1.0), "v_junction is negative or not a number"),
    (lambda p: changed(p, "v_end", 1, np.inf), "v_end is negative or not finite"),
    (lambda p: changed(p, "v_end", 1, -1.0), "v_end is negative or not finite"),
    (lambda p: changed(p, "feed", 1, 0.0), "planned feed is not above 0"),
    (lambda p: changed(p, "accel", 1, 0.0), "planned accel is not above 0"),
    (lambda p: changed(p, "decel", 1, 0.0), "planned decel is not above 0"),
    (lambda p: changed(p, "v_limit", 1, 5.0), "v_end above v_limit"),
    (lambda p: changed(p, "v_junction", 1, 5.0), "v_end above v_junction"),
    (lambda p: changed(p, "feed", 1, 5.0), "v_end above the feed"),
    (lambda p: changed(p, "v_end", 0, 21.0), "v_end above the feed"),
    (lambda p: changed(p, "accel", 0, 1.0), "v_end cannot be reached from the velocity before"),
    (lambda p: changed(p, "decel", 2, 1.0), "the velocity before cannot be braked to v_end"),
]


@pytest.mark.parametrize(("damage", "message"), PLANNED_DAMAGE)
def test_a_bad_plan_is_found(damage: Callable[[Toolpath], Toolpath], message: str) -> None:
    path = planned_line([1.0, 5.0, 1.0])
    assert path.v_end is not None
    assert path.v_end.tolist() == [10.0, 10.0, 0.0]
    with pytest.raises(InvalidToolpath, match=message):
        verify(damage(path))


def test_a_wait_has_no_velocity() -> None:
    path = rich()
    n = len(path)
    fast = path.replace(v_limit=np.full(n, 50.0), v_junction=np.full(n, 50.0), v_end=np.full(n, 1.0))
    with pytest.raises(InvalidToolpath, match="a velocity where the path stands"):
        verify(fast.replace(feed=np.full(n, 9.0), accel=np.full(n, 9.0), decel=np.full(n, 9.0)))


def test_the_message_names_segment_kind_and_source_line() -> None:
    path = changed(rich(), "length", ARC, 1.0).replace(first=100)
    line = int(path.line[ARC])
    with pytest.raises(
        InvalidToolpath, match=rf"segment {100 + ARC} \(ARC, source line {line}\): length 1\.0 mm"
    ):
        verify(path)


def test_chunks_must_fit_together() -> None:
    whole = planned_line([1.0, 5.0, 5.0, 1.0])
    one, two = whole.rows(0, 2), whole.rows(2, 4)
    assert [len(chunk) for chunk in verify_chain([one, two])] == [2, 2]
    for second, message in (
        (two.replace(start=two.start + 1.0), "does not start where the one before ended"),
        (two.replace(first=3), "the one before ends at 2"),
        (two.replace(v_limit=None, v_junction=None, v_end=None), "only one of two chunks is planned"),
        (changed(two, "v_end", -1, 1.0), "ends at 1.0 mm/s instead of 0"),
    ):
        with pytest.raises(InvalidToolpath, match=message):
            list(verify_chain([one, second]))
    with pytest.raises(InvalidToolpath, match="cannot be reached"):
        verify(two.replace(accel=two.accel * 0.01), previous_end=one.end, previous_v=0.0)
    verify(two)  # alone its first velocity is unknown
    with pytest.raises(InvalidToolpath, match="its names do not continue"):
        list(verify_chain([one.replace(names=("a",)), two.replace(names=("b",))]))
    wide = rich().replace(first=2)
    with pytest.raises(InvalidToolpath, match="its axes differ"):
        list(verify_chain([one, wide]))
