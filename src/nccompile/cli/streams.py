"""Standard input and output as callers leave them: closed, full, a pipe that nobody reads, any encoding."""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Callable
from pathlib import Path

__all__ = ["forget_stdout", "prepare_streams", "say", "written"]


def prepare_streams() -> None:
    """Makes the standard streams fit for any text."""
    _open_closed_streams()
    _write_any_text()


def _open_closed_streams() -> None:
    """Gives streams that the caller has closed (`>&-`) an empty file, so that nobody need ask for them."""
    for name, mode in (("stdin", "r"), ("stdout", "w"), ("stderr", "w")):
        if getattr(sys, name) is None:
            setattr(sys, name, Path(os.devnull).open(mode, encoding="utf-8"))  # noqa: SIM115 - open till the end


def _write_any_text() -> None:
    """Files and pipes get UTF-8; what a terminal, or the name of a file, cannot say is written as an escape."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            fixed = stream.isatty() or "PYTHONIOENCODING" in os.environ
            stream.reconfigure(encoding=None if fixed else "utf-8", errors="backslashreplace")


def written(write: Callable[[], int]) -> int:
    """The exit code of something that writes to standard output, which is flushed.

    A reader that has gone (`| head`) is no error; where the output cannot be written the code is 2.
    """
    code = 0
    try:
        code = write()
        sys.stdout.flush()
    except BrokenPipeError:
        forget_stdout()
    except OSError as error:
        say(f"error: standard output cannot be written: {error.strerror or error}")
        forget_stdout()
        return 2
    return code


def forget_stdout() -> None:
    """Lets what is still written to standard output vanish, so that leaving Python does not fail on it."""
    nothing = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nothing, sys.stdout.fileno())
    os.close(nothing)


def say(text: str) -> None:
    """A line on standard error; if that is closed nobody wants it."""
    try:
        print(text, file=sys.stderr)
    except (OSError, ValueError):
        return
