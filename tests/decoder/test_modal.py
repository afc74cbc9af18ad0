"""Words, modal state and instructions (SoftMotion §3.2)."""

from __future__ import annotations

from math import sqrt

import pytest

from nccompile.decoder import DecodeOptions, decode
from nccompile.diagnostics import Diagnostics
from nccompile.errors import UsageError
from nccompile.source import Source
from nccompile.toolpath import EventKind, Kind
from tests.decoder.decoding import codes_of, kinds, path_of, read, targets


def test_of_a_repeated_word_the_leftmost_holds() -> None:
    path, found = read("% a\nN10 G1 X1 X2 X3 F10")
    assert targets(path) == [[1, 0, 0]]
    assert [(f.code, f.span.column) for f in found] == [("NC104", 11)]


def test_acceleration_and_deceleration_stand_in_one_block() -> None:
    path = path_of("G1 X1 F10 E2000 E-500", "X2 E-700", "X3 E100")
    assert path.accel.tolist() == [2000, 2000, 100]
    assert path.decel.tolist() == [500, 700, 700]


def test_a_block_with_modal_words_only_moves_nothing() -> None:
    path = path_of("G1 X1 F10", "F20 E300 D4", "G1 F30", "X2")
    assert targets(path) == [[1, 0, 0], [2, 0, 0]]
    assert path.feed.tolist() == [10, 30]
    assert path.accel.tolist() == [0, 300]
    assert path.radius.tolist() == [0, 4]


def test_feed_zero_means_none_was_programmed() -> None:
    path, found = read("% a\nG0 X1\nG1 X2\nG1 X3 F5")
    assert path.feed.tolist() == [0, 0, 5]
    assert [f.code for f in found] == ["NC101"]


def test_relative_targets() -> None:
    path = path_of("G1 X10 Y5 F10", "G91", "X2 Z-1", "X-4", "G90", "X1")
    assert targets(path) == [[10, 5, 0], [12, 5, -1], [8, 5, -1], [1, 5, -1]]


def test_the_last_drive_instruction_survives_other_instructions() -> None:
    path = path_of("G1 X1 F10", "G90", "G36 D1", "M5", "G92 X0", "X2")
    assert kinds(path) == [Kind.LINE, Kind.M_FUNCTION, Kind.SET_POSITION, Kind.LINE]


def test_before_any_instruction_a_block_is_a_positioning() -> None:
    path, found = read("% a\nX5\nG1 X6 F1")
    assert kinds(path) == [Kind.POSITIONING, Kind.LINE]
    assert [f.code for f in found] == ["NC106"]


def test_zero_length_moves_stay() -> None:
    path = path_of("G1 X0 F10", "G0 X0", "G1 X0 Y0 Z0")
    assert kinds(path) == [Kind.LINE, Kind.POSITIONING, Kind.LINE]
    assert path.length.tolist() == [0, 0, 0]


def test_start_position_and_additional_axes() -> None:
    path = path_of("G1 X1 P10 C90 F10", "Q-4", start={"z": 7.0, "W": 2.0})
    assert path.axes == ("X", "Y", "Z", "C", "P", "Q", "W")
    assert path.start.tolist() == [0, 0, 7, 0, 0, 0, 2]
    assert targets(path) == [[1, 0, 7, 90, 10, 0, 2], [1, 0, 7, 90, 10, -4, 2]]
    assert path.length.tolist() == [1, 4]


@pytest.mark.parametrize("text", ["(P5 in a comment)", "G36 O$p1$ D2", "PNone X1"])
def test_letters_outside_words_name_no_axis(text: str) -> None:
    decoded = decode(Source("a.nc", f"% part P1\n{text}\nG1 X1 F1"), DecodeOptions(), Diagnostics())
    assert decoded.axes == ("X", "Y", "Z")
    assert decoded.header == "part P1"


def test_dwell_takes_t_or_f_and_leaves_the_feed() -> None:
    path = path_of("G1 X1 F10", "G4 T0.5", "G4 F2", "X2")
    assert kinds(path) == [Kind.LINE, Kind.DWELL, Kind.DWELL, Kind.LINE]
    assert path.events.kind.tolist() == [EventKind.DWELL] * 2
    assert path.events.k.tolist() == [0.5, 2.0]
    assert path.feed.tolist() == [10] * 4


