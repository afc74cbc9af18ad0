"""Every feature over the real protocol: one server, one program, an editor that is a script."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nccompile.diagnostics import render
from nccompile.lint.config import Config
from nccompile.lint.engine import lint
from nccompile.lint.fmt import format_text
from nccompile.lsp.features.tokens import difference
from nccompile.source import Source
from tests.lint.programs import OPTIONS
from tests.lsp.client import Client, Failed, serving, span, uri_of
from tests.lsp.writer import taken

PART = """\
% part (x)
(rough)
N10 G0 X10
N15 g1 X12 F20
N20 G36 O$n$ D2
(fine)
N30 G91
N40 G1 X1 F20
N45 G3 X2 Y0 I1 J0
N50 G37 O$n$ D-1
N60 G20 L40 K$n$
N65 G41 D1
N70 G1 X5
N75 M8
N80 G40
"""
URI = "untitled:part.nc"


@pytest.fixture(scope="module")
def client() -> Iterator[Client]:
    with serving() as client:
        client.open(URI, PART)
        client.checked(URI)
        yield client


def test_findings_are_those_of_lint_byte_for_byte(client: Client) -> None:
    source = Source(URI, PART)
    expected = [render(found, source) for found in lint(source, OPTIONS, Config()).ordered()]
    shown = client.checked(URI)
    assert [found["data"]["rendered"] for found in shown] == expected
    small = next(found for found in shown if found["code"] == "NC054")
    assert small["range"] == span(3, 4, 6)
    assert small["message"] == "word letters in lower case\nhelp: write them in upper case"
    assert (small["severity"], small["source"]) == (3, "nccompile")


def test_hover_explains_words_and_shows_what_is_in_force(client: Client) -> None:
    text = client.at("textDocument/hover", URI, 7, 5)["contents"]["value"]
    assert "**G1**: line" in text
    assert "`G1 G91 G99 F20`" in text
    assert "`X13 Y0 Z0`" in text
    assert "in proportion" not in text
    assert "**F**: path velocity" in client.at("textDocument/hover", URI, 3, 12)["contents"]["value"]
    assert "jump to block L" in client.at("textDocument/hover", URI, 10, 5)["contents"]["value"]
    assert "waits for the acknowledge" in client.at("textDocument/hover", URI, 13, 5)["contents"]["value"]
    assert "`G3 G91 G41 G99" not in text
    assert "G41" in client.at("textDocument/hover", URI, 12, 5)["contents"]["value"]
    assert "NC054: " in client.at("textDocument/hover", URI, 3, 5)["contents"]["value"]
    assert client.at("textDocument/hover", URI, 0, 2) is None
    assert client.at("textDocument/hover", URI, 99, 0) is None


def labels(found: Any) -> list[str]:
    return [item["label"] for item in found]


def test_completion(client: Client) -> None:
    uri = "untitled:completion"
    client.open(uri, "% a\nN10 G36 O$depth$ D1\nN20 G\nN30 G20 L\nN40 X$d\nN50 \n(G\nN60 L\nN130 G20 L1")

    def offered(line: int, character: int) -> Any:
        return client.at("textDocument/completion", uri, line, character)

    instructions = offered(2, 5)["items"]
    assert {"G0", "G41", "G92"} <= set(labels(instructions))
    assert instructions[0]["textEdit"]["range"] == span(2, 4, 5)
    assert labels(offered(3, 9)["items"]) == ["20", "40", "10", "50", "60"]
    assert labels(offered(8, 12)["items"]) == ["10"]
    assert labels(offered(4, 7)["items"]) == ["$depth$"]
    assert {"X", "F", "M"} <= set(labels(offered(5, 4)["items"]))
    assert offered(6, 2)["items"] == []
    assert offered(7, 5)["items"] == []
    assert offered(5, 4)["isIncomplete"]  # behind the letter other things follow
    assert not offered(2, 5)["isIncomplete"]
    client.close(uri)


def test_completion_of_many_block_numbers_goes_on_while_one_types(client: Client) -> None:
    uri = "untitled:many"
    client.open(uri, "% a\n" + "".join(f"N{n} X1\n" for n in range(1, 1501)) + "G20 L\nG20 L14")
    some = client.at("textDocument/completion", uri, 1501, 5)
    assert some["isIncomplete"]
    assert labels(some["items"])[:2] == ["1500", "1499"]
    assert len(some["items"]) == 500
    rest = client.at("textDocument/completion", uri, 1502, 7)
    assert not rest["isIncomplete"]
    assert sorted(labels(rest["items"]), key=int) == [
        str(n) for n in [14, *range(140, 150), *range(1400, 1500)]
    ]
    client.close(uri)


def lines(found: Any) -> list[int]:
    return [place["range"]["start"]["line"] for place in found]


def test_definition_and_references(client: Client) -> None:
    assert lines(client.at("textDocument/definition", URI, 10, 9)) == [7]
    assert lines(client.at("textDocument/definition", URI, 10, 14)) == [4, 9]
    assert client.at("textDocument/definition", URI, 7, 5) == []
    everywhere, uses = {"includeDeclaration": True}, {"includeDeclaration": False}
    assert lines(client.at("textDocument/references", URI, 7, 1, context=everywhere)) == [7, 10]
    assert lines(client.at("textDocument/references", URI, 7, 1, context=uses)) == [10]
    assert lines(client.at("textDocument/references", URI, 4, 10, context=everywhere)) == [4, 9, 10]
    assert lines(client.at("textDocument/references", URI, 4, 10, context=uses)) == [10]


def test_rename(client: Client) -> None:
    assert client.at("textDocument/prepareRename", URI, 10, 9) == span(10, 9, 11)
    assert client.at("textDocument/prepareRename", URI, 7, 5) is None
    edits = client.at("textDocument/rename", URI, 7, 1, newName="N44")["changes"][URI]
    assert [(e["range"], e["newText"]) for e in edits] == [(span(7, 1, 3), "44"), (span(10, 9, 11), "44")]
    edits = client.at("textDocument/rename", URI, 4, 10, newName="count")["changes"][URI]
    assert [(e["range"], e["newText"]) for e in edits] == [
        (span(4, 10, 11), "count"), (span(9, 10, 11), "count"), (span(10, 14, 15), "count"),
    ]  # fmt: skip
    for place, name in (((7, 1), "N45"), ((7, 1), "abc"), ((4, 10), "5x"), ((7, 5), "N1")):
        with pytest.raises(Failed):
            client.at("textDocument/rename", URI, *place, newName=name)


def test_symbols_and_folding(client: Client) -> None:
    found = client.of("textDocument/documentSymbol", URI)
    assert [(s["name"], s["range"]["end"]["line"], labels_of(s["children"])) for s in found] == [
        ("rough", 4, []), ("fine", 14, ["loop N40", "G41"]),
    ]  # fmt: skip
    assert labels_of(found[1]["children"][1]["children"]) == ["M8"]
    folded = {(f["startLine"], f["endLine"]) for f in client.of("textDocument/foldingRange", URI)}
    assert folded == {(1, 4), (5, 14), (7, 10), (11, 14)}


def labels_of(found: Any) -> list[str]:
    return [symbol["name"] for symbol in found]


def test_formatting(client: Client) -> None:
    options = {"tabSize": 1, "insertSpaces": True}
    (edit,) = client.of("textDocument/formatting", URI, options=options)
    assert (edit["range"], edit["newText"]) == (span(3, 0, 0, 4), "N15 G1 X12 F20\n")
    (edit,) = client.of("textDocument/rangeFormatting", URI, range=span(2, 0, 0, 4), options=options)
    assert (edit["range"], edit["newText"]) == (span(3, 0, 14), "N15 G1 X12 F20")
    assert client.of("textDocument/rangeFormatting", URI, range=span(5, 0, 9), options=options) == []


def test_code_actions(client: Client) -> None:
    context: dict[str, Any] = {"diagnostics": []}
    found = {
        a["title"]: a for a in client.of("textDocument/codeAction", URI, range=span(3, 5, 5), context=context)
    }
    assert list(found) == [
        "Write the letters in upper case", "Silence NC054 here", "Apply all safe fixes", "Number the blocks anew",
    ]  # fmt: skip
    (edit,) = found["Write the letters in upper case"]["edit"]["changes"][URI]
    assert (edit["range"], edit["newText"]) == (span(3, 4, 5), "G")
    (edit,) = found["Silence NC054 here"]["edit"]["changes"][URI]
    assert (edit["range"], edit["newText"]) == (span(3, 14, 14), " (nc: ignore[NC054])")
    fixed = client.request("codeAction/resolve", found["Apply all safe fixes"])["edit"]["changes"][URI]
    assert [(edit["range"], edit["newText"]) for edit in fixed] == [(span(3, 0, 0, 4), "N15 G1 X12 F20\n")]
    numbered = client.request("codeAction/resolve", found["Number the blocks anew"])["edit"]["changes"][URI]
    assert "\nN80 G20 L50 K$n$\n" in taken(PART, numbered)
    assert numbered[0]["range"]["start"]["line"] == 3  # what keeps its number is not touched
    only = {"diagnostics": [], "only": ["source.fixAll"]}
    chosen = client.of("textDocument/codeAction", URI, range=span(0, 0, 0), context=only)
    assert [action["kind"] for action in chosen] == ["source.fixAll.nccompile"]


def test_hints_and_lenses(client: Client) -> None:
    hints = client.of("textDocument/inlayHint", URI, range=span(0, 0, 0, 20))
    shown = {hint["position"]["line"]: hint["label"] for hint in hints}
    assert shown[7].startswith("→ X13  0.")
    assert shown[8].startswith("→ X15 Y0  R1  0.")
    assert shown[2] == "0.7 s"  # 10 mm from rest to rest: 20 mm/s, 100 mm/s2
    lenses = client.of("textDocument/codeLens", URI)
    assert [lens["range"]["start"]["line"] for lens in lenses] == [0, 1, 5]
    assert lenses[1]["command"]["title"].startswith("2 segments · 12 mm · 0.9")


def test_semantic_tokens(client: Client) -> None:
    legend = client.capabilities["semanticTokensProvider"]["legend"]["tokenTypes"]
    data = client.of("textDocument/semanticTokens/full", URI)["data"]
    rows = [data[at : at + 5] for at in range(0, len(data), 5)]
    line = start = 0
    named = []
    for delta_line, delta_start, length, kind, _ in rows:
        line, start = line + delta_line, delta_start + (0 if delta_line else start)
        named.append((PART.split("\n")[line][start : start + length], legend[kind]))
    assert named[:4] == [
        ("% part (x)", "namespace"),
        ("(rough)", "comment"),
        ("N10", "label"),
        ("G0", "keyword"),
    ]
    assert ("$n$", "variable") in named
    assert ("M8", "function") in named
    assert client.capabilities["semanticTokensProvider"]["full"] == {"delta": True}
    some = client.of("textDocument/semanticTokens/range", URI, range=span(3, 0, 3))["data"]
    assert some == [3, 0, 3, legend.index("label"), 0, 0, 4, 2, legend.index("keyword"), 0,
                    0, 3, 3, legend.index("property"), 0, 0, 4, 3, legend.index("parameter"), 0]  # fmt: skip


def test_semantic_tokens_after_an_edit_are_a_difference(client: Client) -> None:
    uri = "untitled:tokens"
    client.open(uri, "% a\nN10 G1 X1\nN20 G1 X2\nN30 G1 X3\n")
    first = client.of("textDocument/semanticTokens/full", uri)
    numbers, name = first["data"], first["resultId"]
    for change in (
        {"range": span(2, 4, 6), "text": "(\u00e4) G0"},
        {"text": "% a\nM8\n"},
        {"text": "% a\nM8\n"},
    ):
        client.change(uri, change)
        answer = client.of("textDocument/semanticTokens/full/delta", uri, previousResultId=name)
        for edit in answer["edits"]:
            numbers[edit["start"] : edit["start"] + edit["deleteCount"]] = edit["data"]
        assert numbers == client.of("textDocument/semanticTokens/full", uri)["data"]
        name = client.of("textDocument/semanticTokens/full", uri)["resultId"]
    assert "data" in client.of("textDocument/semanticTokens/full/delta", uri, previousResultId="unknown")
    client.close(uri)


@given(st.lists(st.integers(0, 2)), st.lists(st.integers(0, 2)))
def test_the_difference_of_numbers_leads_from_one_to_the_other(old: list[int], new: list[int]) -> None:
    made = list(old)
    for edit in difference(np.array(old, np.int32), np.array(new, np.int32)):
        made[edit.start : edit.start + edit.delete_count] = edit.data or []
    assert made == new


def test_positions_count_what_the_client_asks_for(client: Client) -> None:
    uri = "untitled:wide"
    text = "% a\nN10 (\U0001f600) g1 X1 F20\n"
    client.open(uri, text)
    small = next(found for found in client.checked(uri) if found["code"] == "NC054")
    assert small["range"]["start"]["character"] == 9  # UTF-16: the picture is two
    client.close(uri)
    with serving(["utf-32", "utf-16"]) as other:
        other.open(uri, text)
        small = next(found for found in other.checked(uri) if found["code"] == "NC054")
        assert small["range"]["start"]["character"] == 8


def test_settings_and_machines_of_two_workspaces(client: Client, tmp_path: Path) -> None:
    text = "% a\nN10 G0 X500\n"
    for name, settings in (
        ("one", '[lint]\nselect = ["NC4"]\n'),
        ("two", 'machine = "small.toml"\n'),
        ("bad", "[lnit]\n"),
    ):
        (tmp_path / name).mkdir()
        (tmp_path / name / "nccompile.toml").write_text(settings)
    axis = "velocity = 100\nacceleration = 500\nvelocity_step = 1\nmin = 0\nmax = 100\n"
    axes = "".join(f"[axes.{letter}]\n{axis}" for letter in "XYZ")
    (tmp_path / "two" / "small.toml").write_text(f'[machine]\nname = "small"\ncycle_us = 1000\n{axes}')
    uris = {name: uri_of(tmp_path / name / "a.nc") for name in ("one", "two", "bad")}
    for uri in uris.values():
        client.open(uri, text)
    assert [d["code"] for d in client.checked(uris["one"])] == []
    assert [d["code"] for d in client.checked(uris["two"])] == ["NC402"]
    assert [d["code"] for d in client.checked(uris["bad"])] == []
    said = [m["params"]["message"] for m in client.notifications if m["method"] == "window/showMessage"]
    assert any("unknown key lnit; did you mean lint?" in message for message in said)
    (tmp_path / "two" / "nccompile.toml").write_text("")
    client.notify("workspace/didChangeWatchedFiles", {"changes": []})
    client.wait(lambda: True if not client.published(uris["two"]) else None)
    for uri in uris.values():
        client.close(uri)


def test_requests_that_are_not_as_the_protocol_says_are_refused(client: Client) -> None:
    for params in ({}, {"textDocument": 5}):
        with pytest.raises(Failed) as refused:
            client.request("textDocument/formatting", params)
        assert refused.value.code in {-32602, -32603}


def test_formatting_many_lines_leaves_the_others_alone(client: Client) -> None:
    uri = "untitled:formatting"
    options = {"tabSize": 1, "insertSpaces": True}
    for text, ranges in (
        (
            "% a\n" + "N1 G1 X1\n" * 3 + "n2g1x1\n" * 2 + "N1 G1 X1\nn2g1x1\n",
            [span(4, 0, 0, 6), span(7, 0, 0, 8)],
        ),
        (
            "% a\nN1 G1 X1\nN2 G1 X1\r\nn3g1x1",
            [span(2, 0, 6, 3)],
        ),  # line ends become equal, the last one is added
        ("% a\nN1 G1 X1\n", []),
    ):
        client.open(uri, text)
        edits = client.of("textDocument/formatting", uri, options=options)
        assert [edit["range"] for edit in edits] == ranges
        assert taken(text, edits) == format_text(Source(uri, text))
        client.close(uri)


def test_requests_for_what_is_not_open_are_refused(client: Client) -> None:
    for method in ("textDocument/hover", "textDocument/definition"):
        with pytest.raises(Failed) as refused:
            client.at(method, "untitled:none", 0, 0)
        assert refused.value.code == -32602
