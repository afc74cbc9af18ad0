"""Edits of open documents against plain string slicing, and positions in every encoding."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from nccompile.lsp.document import Document, path_of
from nccompile.lsp.text import Place, Text, split
from nccompile.source import Source, Span

TEXTS = st.text("aG1 \n\r(ä\U0001f600", max_size=20)
PLACES = st.tuples(st.integers(0, 8), st.integers(0, 12))


def offset(text: str, place: Place, units: str) -> int:
    """The index of a position in the whole text: the reference, slow and simple."""
    lines, ends = split(text)
    line, character = place
    if line >= len(lines):
        return len(text)
    before = sum(len(lines[i]) + len(ends[i]) for i in range(line))
    size = {"utf-8": 1, "utf-16": 2, "utf-32": 4}[units]
    codec = units if units == "utf-8" else units + "-le"
    inside = 0
    while inside < len(lines[line]) and len(lines[line][:inside].encode(codec)) // size < character:
        inside += 1
    return before + inside


@given(
    TEXTS,
    st.lists(st.tuples(PLACES, PLACES, TEXTS), max_size=6),
    st.sampled_from(["utf-8", "utf-16", "utf-32"]),
)
def test_edits_equal_those_of_a_string(text: str, edits: list[tuple[Place, Place, str]], units: str) -> None:
    document = Document("untitled:a", 1, text, units)
    for start, end, new in edits:
        a, b = sorted((offset(text, start, units), offset(text, end, units)))
        text = text[:a] + new + text[b:]
        document.edit(start, end, new)
        assert str(document.text) == text
        assert document.text.lines == Source("a", text).lines
        assert document.source() == Document("untitled:a", 1, text, units).source()
        assert document.source().nodes == Document("untitled:a", 1, text, units).source().nodes


def test_a_whole_new_text_reads_only_the_lines_that_differ() -> None:
    document = Document("untitled:a", 1, "% a\nN1 X1\nN2 X2\nN3 X3\nN4 X4", "utf-16")
    before = list(document.nodes)
    document.replace("% a\nN1 X1\nN9 X9\nN2 X9\nN3 X3\nN4 X4")
    assert [node is old for node, old in zip(document.nodes[:2], before[:2], strict=True)] == [True, True]
    assert [node is old for node, old in zip(document.nodes[-2:], before[-2:], strict=True)] == [True, True]
    assert document.source().nodes == Document("untitled:a", 1, str(document.text), "utf-16").source().nodes


@given(TEXTS, st.integers(0, 20), st.sampled_from(["utf-8", "utf-16", "utf-32"]))
def test_positions_there_and_back(line: str, index: int, units: str) -> None:
    line = line.replace("\n", "").replace("\r", "")
    text = Text(line, units)
    index = min(index, len(line))
    assert text.index(0, text.character(0, index)) == index


def test_places_of_a_span_count_utf16_units() -> None:
    text = Text("(\U0001f600) X1")
    assert text.places(Span(1, 5, 7)) == ((0, 5), (0, 7))
    assert text.end() == (0, 7)


@pytest.mark.parametrize(
    ("uri", "path"),
    [("file:///a%20b/c.nc", "/a b/c.nc"), ("file:///C:/p.nc", "C:/p.nc"), ("untitled:Untitled-1", None)],
)
def test_files_of_uris(uri: str, path: str | None) -> None:
    found = path_of(uri)
    assert (None if found is None else found.as_posix()) == path
