"""A session of any length: edits, undo, huge pastes, unsaved files, two workspaces, cancelled requests.

Four documents in one server: one in each of two folders with settings of their own, which never reach the disk, and
two that have no file.  After each edit, or after a burst of them, the findings equal those of `lint`; after each
stretch also those of a server started afresh.

python -m tests.lsp.long_session MINUTES [SEED]
"""

from __future__ import annotations

import random
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

from tests.lsp import client as protocol
from tests.lsp.client import Client, serving, uri_of
from tests.lsp.writer import Writer, without_data

PATIENCE = 600.0
"""Time after which an answer counts as missing [s]: random loops that never end, on a busy computer."""

START = "% a\nN10 G1 X1 F20\nN20 G1 X2\n"
SETTINGS = [
    '[lint]\nselect = ["NC0", "NC1", "NC2"]\n',
    'machine = "small.toml"\n',
    '[lint]\nignore = ["NC159"]\n',
    "",
]
AXIS = "velocity = 100\nacceleration = 500\nvelocity_step = 1\nmin = 0\nmax = 100\n"
SMALL = '[machine]\nname = "small"\ncycle_us = 1000\n' + "".join(
    f"[axes.{letter}]\n{AXIS}" for letter in "XYZ"
)


@dataclass
class Counts:
    """What was done so far."""

    edits: int = 0
    comparisons: int = 0
    fresh: int = 0
    longest: int = 0
    """Lines of the longest text."""


def megabytes(client: Client) -> float:
    """The memory of a server."""
    pages = Path(f"/proc/{client.process.pid}/statm").read_text().split()[1]
    return int(pages) * 4096 / 1e6


def workspaces(folder: Path) -> list[Path]:
    """Two folders with settings; the programs in them are saved once and never again."""
    for name, settings in zip(("one", "two"), SETTINGS, strict=False):
        (folder / name).mkdir()
        (folder / name / "nccompile.toml").write_text(settings)
        (folder / name / "small.toml").write_text(SMALL)
        (folder / name / "part.nc").write_text(START)
    return [folder / name / "part.nc" for name in ("one", "two")]


def change_settings(client: Client, writer: Writer, dice: random.Random) -> None:
    """Writes other settings into the folder of a document, and tells the server."""
    assert writer.path is not None
    (writer.path.parent / "nccompile.toml").write_text(dice.choice(SETTINGS))
    client.checked(writer.uri)
    client.notifications.clear()  # the next check has the same version
    client.notify("workspace/didChangeWatchedFiles", {"changes": []})


def stretch(client: Client, writers: list[Writer], dice: random.Random, counts: Counts) -> None:
    """Some steps of every document, compared after each, or in the end only."""
    one_by_one = dice.random() < 0.5
    paste = 20_000 if dice.random() < 0.1 else 400
    for _ in range(6 if one_by_one else 40):
        for writer in writers:
            writer.step(paste)
            counts.edits += 1
            if one_by_one:
                compare(writer, counts)
    for writer in writers:
        writer.ask()
        chosen = dice.random()
        if chosen < 0.1:
            writer.reopen()
        elif chosen < 0.2:
            writer.accept()
        elif chosen < 0.25 and writer.path is not None:
            change_settings(client, writer, dice)
    for writer in writers:
        compare(writer, counts)


def compare(writer: Writer, counts: Counts) -> None:
    """The findings of the server equal those of `lint`."""
    shown, expected = writer.shown(), writer.expected()
    assert shown == expected, (writer.uri, writer.text[-2000:], shown, expected)
    counts.comparisons += 1
    counts.longest = max(counts.longest, writer.text.count("\n"))


def compare_with_fresh(client: Client, writers: list[Writer], counts: Counts) -> None:
    """The findings equal, in the protocol's own form, those of a server that has just been started."""
    with serving() as fresh:
        for writer in writers:
            fresh.open(writer.uri, writer.text)
            assert without_data(fresh.checked(writer.uri)) == without_data(client.checked(writer.uri))
            counts.fresh += 1


def tidy(client: Client, writers: list[Writer]) -> None:
    """Forgets messages and old texts; a text may grow by pastes only so far."""
    for writer in writers:
        client.checked(writer.uri)
        del writer.past[:-50]
        if len(writer.text) > 1_000_000:
            writer.past.clear()
            writer.whole(START)
    del client.notifications[:-200]


def main(minutes: float, seed: int) -> None:
    """Runs the session and prints what was done."""
    protocol.PATIENCE = PATIENCE
    begin = time.monotonic()
    counts = Counts()
    dice = random.Random(seed)
    with tempfile.TemporaryDirectory() as name, serving() as client:
        paths = workspaces(Path(name))
        writers = [Writer(client, uri_of(path), START, seed + at, path) for at, path in enumerate(paths)]
        writers += [Writer(client, f"untitled:{at}", START, seed + 10 + at) for at in range(2)]
        first = largest = megabytes(client)
        said = begin
        while time.monotonic() - begin < 60.0 * minutes:
            stretch(client, writers, dice, counts)
            compare_with_fresh(client, writers, counts)
            tidy(client, writers)
            largest = max(largest, megabytes(client))
            if time.monotonic() - said > 60.0:
                said = time.monotonic()
                print(f"{(said - begin) / 60:.0f} min {counts} {megabytes(client):.0f} MB", flush=True)
        refused = sorted(set[int]().union(*(writer.refused for writer in writers)))
        last = megabytes(client)
    print(
        f"{minutes:g} minutes: {counts.edits} edits, {counts.comparisons} comparisons with lint, {counts.fresh} with a "
        f"fresh server, no difference; longest text {counts.longest} lines; answers {refused}; "
        f"memory {first:.0f} MB at first, {largest:.0f} at most, {last:.0f} at last"
    )


if __name__ == "__main__":
    main(float(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 0)
