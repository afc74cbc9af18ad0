"""What kind of file a path names, and OutQueues that commands read; nothing here needs what compiles."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from nccompile.errors import UsageError

if TYPE_CHECKING:
    from nccompile.backend import ncq

__all__ = ["STDIN", "is_queue", "read_queue", "refuse_device", "require_program"]

STDIN = Path("-")
_ZIP_STARTS = (b"PK\x03\x04", b"PK\x05\x06")


def read_queue(path: Path) -> ncq.Queue:
    """The OutQueue at a path, checked from end to end; raises UsageError or QueueError."""
    from nccompile.backend import ncq

    refuse_device(path, "an OutQueue")
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


def require_program(path: Path) -> None:
    """Raises UsageError if a path cannot be a part program: an OutQueue, or a device without end."""
    if is_queue(path):
        raise UsageError(f"{path} is an OutQueue, not a part program: it was compiled already")
    refuse_device(path, "a part program; - reads standard input")


def refuse_device(path: Path, wanted: str) -> None:
    """Raises UsageError if a path is a device: reading it might never end."""
    if path.is_char_device() or path.is_block_device():
        raise UsageError(f"{path} is a device, not {wanted}")
