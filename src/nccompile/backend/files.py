"""Output files that are whole or not there."""

from __future__ import annotations

import os
import secrets
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import BinaryIO

from nccompile.errors import UsageError

__all__ = ["replacing", "write_file"]

_BUFFER = 1 << 20


@contextmanager
def replacing(path: Path) -> Iterator[tuple[BinaryIO, Callable[[], None]]]:
    """A file beside `path` that takes its name on commit and vanishes otherwise, Ctrl-C included."""
    place = Path(os.path.realpath(path))
    if place.exists() and not place.is_file():
        raise UsageError(f"{path} is there and is not a file: name another output with -o")
    part = place.with_name(f".{place.name[:200]}.{secrets.token_hex(4)}.part")
    committed = False
    file: BinaryIO | None = None

    def commit() -> None:
        nonlocal committed
        assert file is not None
        file.flush()
        os.fsync(file.fileno())
        file.close()
        part.replace(place)
        committed = True
        _sync_folder(place.parent)

    try:
        try:
            file = part.open("xb", buffering=_BUFFER)
        except OSError as error:
            raise UsageError(f"{path} cannot be written: {error.strerror}") from error
        yield file, commit
    except OSError as error:
        raise UsageError(f"{path} cannot be written: {error.strerror}") from error
    finally:
        if not committed:
            _discard(file, part)


def write_file(path: Path, content: bytes) -> None:
    """Writes a whole file; raises UsageError if it cannot be written."""
    with replacing(path) as (file, commit):
        file.write(content)
        commit()


def _discard(file: BinaryIO | None, part: Path) -> None:
    """Closes and removes an unfinished file.

    A full disk may make the close fail, and Ctrl-C may come between the making of the file and its handle: it
    is removed either way.
    """
    with suppress(OSError):
        if file is not None:
            file.close()
    with suppress(OSError):
        part.unlink()


def _sync_folder(folder: Path) -> None:
    """Makes the new name durable; file systems that cannot sync folders are left as they are."""
    try:
        handle = os.open(folder, os.O_RDONLY)
    except OSError:
        return
    try:
        os.fsync(handle)
    except OSError:
        return
    finally:
        os.close(handle)
