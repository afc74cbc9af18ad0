"""The language server in a document of 50,000 lines: mixed edits, half of them while it is still checking.

An edit's time is that from sending it until its findings are published.  Beside the wall time there are the
processor time of the server's main thread, and the time that this thread was ready to run but others ran, which
a busy computer adds (Linux).
"""

from __future__ import annotations

import random
import time
from collections import defaultdict
from pathlib import Path
from statistics import median
from typing import NamedTuple

from benchmarks.inputs import program
from tests.lsp.client import Client

LINES = 50_000
EDITS = 250
"""Each is undone, which is an edit too."""

URI = "untitled:large"


class Sample(NamedTuple):
    """One edit: wall time, processor time of the main thread, time it waited for a processor, all [ms]."""

    wall: float
    work: float
    waited: float


class Bench:
    """An editor with the large document, and the samples by kind of edit."""

    def __init__(self) -> None:
        self.text = program(LINES)
        self.lines = self.text.split("\n")
        self.client = Client()
        self.client.open(URI, self.text)
        self.client.checked(URI)
        self.samples: dict[str, list[Sample]] = defaultdict(list)

    def _clock(self) -> tuple[float, float]:
        """Processor time and waiting time of the server's main thread [ms]."""
        number = self.client.process.pid
        work, waited, _ = Path(f"/proc/{number}/task/{number}/schedstat").read_text().split()
        return int(work) / 1e6, int(waited) / 1e6

    def edit(self, kind: str, start: tuple[int, int], end: tuple[int, int], text: str) -> None:
        """Sends an edit and waits for what is published of it first."""
        places = [{"line": line, "character": character} for line, character in (start, end)]
        change = {"range": {"start": places[0], "end": places[1]}, "text": text}
        before, begin = self._clock(), time.perf_counter()
        self.client.change(URI, change)
        self.client.wait(self._is_published)
        wall, after = time.perf_counter() - begin, self._clock()
        self.samples[kind].append(Sample(1000 * wall, after[0] - before[0], after[1] - before[1]))

    def _is_published(self) -> bool | None:
        version = self.client.versions[URI]
        news = (m for m in self.client.notifications[-9:] if m["method"] == "textDocument/publishDiagnostics")
        return True if any(m["params"]["version"] == version for m in news) else None

    def mixed(self, dice: random.Random) -> None:
        """One edit of a random kind at a random line, undone after a while."""
        at = dice.randrange(10, LINES - 300)
        pasted = "\n".join(self.lines[100:300]) + "\n"
        kind, start, end, text, behind = dice.choice(
            [
                ("a blank", (at, 0), (at, 0), " ", (at, 1)),
                ("an error", (at, 0), (at, 0), "X1,5 ", (at, 5)),
                ("a new first line", (1, 0), (1, 0), "(new)\n", (2, 0)),
                ("G91 at the top", (3, 0), (3, 0), "G91\n", (4, 0)),
                ("200 lines pasted", (at, 0), (at, 0), pasted, (at + 200, 0)),
            ]
        )
        for name, until, new in ((kind, end, text), (f"undo: {kind}", behind, "")):
            self.edit(name, start, until, new)
            if dice.random() < 0.5:
                self.client.checked(URI)
            else:
                time.sleep(0.4 * dice.random())
            del self.client.notifications[:-20]

    def whole(self, runs: int) -> float:
        """Median seconds from a new first line to all findings."""
        times = []
        for _ in range(runs):
            self.client.checked(URI)
            begin = time.perf_counter()
            self.edit("whole", (1, 0), (1, 0), "(new)\n")
            self.client.checked(URI)
            times.append(time.perf_counter() - begin)
        return median(times)

    def close(self) -> None:
        """Ends the server."""
        self.client.request("shutdown", None)
        self.client.notify("exit", None)
        self.client.process.wait()


def _row(name: str, samples: list[Sample]) -> str:
    ordered = sorted(sample.wall for sample in samples)
    at_99 = ordered[int(0.99 * (len(ordered) - 1))]
    return (
        f"lsp       {name:24} {len(samples):4} edits: {median(ordered):5.1f} ms in the median, {at_99:5.1f} at 99 %, "
        f"{ordered[-1]:5.1f} at worst; processor time {median(s.work for s in samples):4.1f} ms, at worst "
        f"{max(s.work for s in samples):.1f}; waited for a processor {max(s.waited for s in samples):.1f} at worst"
    )


def main() -> None:
    """Prints the times."""
    dice = random.Random(1)
    bench = Bench()
    for _ in range(EDITS):
        bench.mixed(dice)
    for name, samples in sorted(bench.samples.items()):
        print(_row(name, samples))
    print(_row("all", [sample for samples in bench.samples.values() for sample in samples]))
    print(f"lsp       all findings after a new first line: {bench.whole(7):.2f} s")
    bench.close()
