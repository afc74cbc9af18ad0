"""The text form: there and back to the bit, chunked or not, and precise complaints."""

from __future__ import annotations

from dataclasses import fields

import numpy as np
import pytest
from hypothesis import given, settings

from nccompile.errors import UsageError
from nccompile.toolpath.columns import Curves, Events, Toolpath
from nccompile.toolpath.text import format_toolpath, format_toolpaths, parse_toolpath
from tests.toolpath.paths import Builder, paths, planned_line, rich


def assert_same_bits(a: object, b: object) -> None:
    """Equal to the last bit, dtypes and shapes included."""
    assert type(a) is type(b)
    if isinstance(a, np.ndarray) and isinstance(b, np.ndarray):
        assert (a.dtype, a.shape) == (b.dtype, b.shape)
        assert a.tobytes() == b.tobytes()
    elif isinstance(a, (Toolpath, Curves, Events)):
        for field in fields(a):
            assert_same_bits(getattr(a, field.name), getattr(b, field.name))
    else:
        assert a == b


def test_every_kind_of_segment_reads_back_to_the_bit() -> None:
    assert_same_bits(parse_toolpath(format_toolpath(rich())), rich())


@settings(max_examples=60)
@given(paths())
def test_any_path_reads_back_to_the_bit(path: Toolpath) -> None:
    text = format_toolpath(path)
    assert_same_bits(parse_toolpath(text), path)
    assert format_toolpath(parse_toolpath(text)) == text


def test_a_planned_path_reads_back_to_the_bit() -> None:
    path = planned_line([1.0, 0.1, 3.0])
    limits = np.array([np.inf, 5.0, -0.0])
    assert_same_bits(
        parse_toolpath(format_toolpath(path.replace(v_limit=limits))), path.replace(v_limit=limits)
    )


def test_the_text_does_not_depend_on_the_chunks() -> None:
    whole = rich()
    parts = [whole.rows(at, at + 3) for at in range(0, len(whole), 3)]
    assert "\n".join(format_toolpaths(parts)) + "\n" == format_toolpath(whole)


def test_what_is_zero_is_left_out() -> None:
    from nccompile.toolpath.columns import Kind

    path = Builder(axes=("X", "Y", "Z"), at=[0.0] * 3).add(Kind.LINE, X=10.0).path()
    path = path.replace(mark=path.mark * 0, radius=path.radius * 0, accel=path.accel * 0)
    assert format_toolpath(path) == (
        "toolpath 1\naxes X Y Z\nstart 0.0 0.0 0.0\nline 10.0 0.0 0.0 length 10.0 feed 20.0 source 3\n"
    )


def test_comments_and_blank_lines_are_ignored() -> None:
    text = '# a case\ntoolpath 1\n\naxes X Y Z  # all\nstart 0 0 0\r\nname "a # b"\nline 1 2 3 length 3.5 # far\n'
    path = parse_toolpath(text)
    assert path.names == ("a # b",)
    assert path.target.tolist() == [[1.0, 2.0, 3.0]]
    assert path.length.tolist() == [3.5]


HEAD = "toolpath 1\naxes X Y Z\nstart 0 0 0\n"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "line 1 .* the text is empty"),
        ("line 1 2 3\n", 'line 1 .* a toolpath text starts with "toolpath 1"'),
        ("toolpath 2\n", 'line 1 .* a toolpath text starts with "toolpath 1"'),
        ("toolpath 1\naxes X Y Z\n", "axes or start is missing"),
        ("toolpath 1\naxes X Y Z\nline 1 2 3\n", "line 3 .* axes and start with as many numbers"),
        (HEAD + "curve 1 2 3\n", "line 4 .* unknown word 'curve'"),
        (HEAD + "line 1 2\n", "line 4 .* a number is missing"),
        (HEAD + "line 1 2 3 length\n", "line 4 .* a number is missing"),
        (HEAD + "line 1 2 3 size 4\n", "line 4 .* unknown word 'size'"),
        (HEAD + "line 1 2 3 v_end 4\n", "line 4 .* unknown word 'v_end'"),
        (HEAD + "line 1 2 x\n", "line 4 .* could not convert"),
        (HEAD + "line 1 2 3 mark 70000\n", "line 4 .* out of bounds"),
        (HEAD + "line 1 2 3 xy center 0 0\n", "line 4 .* line does not take center 0 0"),
        (HEAD + "arc 1 2 3 xy center 0 0 radius 1\n", "line 4 .* a number is missing"),
        (HEAD + "arc 1 2 3 xy radius 1\n", "line 4 .* center expected instead of radius"),
        (HEAD + "arc 1 2 3 xy center 0 0 radius 1 start 0 sweep 1 tilt 4\n", "arc does not take tilt 4"),
        (HEAD + "switch 1 at 0.5\n", "line 4 .* an event before the first row"),
        (HEAD + "line 1 2 3\nswitch 1 at\n", "line 5 .* a number is missing"),
        (HEAD + "line 1 2 3\nswitch 1 by 0.5\n", "line 5 .* unknown word 'by'"),
        (HEAD + "name x\n", "line 4 "),
    ],
)
def test_a_wrong_line_is_named(text: str, message: str) -> None:
    with pytest.raises(UsageError, match=message):
        parse_toolpath(text)


def test_chunks_of_different_axes_are_not_one_path() -> None:
    with pytest.raises(UsageError, match="differ in their axes"):
        list(format_toolpaths([rich(), planned_line([1.0])]))
