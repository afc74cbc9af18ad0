"""Both routes make the same toolpath and the same findings of every program."""

from __future__ import annotations

import random
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import nccompile.source as source_module
from nccompile.errors import UsageError
from nccompile.kernels import compiled, use
from nccompile.parser import scanner
from nccompile.source import LargeSource, Source
from tests.scanner.routes import compare, damaged, decoded, differences, large

SAMPLES = sorted((Path(__file__).parents[2] / "samples").glob("*.nc"))

_PLACES = st.integers(-40, 40).map(lambda n: f"{n / 4:g}")
_COMMON = [
    "G1 X{a} Y{b}", "G0 X{a} Y{b} Z{c}", "X{a}", "Y{b} Z{c}", "G01X{a}Y{b}F{n}", "G1 P{a}", "X{a} P{b}",
    "g2 x{a} y{b} r{n}",
    "G3 X{a} Y{b} I{c} J{a}",
    "G2 I{n} J0", "G3 X{a} R20", "I1 J2", "G3 X{a} Y{b} I{n} J0 Z{c}", "F{n}", "E{n} E-{n}", "G1", "G2",
    "G90", "G91", "G98", "G99", "D{n}", "N{n} G1 X{a}", "N{n}", "(note)", "", "G1 X{a} (note) Y{b}", "G1 X{a}\t",
]  # fmt: skip
_OTHERS = [
    "G5 X{a} Y{b}", "G6 X{a} Y{b} I{c} J{a}", "G9 X{a} Y{b} I{c} J{a} K{n} R0.5", "G92 X{a}", "M{n}", "G4 T1",
    "G41 D{n}", "G40", "G42",
    "G51", "G50", "G61", "G60", "S3", "S-3", "H{n}", "G1 X{a} H1 O0.5", "G1 X{a} X{b}", "X$w$", "G36 O$w$ D{n}",
    "/ G1 X{a}", "XNone Y1",
    "G1 Y", "G17", "X1 G1", "G1 X1e10", "E0.5", "F-1", "F0", "G1 I1", "G2 X{a} I1 R1", "G1.5 X1", "D-1", "X1..2",
    "G90 X5", "T1", "L2",
    "%", "G1 X{a} äöü", "X1000000001", "G91 X900000000", "M3 G1",
]  # fmt: skip


@st.composite
def blocks(draw: st.DrawFn) -> str:
    shape = draw(st.sampled_from(_COMMON * 3 + _OTHERS))
    a, b, c = (draw(_PLACES) for _ in range(3))
    return shape.format(a=a, b=b, c=c, n=draw(st.integers(1, 30)))


PROGRAMS = st.lists(blocks(), max_size=50).flatmap(
    lambda rows: st.sampled_from(["\n", "\n", "\r\n", "\r"]).map(
        lambda end: end.join(["% p", *rows]).encode()
    )
)


@settings(max_examples=300, deadline=None)
@given(PROGRAMS, st.sampled_from([1, 3, 17, 1 << 20]), st.sampled_from([1, 2, 5, 4096]))
def test_random_programs(data: bytes, part: int, chunk: int) -> None:
    compare(data, part, chunk=chunk)


_JUMPS = [
    "G36 O$i$ D{n}",
    "G37 O$i$ D-1",
    "G20 L{n} K$i$",
    "G20 L{n}",
    "N{n} G1 X{a}",
    "N{n} X$i$",
    "N{n}",
    "(note)",
    "G37 D-1",
    "G36 D3",
]


@st.composite
def jumping(draw: st.DrawFn) -> str:
    shape = draw(st.sampled_from(_JUMPS))
    return shape.format(a=draw(_PLACES), n=draw(st.integers(1, 12)))


@settings(max_examples=300, deadline=None)
@given(
    st.lists(st.one_of(jumping(), blocks()), max_size=40),
    st.sampled_from([1, 17, 1 << 20]),
    st.sampled_from([1, 5, 4096]),
)
def test_programs_with_jumps(rows: list[str], part: int, chunk: int) -> None:
    program = "\n".join(["% p", "G1 F10", "N10 G36 O$i$ D5", *rows, "N20 G37 O$i$ D-1", "G20 L10 K$i$"])
    compare(program.encode(), part, chunk=chunk, max_jumps=30, max_blocks=200)


