"""`nccompile lsp`: the language server on standard input and output."""

from __future__ import annotations

import os
import sys
from contextlib import redirect_stdout

from nccompile.errors import UsageError

__all__ = ["serve"]


def serve() -> None:
    """Serve an editor over standard input and output (extra [lsp])."""
    try:
        from nccompile.lsp.handlers import make_server
    except ModuleNotFoundError as error:
        if error.name is None or error.name.partition(".")[0] not in {"pygls", "lsprotocol"}:
            raise
        raise UsageError("the language server needs pygls: pip install 'nccompile[lsp]'") from None
    # Only the protocol may write to standard output: what is printed by accident goes to standard error.
    answers = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    with redirect_stdout(sys.stderr):
        make_server().start_io(sys.stdin.buffer, answers)
