"""A long session: random edits, undo, huge pastes, unsaved files, cancelled requests.

After each stretch the findings equal those of a server that opens the same text fresh.
"""

from __future__ import annotations

import pytest

from tests.lsp.client import Failed, serving, span
from tests.lsp.writer import Writer, without_data


@pytest.mark.parametrize("seed", [1, 2])
def test_findings_after_random_edits_are_those_of_a_fresh_start(seed: int) -> None:
    with serving() as client, serving() as fresh:
        writers = [
            Writer(client, f"untitled:{name}", "% a\nN10 G1 X1 F20\nN20 G1 X2\n", seed * 10 + at)
            for at, name in enumerate(("one", "two"))
        ]
        for stretch in range(6):
            for _ in range(12):
                for writer in writers:
                    writer.step()
            for writer in writers:
                assert writer.shown() == writer.expected()
                uri = f"untitled:fresh-{stretch}-{writer.uri}"
                fresh.open(uri, writer.text)
                assert without_data(fresh.checked(uri)) == without_data(client.checked(writer.uri))


def test_requests_race_with_edits_and_cancellation() -> None:
    with serving() as client:
        writer = Writer(client, "untitled:a", "% a\nN10 G1 X1 F20\n" * 50, 5)
        refused: list[int] = []
        for at in range(30):
            writer.step()
            document = {"textDocument": {"uri": writer.uri}}
            numbers = [
                client.start("textDocument/hover", {**document, "position": {"line": at, "character": 2}}),
                client.start("textDocument/inlayHint", {**document, "range": span(0, 0, 0, 9)}),
                client.start("textDocument/documentSymbol", document),
                client.start("textDocument/semanticTokens/full", document),
            ]
            if at % 3 == 0:
                client.notify("$/cancelRequest", {"id": numbers[0]})
            writer.step()
            for number in numbers:
                try:
                    client.finish(number)
                except Failed as error:
                    refused.append(error.code)
        assert set(refused) == {-32800, -32801}  # cancelled, and edited meanwhile
        assert writer.shown() == writer.expected()


LARGE = "% large\n" + "".join(
    f"N{n * 10} G1 X{n % 97}.{n % 7} Y{n % 89} Z-{n % 13}\n" for n in range(1, 50_001)
).replace("N10 G1", "N10 G1 F20")


def test_an_edit_of_a_large_file_is_answered_before_the_whole_is_checked_again() -> None:
    """How fast: benchmarks/bench_lint.py."""
    with serving() as client:
        writer = Writer(client, "untitled:large", LARGE, 1)
        client.checked(writer.uri)
        client.notifications.clear()
        at = writer.text.index("N250000 ") + 8
        writer.replace(at, at, "X1,5 ")
        client.checked(writer.uri)
        first, *_, last = client.notifications
        assert first["method"] == "textDocument/publishDiagnostics"
        assert "NC001" in {found["code"] for found in first["params"]["diagnostics"]}
        assert (first["params"]["version"], last["method"]) == (2, "nccompile/checked")
        assert writer.shown() == writer.expected()


ENDLESS = "% a\nN5 G36 O$n$ D1\nN10 G1 X0 F20\n" + "G1 X1\nG1 X2\n" * 100 + "G37 O$n$ D1\nG20 L10 K$n$\n"


def test_a_document_does_not_wait_for_the_endless_loop_of_another() -> None:
    with serving() as client:
        client.open("untitled:endless", ENDLESS)
        client.open("untitled:short", "% a\nN10 G1 X1 F20\nN20 G0 X2\n")
        client.checked("untitled:short")
        assert not any(message["params"].get("uri") == "untitled:endless" for message in client.notifications)
        client.change("untitled:endless", {"text": "% a\nG1 X1\n"})
        assert "NC101" in {found["code"] for found in client.checked("untitled:endless")}
