"""The toolpath does not depend on the chunk size; programs of any content decode or give findings."""

from __future__ import annotations

from dataclasses import fields

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from nccompile.decoder import DecodeOptions, decode
from nccompile.diagnostics import Diagnostics, render
from nccompile.source import Source
from nccompile.toolpath import Curves, Events, Toolpath
from nccompile.toolpath.verify import verify_chain

places = st.integers(-20, 20).map(lambda n: n / 2)


@st.composite
def blocks(draw: st.DrawFn) -> str:
    """A block that mostly makes sense."""
    x, y, z, p = (draw(places) for _ in range(4))
    number = draw(st.integers(1, 9))
    return draw(
        st.sampled_from([
            f"G1 X{x} Y{y}", f"G0 X{x} Y{y} Z{z}", f"G5 X{x} Y{y}", f"G5 X{x} Y{y} Z{z} H{number} O0.5", f"X{x} P{p}",
            f"G2 X{x} Y{y} R{abs(z) + 1}", f"G3 X{x} Y{y} I{z} J{p}", f"G3 I{number} J0", f"G6 X{x} Y{y} I{z} J{p}",
            f"G9 X{x} Y{y} I{z} J{p} K{number} R0.5", f"G92 X{x} Y{y}", f"M{number} K{x} O$v{number}$", "G4 T1",
            f"G41 D{number}", "G40", "G51", "G50", "G61", "G60", "G91", "G90", "G98", "G99", f"S{number}", "S-3",
            f"F{number} E{number} E-{number}", f"G1 Z{z} H{number} H-{number} O1",
        ])
    )  # fmt: skip


programs = st.lists(blocks(), max_size=40).map(lambda rows: "\n".join(["% p", *rows]))


def whole(program: str, size: int) -> Toolpath:
    source = Source("a.nc", program)
    chunks = list(verify_chain(decode(source, DecodeOptions(chunk=size), Diagnostics())))
    assert all(len(chunk) == size for chunk in chunks[:-1])
    return Toolpath.join(chunks)


def assert_equal(one: object, two: object) -> None:
    if isinstance(one, (Toolpath, Curves, Events)):
        for part in fields(one):
            assert_equal(getattr(one, part.name), getattr(two, part.name))
    else:
        assert np.array_equal(one, two) if isinstance(one, np.ndarray) else one == two  # type: ignore[arg-type]


@settings(max_examples=120, deadline=None)
@given(programs, st.integers(1, 7))
def test_the_result_does_not_depend_on_the_chunk_size(program: str, size: int) -> None:
    assert_equal(whole(program, size), whole(program, 4096))


def assert_read_or_reported(text: str) -> None:
    """A program decodes to a sound toolpath, with small limits, and all its findings can be shown."""
    source = Source("a.nc", text)
    diagnostics = Diagnostics()
    options = DecodeOptions(max_jumps=50, max_blocks=200, chunk=3)
    for _ in verify_chain(decode(source, options, diagnostics)):
        pass
    assert all(render(found, source) for found in diagnostics)


@settings(max_examples=150, deadline=None)
@given(st.text(max_size=200))
def test_any_text_is_read_or_reported(text: str) -> None:
    assert_read_or_reported(text)


@settings(max_examples=100, deadline=None)
@given(st.binary(max_size=300))
def test_any_bytes_are_read_or_reported(data: bytes) -> None:
    source = Source.from_bytes("a.nc", data)
    assert_read_or_reported(source.text)


alphabet = st.text("%NGXYZFEHLOKRIJDMSTP()/$0123456789.-+ \n_a", max_size=120)


@settings(max_examples=300, deadline=None)
@given(alphabet)
def test_any_words_are_read_or_reported(text: str) -> None:
    assert_read_or_reported("% a\n" + text)


@settings(max_examples=150, deadline=None)
@given(programs, st.integers(0, 400), st.sampled_from(list("NGX$%(.-9\n \x00")))
def test_a_mutated_program_is_read_or_reported(program: str, at: int, put: str) -> None:
    at = min(at, len(program))
    assert_read_or_reported(program[:at] + put + program[at + 1 :])


@settings(max_examples=100, deadline=None)
@given(st.lists(st.tuples(st.integers(0, 5), st.integers(0, 6), st.integers(-1, 1)), min_size=1, max_size=6))
def test_any_jumps_end(jumps: list[tuple[int, int, int]]) -> None:
    rows = [f"N{i} G37 D{step}\nG20 L{to}" for i, (_, to, step) in enumerate(jumps)]
    assert_read_or_reported("\n".join(["% a", "G36 D1", *rows]))
