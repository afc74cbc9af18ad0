"""What the `check_corpus` scripts share: the programs of folders, and a line on each."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from pathlib import Path

__all__ = ["checked", "programs"]


def programs(places: Iterable[str | Path]) -> list[Path]:
    """The .nc programs of folders, and files as they are named; small ones first, so that faults show early."""
    found = [
        path for place in map(Path, places) for path in (place.glob("*.nc") if place.is_dir() else [place])
    ]
    return sorted(found, key=lambda path: (path.stat().st_size, path.name))


def checked(places: Iterable[str | Path], check: Callable[[Path], str]) -> int:
    """Checks every program and prints its processor time and what the check says of it; the exit code."""
    failed = 0
    for path in programs(places):
        begin = time.process_time()
        try:
            verdict = check(path)
        except AssertionError as error:
            failed += 1
            verdict = f"FAILED {error}"
        print(f"{path.name:30} {time.process_time() - begin:8.1f} s  {verdict}", flush=True)
    return 1 if failed else 0