def test_m_parameters() -> None:
    path = path_of("M10 K1.5 L-2 O$g_data$", "M11 O7", "M12 O$g_data$", "M13")
    e = path.events
    assert e.number.tolist() == [10, 11, 12, 13]
    assert e.k.tolist() == [1.5, 0, 0, 0]
    assert e.l.tolist() == [-2, 0, 0, 0]
    assert [path.names[o] if o >= 0 else None for o in e.o] == ["g_data", "7", "g_data", None]


def test_s_profile_bits_follow_the_axes() -> None:
    path = path_of("G1 X3 Z4 P1 F10 S3 S8", "X6 Z8 Q1 S-3", "G1 P5 S7", start={"X": 0.0})
    z, p, q = (path.axes.index(letter) for letter in "ZPQ")
    assert path.profile.tolist() == [1 << z | 1 << q, 1 << q, 1 << p | 1 << q]
    assert path.length.tolist() == [3, 5, 4]  # an axis in the S-profile follows: it adds no length


def test_values_from_variables() -> None:
    path = path_of(
        "G36 O$Width$ D40",
        "G1 X$width$ F$f$",
        "G37 O$WIDTH$ D$step$",
        "X$width$",
        defines={"f": 9, "step": 2},
    )
    assert path.axes == ("X", "Y", "Z")
    assert targets(path) == [[40, 0, 0], [42, 0, 0]]
    assert path.feed.tolist() == [9, 9]


def test_skip_blocks() -> None:
    blocks = ["G1 X1 F10", "/ N20 X2", "X3"]
    assert len(path_of(*blocks)) == 3
    assert targets(path_of(*blocks, skip_blocks=True)) == [[1, 0, 0], [3, 0, 0]]


def test_python_none_is_left_out() -> None:
    path, found = read("% a\nN10 GNone X1 YNONE F10\n")
    assert targets(path) == [[1, 0, 0]]
    assert sorted(f.code for f in found) == ["NC013", "NC013", "NC106"]


def test_ignored_words() -> None:
    assert len(path_of("M107", "G1 X1 E0.1 F5", ignore=frozenset({"M107", "E"}))) == 1


def test_words_without_effect_do_not_move() -> None:
    path, found = read("% a\nG1 X1 F10\nG90 X50\nM5 Y50\nX2")
    assert targets(path)[-1] == [2, 0, 0]
    assert [f.code for f in found] == ["NC105", "NC105"]


def test_set_position_under_g91_is_absolute() -> None:
    path, found = read("% a\nG1 X5 F1\nG91\nG92 X1\nG1 X1")
    assert targets(path) == [[5, 0, 0], [1, 0, 0], [2, 0, 0]]
    assert [f.code for f in found] == ["NC129"]


def test_a_bad_block_is_left_out_and_the_rest_is_read() -> None:
    path, found = read("% a\nG1 X1 F10\nG1 X1.2.3\nX2\nG1 G0\nX3")
    assert targets(path) == [[1, 0, 0], [2, 0, 0], [3, 0, 0]]
    assert [f.span.line for f in found] == [3, 5]


def test_what_a_bad_block_may_have_set_is_not_missed() -> None:
    assert codes_of("G1 X1..2 F10", "G1 X2") == ["NC003"]


def test_path_length_is_that_in_space() -> None:
    path = path_of("G1 X1 Y2 Z2 F10", "G3 X-1 Y2 Z5 R1")
    assert path.length[0] == 3
    assert path.length[1] == pytest.approx(sqrt(3.141592653589793**2 + 9), rel=1e-12)


@pytest.mark.parametrize(
    "options",
    [{"start": {"N": 1.0}}, {"start": {"X": float("nan")}}, {"defines": {"a": float("inf")}}, {"chunk": 0}],
)
def test_options_without_sense_are_refused(options: dict[str, object]) -> None:
    with pytest.raises(UsageError):
        DecodeOptions(**options)  # type: ignore[arg-type]


def test_a_program_without_motion_is_one_empty_chunk() -> None:
    chunks = list(decode(Source("a.nc", "% a\nG92 X5\nG90"), DecodeOptions(), Diagnostics()))
    assert [len(chunk) for chunk in chunks] == [0]
    assert chunks[0].start.tolist() == [5, 0, 0]
