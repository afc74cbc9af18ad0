"""Program files as `lint` and `fmt` take them: named, in folders or from standard input, and written back."""

from __future__ import annotations

import os
import sys
from pathlib import Path

from nccompile.cli.queues import STDIN, require_program
from nccompile.errors import UsageError
from nccompile.source import shown_path

__all__ = ["name_of", "programs_in", "read_bytes", "require_file", "store"]

SUFFIXES = {".nc", ".cnc", ".din", ".iso"}
"""Files that are taken from folders."""


def programs_in(files: list[Path]) -> list[Path]:
    """The programs named, and those in the folders named, in the order of their names; each once."""
    found: list[Path] = []
    for path in files:
        if not path.is_dir():
            found.append(path)
            continue
        inside = sorted(p for p in path.rglob("*") if p.suffix.lower() in SUFFIXES and p.is_file())
        if not inside:
            print(f"{path}: no programs ({' '.join(sorted(SUFFIXES))}) in this folder", file=sys.stderr)
        found += inside
    return list(dict.fromkeys(found))


def name_of(path: Path) -> str:
    """What a program is called in findings."""
    return "<stdin>" if path == STDIN else shown_path(path)


def read_bytes(path: Path) -> bytes:
    """The bytes of a program, `-` for standard input; raises UsageError."""
    if path == STDIN:
        return sys.stdin.buffer.read()
    require_program(path)
    try:
        return path.read_bytes()
    except OSError as error:
        raise UsageError(f"{path} cannot be read: {error.strerror or error}") from error


def require_file(path: Path) -> None:
    """Raises UsageError if a program cannot be written back: a pipe, say."""
    if path == STDIN or not path.exists():
        return
    if not path.is_file():
        raise UsageError(f"{path} is no file that could be changed; - reads standard input")
    if not os.access(path, os.W_OK):
        raise UsageError(f"{path} must not be written")


def store(path: Path, data: bytes, new: bytes) -> None:
    """Writes a changed program back; that of standard input goes to standard output."""
    from nccompile.backend.files import write_file

    if path == STDIN:
        sys.stdout.buffer.write(new)
        sys.stdout.flush()
    elif new != data:
        write_file(path, new)
