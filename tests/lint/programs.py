"""Programs for the tests: random ones in odd spellings, and the samples of the project."""

from __future__ import annotations

from pathlib import Path

from hypothesis import strategies as st

from nccompile.lint.config import Config
from nccompile.lint.engine import Report, lint
from nccompile.machine.model import default_machine
from nccompile.source import Source
from nccompile.toolchain import Options

ROOT = Path(__file__).parents[2]
SAMPLES = sorted((ROOT / "samples").glob("*.nc")) + sorted((ROOT / "tests" / "bad").glob("*.nc"))

OPTIONS = Options(default_machine())
EVERY_RULE = Config(select=("NC",), extend_select=("NC153",))


def read(path: Path) -> Source:
    return Source.from_bytes(path.name, path.read_bytes())


def checked(text: str, config: Config = EVERY_RULE, limit: int | None = 0) -> Report:
    return lint(Source("a.nc", text), OPTIONS, config, limit=limit)


def codes(text: str, config: Config = EVERY_RULE) -> list[str]:
    return [found.code for found in checked(text, config).ordered()]


_values = st.sampled_from(["0", "1", "2.5", "-3", ".5", "+4.", "007"])
_words = st.one_of(
    st.tuples(st.sampled_from("XYZPxyz"), _values).map("".join),
    st.sampled_from(["F20", "F20.", "f30", "D1", "E100", "E-100", "H1 O.5", "R5", "I2 J0"]),
)
_instructions = st.sampled_from(
    ["G0", "G1", "g01", "G1", "G2", "G3", "G5", "G90", "G91", "G41", "G40", "G51", "G50", "G92", "M8", "", ""]
)
_comments = st.sampled_from(["", "", "", "(a)", " ( B c )", "(größer)"])
_blanks = st.sampled_from(["", " ", "  ", "\t", " \v"])


@st.composite
def blocks(draw: st.DrawFn) -> str:
    """A block in any spelling; most can be read."""
    parts = [draw(_instructions), *draw(st.lists(_words, max_size=3)), draw(_comments)]
    number = draw(st.sampled_from(["", "N10", "n020", "N030 ", "/N40", "/ "]))
    blank = draw(_blanks)
    return number + blank + "".join(part + draw(_blanks) for part in parts if part)


programs = st.tuples(
    st.sampled_from(["% a", "%", "", "% a b (c)  "]),
    st.lists(blocks(), max_size=12),
    st.sampled_from(["\n", "\r\n"]),
).map(lambda parts: parts[2].join([parts[0], *parts[1]]) + parts[2])


@st.composite
def programs_with_jumps(draw: st.DrawFn) -> str:
    """A program whose jumps lead forward, to blocks with any different numbers, in any spelling."""
    count = draw(st.integers(2, 9))
    numbers = draw(st.lists(st.integers(1, 99), min_size=count, max_size=count, unique=True))
    lines = ["% a", draw(st.sampled_from(["G36 O$n$ D1", "(x) g36 O$n$ D0", ""]))]
    for at, number in enumerate(numbers):
        mark = draw(st.sampled_from(["", "", "/", "(rough) "]))
        name = draw(st.sampled_from(["N{}", "n0{}", "N{} "])).format(number)
        blank = draw(_blanks)
        if at + 1 < count and draw(st.booleans()):
            target = draw(st.sampled_from(numbers[at + 1 :]))
            condition = draw(st.sampled_from(["K1", "K0", "k$n$", "K1.5"])) if lines[1] else "K1"
            text = draw(st.sampled_from([f"G20 L{target} {condition}", f"g20{condition}l0{target}."]))
        else:
            text = f"G1{blank}X{at}"
        lines.append(f"{mark}{name}{blank}{text}")
    return draw(st.sampled_from(["\n", "\r\n"])).join(lines)
