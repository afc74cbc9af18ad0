"""`nccompile fmt`: one layout for part programs, and new block numbers."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

__all__ = ["format_programs"]


def format_programs(
    files: Annotated[
        list[Path], typer.Argument(help="Part programs, or folders with some; - reads standard input.")
    ],
    renumber: Annotated[
        bool, typer.Option("--renumber", help="Number the blocks anew; jumps follow their targets.")
    ] = False,
    check: Annotated[
        bool, typer.Option("--check", help="Change nothing; exit code 1 if a file would change.")
    ] = False,
    step: Annotated[
        int | None, typer.Option("--step", min=1, max=1000, help="Distance of block numbers; default 10.")
    ] = None,
) -> None:
    """Lay part programs out: upper case, one blank between words; the toolpath stays the same."""
    from nccompile.cli.programs import name_of, programs_in, read_bytes, require_file, store
    from nccompile.cli.queues import STDIN
    from nccompile.errors import UsageError
    from nccompile.lint.config import Config, config_for
    from nccompile.lint.fmt import format_text, is_text, renumbered
    from nccompile.lint.rewrite import encoding_of
    from nccompile.source import Source

    changed = 0
    for path in programs_in(files):
        if not check:
            require_file(path)
        data = read_bytes(path)
        source = Source.from_bytes(name_of(path), data)
        if not is_text(source):
            raise UsageError(f"{source.name} is not a text file; it stays as it is")
        config = Config() if path == STDIN else config_for(path)
        if renumber:
            source = renumbered(source, config.step if step is None else step)
        new = encoding_of(data).encode(format_text(source))
        if not check:
            store(path, data, new)
        if new != data:
            changed += 1
            print(f"{source.name}: {'would be laid out' if check else 'laid out'}", file=sys.stderr)
    if check and changed:
        raise typer.Exit(1)
