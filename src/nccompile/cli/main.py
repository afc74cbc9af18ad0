"""Entry point of the `nccompile` command."""

from __future__ import annotations

import sys

from nccompile.cli.streams import prepare_streams, written
from nccompile.version import VERSION

__all__ = ["main"]


def main() -> None:
    """Runs the command line and leaves with its exit code; `--version` answers before anything is loaded."""
    arguments = sys.argv[1:]
    if arguments in (["--version"], ["-V"]):
        prepare_streams()
        if code := written(_say_version):
            sys.exit(code)
        return
    from nccompile.cli.app import run

    sys.exit(run(arguments))


def _say_version() -> int:
    print(f"nccompile {VERSION}")
    return 0
