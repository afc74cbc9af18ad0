"""`nccompile lint`: findings of `compile` and of the rules, with safe fixes."""

from __future__ import annotations

import gc
import sys
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from nccompile.cli.options import Define, MachineFile, MaxJumps, SkipBlocks, Start

if TYPE_CHECKING:
    from nccompile.lint.engine import Report

__all__ = ["STDIN", "Format", "lint_programs", "programs_in", "read_bytes", "store"]

STDIN = Path("-")
ZIP = b"PK\x03\x04"

SUFFIXES = {".nc", ".cnc", ".din", ".iso"}
"""Files that are taken from folders."""


class Format(StrEnum):
    """How findings are written to standard output."""

    TEXT = "text"
    JSON = "json"
    SARIF = "sarif"
    GITHUB = "github"


def lint_programs(
    files: Annotated[
        list[Path], typer.Argument(help="Part programs, or folders with some; - reads standard input.")
    ],
    form: Annotated[Format, typer.Option("--format", help="Form of the findings.")] = Format.TEXT,
    fix: Annotated[
        bool, typer.Option("--fix", help="Apply safe fixes; the toolpath stays the same.")
    ] = False,
    select: Annotated[
        list[str] | None, typer.Option("--select", metavar="CODES", help="Only these codes: NC1,NC254.")
    ] = None,
    ignore: Annotated[
        list[str] | None, typer.Option("--ignore", metavar="CODES", help="Not these codes; errors stay.")
    ] = None,
    limit: Annotated[
        int | None, typer.Option("--limit", min=0, help="Findings shown of each code; 0 shows all.")
    ] = None,
    strict: Annotated[bool, typer.Option("--strict", help="Exit code 1 for warnings too.")] = False,
    statistics: Annotated[bool, typer.Option("--statistics", help="Count findings by code only.")] = False,
    machine: MachineFile = None,
    start: Start = None,
    define: Define = None,
    skip_blocks: SkipBlocks = False,
    max_jumps: MaxJumps = None,
) -> None:
    """Check part programs; settings come from nccompile.toml or pyproject.toml above them."""
    selected, ignored = _codes(select), _codes(ignore)
    sources = {path: read_bytes(path) for path in programs_in(files)}
    plain = form is Format.TEXT and machine is None and not (fix or statistics)
    if plain and all(not data.strip() for data in sources.values()):
        _say_empty(sources)
    from nccompile.cli.inputs import ProgramOptions, machine_of
    from nccompile.lint.config import Config, config_for
    from nccompile.lint.engine import lint
    from nccompile.lint.fix import apply_fixes
    from nccompile.lint.output import FORMATS
    from nccompile.lint.rewrite import encoding_of
    from nccompile.source import Source

    settings = ProgramOptions(start, define, skip_blocks, max_jumps)
    reports = []
    with _without_collection():
        for path, data in sources.items():
            config = (Config() if path == STDIN else config_for(path)).with_codes(selected, ignored)
            options = settings.resolve(machine_of(machine if machine is not None else config.machine))
            source = Source.from_bytes(_name(path), data)
            if fix:
                fixed = apply_fixes(source, options, config, limit)
                store(path, data, encoding_of(data).encode(fixed.text))
                if fixed.applied:
                    print(
                        f"{path}: {fixed.applied} finding{'s' * (fixed.applied != 1)} fixed", file=sys.stderr
                    )
                reports.append(fixed.report)
            else:
                reports.append(lint(source, options, config, limit=limit))
    out = sys.stderr if fix and STDIN in files else sys.stdout
    out.write(_statistics(reports) if statistics else FORMATS[form](reports))
    _close(reports, strict)


@contextmanager
def _without_collection() -> Iterator[None]:
    """No garbage collection: millions of words without cycles, looking for some takes a third of the time."""
    collecting = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if collecting:
            gc.freeze()  # what is alive now counts as old, else the next allocation would look through it all
            gc.unfreeze()
            gc.enable()


def _name(path: Path) -> str:
    return "<stdin>" if path == STDIN else str(path)


def _say_empty(sources: dict[Path, bytes]) -> None:
    """Reports programs without any text; the parser alone says all, and the rest of us starts slowly."""
    from nccompile.diagnostics import Diagnostics, render
    from nccompile.parser import parse
    from nccompile.source import Source

    for path, data in sources.items():
        source, diagnostics = Source.from_bytes(_name(path), data), Diagnostics()
        for _ in parse(source, diagnostics):
            raise AssertionError("a program without text has no block")
        for found in diagnostics:
            print(render(found, source))
        print(f"{source.name}: {diagnostics.closing}", file=sys.stderr)
    raise typer.Exit(1 if sources else 0)


def _codes(given: list[str] | None) -> tuple[str, ...]:
    from nccompile.errors import UsageError

    codes = [code.strip().upper() for text in given or () for code in text.split(",") if code.strip()]
    for code in codes:
        if not code.startswith("NC"):
            raise UsageError(f"{code} is no code; write NC151 or the first characters of some, NC15")
    return tuple(codes)


def programs_in(files: list[Path]) -> list[Path]:
    """The programs named, and those in the folders named, in the order of their names."""
    found: list[Path] = []
    for path in files:
        if path.is_dir():
            found += sorted(p for p in path.rglob("*") if p.suffix.lower() in SUFFIXES and p.is_file())
        else:
            found.append(path)
    return found


def read_bytes(path: Path) -> bytes:
    """The bytes of a program, `-` for standard input; raises UsageError."""
    from nccompile.errors import UsageError

    if path == STDIN:
        return sys.stdin.buffer.read()
    try:
        data = path.read_bytes()
    except OSError as error:
        raise UsageError(f"{path} cannot be read: {error.strerror or error}") from error
    if path.suffix.lower() == ".ncq" or data.startswith(ZIP):
        raise UsageError(f"{path} is an OutQueue, not a part program")
    return data


def store(path: Path, data: bytes, new: bytes) -> None:
    """Writes a changed program back; that of standard input goes to standard output."""
    from nccompile.backend.files import replacing

    if path == STDIN:
        sys.stdout.buffer.write(new)
        sys.stdout.flush()
    elif new != data:
        with replacing(path) as (file, commit):
            file.write(new)
            commit()


def _statistics(reports: list[Report]) -> str:
    from nccompile.codes import PAGES

    counts: Counter[str] = Counter()
    for report in reports:
        counts.update(report.diagnostics.counts)
    rows = sorted(counts.items(), key=lambda row: (-row[1], row[0]))
    return "".join(f"{count:8}  {code}  {PAGES[code].title}\n" for code, count in rows)


def _close(reports: list[Report], strict: bool) -> None:
    """The closing lines, and the exit code."""
    from nccompile.diagnostics import Severity

    failed = False
    for report in reports:
        if report.diagnostics.counts:
            print(f"{report.source.name}: {report.closing}", file=sys.stderr)
        failed = failed or report.diagnostics.errors > 0
        if strict:
            failed = failed or any(d.severity is not Severity.NOTE for d in report.ordered())
    if failed:
        raise typer.Exit(1)
