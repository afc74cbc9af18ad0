"""Examples of passes as text: what goes in, what comes out.  A file `*.case` or the end of a pass's docstring.

# why this case is here                          comments, if there is something to say
-p round-corners{radius=2,everywhere}            what the command line would say
--- in
% t                                              a part program; a toolpath as text if it starts with that word
N10 G1 X10 F50
N20 G1 Y10
--- out
line 8 0 0 feed 50 source 2                      the toolpath as text: numbers to 1e-6, lengths left out
arc 10 2 0 feed 50 source 2 xy center 8 2 radius 2 start -1.570796 sweep 1.570796
line 10 10 0 feed 50 source 3
# NC301 warning line 3: ...                      findings, if there are any
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from inspect import cleandoc
from itertools import takewhile
from textwrap import dedent

from nccompile.decoder import DecodeOptions, decode
from nccompile.diagnostics import Diagnostics, Severity
from nccompile.passes.option import parse
from nccompile.source import Source
from nccompile.toolpath.columns import Toolpath
from nccompile.toolpath.text import format_toolpath, parse_toolpath
from nccompile.toolpath.verify import verify_chain
from tests.passes.paths import windows
from tests.words import is_same

__all__ = ["Case", "agree", "examples_in", "run_case"]

_IN, _OUT = "--- in", "--- out"
_SHOWN = 6
_NEAR = 2e-6
_LEFT_OUT = ("toolpath", "axes", "start 0 0 0", "first", "name")


@dataclass(frozen=True)
class Case:
    """One example.  spec: the pipeline;  given: the program or toolpath;  wanted: the text it becomes."""

    head: str
    spec: str
    given: str
    wanted: str

    @classmethod
    def parse(cls, text: str) -> Case:
        """The case of a text in the form of the module's docstring; raises ValueError if a part is missing."""
        head, has_in, rest = text.partition(_IN + "\n")
        given, has_out, wanted = rest.partition(_OUT + "\n")
        specs = [line.removeprefix("-p ") for line in head.splitlines() if line.startswith("-p ")]
        if not has_in or not has_out or len(specs) != 1:
            raise ValueError(f"a case has one line '-p SPEC', '{_IN}' and '{_OUT}', not\n{text}")
        return cls(head, specs[0].strip(), given, wanted.rstrip("\n"))

    def with_wanted(self, text: str) -> str:
        """The text of the case, with another result."""
        return f"{self.head}{_IN}\n{self.given}{_OUT}\n{text}\n"


def examples_in(docstring: str | None) -> list[Case]:
    """The cases of a docstring: indented below lines that are `Example:`."""
    lines = cleandoc(docstring or "").splitlines()
    begins = [i + 1 for i, line in enumerate(lines) if line == "Example:"]
    blocks = (takewhile(lambda line: not line or line.startswith("    "), lines[at:]) for at in begins)
    return [Case.parse(dedent("\n".join(block)).strip("\n") + "\n") for block in blocks]


def run_case(case: Case, size: int = 0) -> str:
    """What the pipeline makes of the case, as text; size: segments in a chunk on the way in, 0: all.

    The toolpath is verified behind every pass.
    """
    path = _given(case.given)
    findings: list[str] = []

    def diagnose(code: str, severity: Severity, message: str, line: int, help: str) -> None:
        findings.append(f"# {code} {severity.name.lower()} line {line}: {message}")

    def after(_: str, chunks: Iterator[Toolpath]) -> Iterator[Toolpath]:
        return verify_chain(chunks)

    step = size or max(len(path), 1)
    chunks = [path.rows(at, at + step) for at in range(0, max(len(path), 1), step)]
    with windows(size):
        out = Toolpath.join(list(parse(case.spec).run(chunks, diagnose=diagnose, after=after)))
    return "\n".join([*_shown(format_toolpath(out.replace(length=out.length * 0.0))), *findings])


def _given(text: str) -> Toolpath:
    if text.startswith("toolpath"):
        return parse_toolpath(text)
    diagnostics = Diagnostics()
    path = Toolpath.join(list(decode(Source("case.nc", text), DecodeOptions(), diagnostics)))
    if diagnostics.errors:
        raise ValueError("\n".join(map(str, diagnostics)))
    return path


def _shown(text: str) -> Iterable[str]:
    """The lines with numbers to six places."""
    for line in text.splitlines():
        short = " ".join(_short(word) for word in line.split(" "))
        if not short.startswith(_LEFT_OUT):
            yield short


def _short(word: str) -> str:
    try:
        number = float(word)
    except ValueError:
        return word
    return f"{round(number, _SHOWN) + 0.0:.15g}"


def agree(got: str, wanted: str) -> bool:
    """Whether two results are the same to the last shown place of their numbers."""
    words, wanted_words = got.split(), wanted.split()
    return (
        len(words) == len(wanted_words)
        and got.count("\n") == wanted.count("\n")
        and all(map(_same, words, wanted_words))
    )


def _same(word: str, wanted: str) -> bool:
    return is_same(word, wanted, absolute=_NEAR)
