"""Variables and jumps (SoftMotion §3.2.7, §3.2.8)."""

from __future__ import annotations

import time

import pytest

from nccompile.decoder import DecodeOptions, decode
from nccompile.diagnostics import Diagnostics
from nccompile.errors import Cancelled
from nccompile.source import Source
from tests.decoder.decoding import codes_of, path_of, read, targets


def test_forward_jump() -> None:
    path = path_of("N10 G1 X1 F10", "N20 G20 L40 K1", "N30 X2", "N40 X3")
    assert targets(path) == [[1, 0, 0], [3, 0, 0]]


def test_a_jump_is_taken_for_any_condition_but_zero() -> None:
    blocks = ["N10 G1 X1 F10", "N20 G20 L40 K$k$", "N30 X2", "N40 X3"]
    assert len(path_of(*blocks, defines={"k": 0.0})) == 3
    assert len(path_of(*blocks, defines={"k": -0.001})) == 2


def test_nested_loops_with_named_variables() -> None:
    path = path_of(
        "N10 G36 O$i$ D3", "N15 G91", "N20 G36 O$j$ D4", "N30 G1 X1 F10", "N40 G37 O$j$ D-1", "N50 G20 L30 K$j$",
        "N60 G1 Y1", "N70 G37 O$i$ D-1", "N80 G20 L20 K$i$",
    )  # fmt: skip
    assert len(path) == 15
    assert targets(path)[-1] == [12, 3, 0]


def test_backward_jump_over_the_end_of_the_program_ends_it() -> None:
    assert len(path_of("N10 G1 X1 F10", "N20 G20 L40 K1", "N30 X2", "N40 G90")) == 1


def test_jump_without_condition_uses_the_implicit_variable() -> None:
    blocks = ["N20 G20 L40", "N30 G1 X2 F10", "N40 G1 X3 F10"]
    assert len(path_of(*blocks)) == 2
    assert len(path_of("N10 G36 D-1", *blocks)) == 1


def test_an_endless_loop_that_changes_nothing_is_found_at_once() -> None:
    began = time.perf_counter()
    path, found = read("% a\nN10 G36 D1\nN20 G91\nN30 G1 X1 F10\nN40 G20 L30")
    assert time.perf_counter() - began < 1.0
    assert len(path) == 2
    assert [(f.code, f.span.line) for f in found] == [("NC115", 5)]


def test_an_endless_loop_that_counts_is_stopped_by_the_limit_of_jumps() -> None:
    blocks = ["N10 G36 O$i$ D1", "N20 G37 O$i$ D1", "N30 G20 L20 K$i$"]
    _, found = read("\n".join(["% a", *blocks]), max_jumps=50)
    assert [f.code for f in found] == ["NC115"]
    assert "50 jumps" in found[0].message


def test_an_endless_loop_is_stopped_by_default_after_ten_thousand_jumps() -> None:
    _, found = read("% a\nN10 G36 O$i$ D1\nN20 G37 O$i$ D1\nN30 G20 L20 K$i$")
    assert [f.code for f in found] == ["NC115"]
    assert "10,000 jumps" in found[0].message


def test_an_endless_loop_is_stopped_by_the_limit_of_blocks() -> None:
    blocks = ["N10 G36 O$i$ D1", "N15 G91", "N20 G1 X1 F10", "N25 G37 O$i$ D1", "N30 G20 L20 K$i$"]
    path, found = read("\n".join(["% a", *blocks]), max_blocks=100)
    assert [f.code for f in found] == ["NC115"]
    assert len(path) < 100


def test_a_finding_in_a_loop_is_reported_once() -> None:
    assert codes_of("N10 G36 D9", "N20 G1 X1 K3 F10", "N30 G37 D-1", "N40 G20 L20") == ["NC105"]


def test_a_jump_to_a_block_that_could_not_be_read_blames_only_that() -> None:
    assert codes_of("N10 G1 X1..2 F10", "N20 G20 L10 K0") == ["NC003"]


def test_an_undefined_variable_lists_the_known_ones() -> None:
    _, found = read("% a\nG1 X$q$ F10", defines={"width": 1.0, "height": 2.0})
    assert found[0].code == "NC110"
    assert found[0].help.endswith("known are height, width")


def test_an_undefined_variable_is_named_by_the_nearest() -> None:
    _, found = read("% a\nG1 X$widht$ F10", defines={"Width": 1.0})
    assert found[0].help == "did you mean $Width$?"


def test_the_implicit_variable_is_an_int() -> None:
    assert codes_of("G36 D32767", "G37 D1") == ["NC112"]
    assert codes_of("G36 D1.5") == ["NC112"]


def test_huge_block_numbers_are_no_targets_but_do_no_harm() -> None:
    assert codes_of(f"N{'9' * 400} G1 X1 F10", "N20 G20 L20 K0") == []


def test_a_loop_that_nobody_waits_for_is_given_up() -> None:
    source = Source.from_bytes("loop.nc", b"%\nN5 G36 O$n$ D1\nN10 G37 O$n$ D1\nN20 G20 L10 K1\n")
    left = 3

    def wanted() -> bool:
        nonlocal left
        left -= 1
        return left > 0

    diagnostics = Diagnostics()
    with pytest.raises(Cancelled):
        list(decode(source, DecodeOptions(), diagnostics, wanted))
    assert left == 0
    assert not diagnostics.errors
