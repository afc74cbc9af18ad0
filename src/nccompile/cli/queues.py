"""OutQueues that commands read; apart from `inputs`, so that they do without everything that compiles."""

from __future__ import annotations

from pathlib import Path

from nccompile.backend import ncq
from nccompile.errors import UsageError

__all__ = ["STDIN", "is_queue", "read_queue"]

STDIN = Path("-")
_ZIP_STARTS = (b"PK\x03\x04", b"PK\x05\x06")


def read_queue(path: Path) -> ncq.Queue:
    """The OutQueue at a path, checked from end to end; raises UsageError or QueueError."""
    if not is_queue(path) and path.suffix.lower() != ".ncq" and path.is_file():
        raise UsageError(f"{path} is not an OutQueue; compile it first: nccompile compile {path}")
    return ncq.read(path).check()


def is_queue(path: Path) -> bool:
    """Whether a path is meant as an OutQueue: by its name or, whatever it is called, its first bytes."""
    if path == STDIN or path.is_fifo():  # a look into a pipe would take its bytes away
        return False
    if path.suffix.lower() == ".ncq":
        return True
    try:
        with path.open("rb") as file:
            return file.read(4) in _ZIP_STARTS
    except OSError as error:
        raise UsageError(f"{path} cannot be read: {error.strerror or error}") from error