@settings(max_examples=60, deadline=None)
@given(PROGRAMS, st.booleans(), st.sampled_from([{}, {"X": 5.0, "P": 1.0}]))
def test_options(data: bytes, skip: bool, start: dict[str, float]) -> None:
    compare(data, skip_blocks=skip, start=start, defines={"w": 3.0})


@settings(max_examples=100, deadline=None)
@given(st.binary(max_size=80))
def test_any_bytes(data: bytes) -> None:
    compare(data, 7)


@pytest.mark.parametrize("sample", SAMPLES, ids=lambda path: path.stem)
def test_samples_and_damaged_copies(sample: Path) -> None:
    data = sample.read_bytes()
    compare(data)
    generator = random.Random(sample.stem)
    for _ in range(25):
        compare(damaged(data, generator), generator.choice([5, 100, 1 << 20]))


@pytest.mark.parametrize(
    "data",
    [
        b"\xef\xbb\xbf% a\nG1 X1 F10\n", b"% a\r\nG1 X1 F10\r\n", b"% a\rG1 X1 F10\r", b"% a\nG1\tX1\x0cF10\x0b",
        b"% a\nG1 X1 F10",
        b"", b"\n", b"\r", b"%", b"\xef\xbb\xbf", b"\xef\xbb\xbf% \xe4\nG1 X1 F1", b"% a\nG1 X1 F10\n\x1a",
        b"% a\nG1 X1 F10\x1a\x00\x00\x1a",
        b"% a\nG1 X1 (\xe4) Y2 Q\n", b"% a\nG1 X1 (\xc3\xa4) Y\n", b"% a\nX1\x07\n", b"\xff\xfe%\x00",
        b"% a\n\xe4\xe4\rX1\x07", b"\x1a",
        b"% a\nG1 X1 F1\n%\n", b"% a\n%\n", b"% a\nG1 X1 F1\n%\nrest\n", b"G1 X1 F1\n", b"% a\n" + b"X" * 70_000,
        b"% a\nG1 F1\nX1" + b" " * 70_000 + b"Y1",
        b"% a\nG1 F1\nX" + b"0" * 66_000 + b"1\nX2", b"% a\n" + b"Dear sir,\n" * 1500,
        b"% a\nG1 F1" + b" X1" * 30_000,
    ],
)  # fmt: skip
@pytest.mark.parametrize("part", [1 << 20, 4096, 3])
def test_ends_marks_and_nonsense(data: bytes, part: int) -> None:
    if part > 3 or len(data) < 1000:
        compare(data, part)


def test_compiled_and_plain_kernels_give_the_same_bits() -> None:
    data = b"".join(sample.read_bytes() for sample in SAMPLES if b"G20" not in sample.read_bytes()).replace(
        b"%", b"(p)"
    )
    before = compiled()
    use(compiled=False)
    plain = decoded(large(data), True)
    use(compiled=True)
    try:
        fast = decoded(large(data), True)
    finally:
        use(compiled=before)
    assert differences(plain[0], fast[0]) == []
    assert fast[1:] == plain[1:]


def test_a_file_with_a_line_without_end_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    for module in (scanner, source_module):
        monkeypatch.setattr(module, "MOST_LINE", 5000)
    data = b"% a\r\nG1 X1 F1\r\n" + b"X1 " * 5000
    with pytest.raises(UsageError, match="line 3 has more than"):
        decoded(large(data, 1000), True)
    with pytest.raises(UsageError, match="line 3 has more than"):
        list(large(data, 1000).each_line())


def test_large_files_and_pipes_are_read_by_parts(tmp_path: Path) -> None:
    rows = [f"N{n} G1 X{n % 77}.25 Y{n % 13}" for n in range(30_000)]
    data = "\n".join(["% p", "G1 F10", *rows, "G1 X", ""]).encode()
    file = tmp_path / "a.nc"
    file.write_bytes(data)
    source = Source.read(file)
    assert isinstance(source, LargeSource)
    text = Source.from_bytes("a.nc", data)
    assert (source.sha256, source.line(7777), source.text_span(30_003)) == (
        text.sha256, text.line(7777), text.text_span(30_003),
    )  # fmt: skip
    with file.open("rb") as pipe:
        piped = Source.from_stream("<stdin>", pipe)
    assert isinstance(piped, LargeSource)
    assert list(piped.each_line(29_998)) == text.lines[29_998:-1]
