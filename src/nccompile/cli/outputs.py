"""Output files that commands may write: never the input, never each other."""

from __future__ import annotations

import json
from collections.abc import Sequence
from itertools import combinations
from pathlib import Path
from typing import Any

from nccompile.cli.queues import STDIN
from nccompile.errors import UsageError

__all__ = ["keep_apart", "output_of", "require_picture", "write_json"]

PICTURES = (".png", ".svg", ".pdf")
"""Kinds of pictures that are drawn."""


def output_of(path: Path, output: Path | None, suffix: str) -> Path:
    """The output file: as given, or named after the input; raises UsageError where that cannot be."""
    if output is not None:
        return output
    if path == STDIN:
        raise UsageError("name the output with -o when the program comes from standard input")
    if not path.name:
        raise UsageError(f"{path} cannot be read: Is a directory")
    return path.with_suffix(suffix)


def require_picture(path: Path) -> None:
    """Raises UsageError for a file that is no picture by its name."""
    if path.suffix.lower() not in PICTURES:
        raise UsageError(f"{path}: pictures are written as {', '.join(PICTURES)}")


def write_json(path: Path, content: dict[str, Any]) -> None:
    """Writes a report; raises UsageError if it cannot be written."""
    from nccompile.backend.files import write_file

    write_file(path, (json.dumps(content, indent=1, ensure_ascii=False) + "\n").encode())


def keep_apart(inputs: Sequence[Path | None], outputs: Sequence[Path | None]) -> None:
    """Raises UsageError for an output that is an input, another output, or standard output."""
    places = [place for place in outputs if place is not None]
    for place in places:
        if place == STDIN:
            raise UsageError("- is no output: name a file")
        if any(path is not None and _is_same(path, place) for path in inputs):
            raise UsageError(f"{place} is the input: name another output")
    for one, other in combinations(places, 2):
        if one == other or _is_same(one, other):
            raise UsageError(f"{other} is named for two outputs")


def _is_same(one: Path, other: Path) -> bool:
    try:
        return one.samefile(other)
    except OSError:  # one of them is not there, or its name is none
        return False
