"""H with O and L (SoftMotion §3.2.1), and the marks of path passes (§6.6)."""

from __future__ import annotations

import pytest

from nccompile.toolpath import Mark
from tests.decoder.decoding import codes_of, path_of, read, switches


def test_each_h_goes_with_the_place_after_it() -> None:
    path = path_of("G1 X10 F10 H1 O0.25 H-1 L-2 H2 H3 L5")
    assert switches(path) == [(0, 2, 0.0), (0, 1, 0.25), (0, 3, 0.5), (0, -1, 0.8)]


def test_a_switch_may_stand_before_the_target() -> None:
    assert switches(path_of("G1 H1 O0.5 X10 F10")) == [(0, 1, 0.5)]


def test_a_block_with_a_switch_only_repeats_the_instruction() -> None:
    path = path_of("G1 X10 F10", "H4")
    assert switches(path) == [(1, 4, 0.0)]
    assert path.length.tolist() == [10, 0]


def test_a_place_from_a_variable() -> None:
    assert switches(path_of("G1 X10 F10 H1 O$q$", defines={"q": 0.75})) == [(0, 1, 0.75)]


@pytest.mark.parametrize("words", ["H1 O-0.1", "H1 O1.01", "H1 L10.1", "H1 L-10.1"])
def test_a_place_off_the_path_object_is_an_error(words: str) -> None:
    assert codes_of(f"G1 X10 F10 {words}") == ["NC117"]


def test_both_ends_of_the_path_object_are_on_it() -> None:
    assert [p for *_, p in switches(path_of("G1 X10 F10 H1 L-10 H2 L10 H3 O0 H4 O1"))] == [0, 0, 1, 1]


def test_max_switches() -> None:
    assert codes_of("G1 X10 F10 H1 H2 H3", max_switches=2) == ["NC118"]
    assert codes_of("G1 X10 F10 H1 H2 H3", max_switches=3) == []


def test_marks_start_at_the_next_and_stop_at_the_last_path_object() -> None:
    path = path_of(
        "G1 X1 F10", "G41 D3", "M5", "X2", "X3", "G4 T1", "G40", "X4", "G51", "G61", "X5", "G50", "G52", "X6", "G60",
        "G50", "X7",
    )  # fmt: skip
    drives = {
        round(float(x)): Mark(int(m))
        for x, m, n in zip(path.target[:, 0], path.mark, path.length, strict=True)
        if n
    }
    assert drives == {
        1: Mark(0),
        2: Mark.TOOL_LEFT,
        3: Mark.TOOL_STOP,
        4: Mark(0),
        5: Mark.SMOOTH | Mark.LOOP | Mark.CORNER_STOP,
        6: Mark.ROUND | Mark.CORNER_STOP | Mark.LOOP_STOP,
        7: Mark(0),
    }
    assert path.mark[path.length == 0].tolist() == [0, 0]
    assert path.radius.tolist() == [0, 3, 3, 3, 3, 3, 3, 3, 3]


def test_a_pair_without_a_path_object_leaves_no_mark() -> None:
    assert path_of("G1 X1 F10", "G42", "G40", "X2", "G40", "G50", "G60").mark.tolist() == [0, 0]


def test_what_is_not_ended_ends_with_the_program() -> None:
    path, found = read("% a\nG1 X1 F10\nG42 D2\nG1 X2\nG1 X3")
    assert path.mark.tolist() == [0, Mark.TOOL_RIGHT, Mark.TOOL_STOP]
    assert [(f.code, f.span.line) for f in found] == [("NC125", 3)]
