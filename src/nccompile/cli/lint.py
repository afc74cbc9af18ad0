"""`nccompile lint`: findings of `compile` and of the rules, with safe fixes."""

from __future__ import annotations

import gc
import sys
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from enum import StrEnum
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from nccompile.cli.options import MachineFile, ReadOptions
from nccompile.cli.queues import STDIN

if TYPE_CHECKING:
    from nccompile.lint.config import Config
    from nccompile.lint.engine import Findings
    from nccompile.toolchain import Options

__all__ = ["Format", "lint_programs"]


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
    *,
    chosen: ReadOptions,
) -> None:
    """Check part programs; settings come from nccompile.toml or pyproject.toml above them."""
    from nccompile.cli.programs import programs_in, read_bytes, require_file
    from nccompile.lint.config import Config, config_for, known_codes

    selected = known_codes(_parts(select), "--select")
    ignored = known_codes(_parts(ignore), "--ignore")
    texts = {}
    for path in programs_in(files):
        if fix:
            require_file(path)
        config = (Config() if path == STDIN else config_for(path)).with_codes(selected, ignored)
        texts[path] = (config, read_bytes(path))
    if form is Format.TEXT and machine is None and not (fix or statistics):
        _say_empty({path: data for path, (_, data) in texts.items()})
    from nccompile.cli.inputs import machine_of
    from nccompile.lint.output import FORMATS

    found = []
    machines = cache(machine_of)
    with _without_collection():
        for path, (config, data) in texts.items():
            options = chosen.resolve(machines(machine if machine is not None else config.machine))
            found.append(_check(path, data, options, config, limit, fix))
    out = sys.stderr if fix and STDIN in texts else sys.stdout
    out.write(_statistics(found) if statistics else FORMATS[form](found))
    _close(found, strict)


def _check(
    path: Path, data: bytes, options: Options, config: Config, limit: int | None, fix: bool
) -> Findings:
    """The findings in a program; with `fix` those that are left after it was fixed."""
    from nccompile.cli.programs import name_of, store
    from nccompile.lint.engine import lint
    from nccompile.lint.fix import apply_fixes
    from nccompile.lint.rewrite import encoding_of
    from nccompile.source import Source

    source = Source.from_bytes(name_of(path), data)
    if fix:
        fixed = apply_fixes(source, options, config)
        store(path, data, encoding_of(data).encode(fixed.text))
        if fixed.applied:
            print(
                f"{source.name}: {fixed.applied} finding{'s' * (fixed.applied != 1)} fixed", file=sys.stderr
            )
        source = Source(source.name, fixed.text, source.sha256)
    return lint(source, options, config, limit=limit).findings()


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


def _say_empty(sources: dict[Path, bytes]) -> None:
    """Reports programs that have no block and ends; the parser alone says all, and the rest of us starts slowly.

    Does nothing if a program has one, or a warning, which may not be wanted.
    """
    from nccompile.cli.programs import name_of
    from nccompile.diagnostics import Diagnostics, render
    from nccompile.parser import parse
    from nccompile.source import Source

    empty = []
    for path, data in sources.items():
        source, diagnostics = Source.from_bytes(name_of(path), data), Diagnostics()
        if any(not block.is_empty for block in parse(source, diagnostics)):
            return
        if diagnostics.errors != sum(diagnostics.counts.values()):
            return
        empty.append((source, diagnostics))
    for source, diagnostics in empty:
        for found in diagnostics:
            print(render(found, source))
        print(f"{source.name}: {diagnostics.closing}", file=sys.stderr)
    raise typer.Exit(1 if sources else 0)


def _parts(given: list[str] | None) -> list[str]:
    """The codes of an option that takes several, between commas or given again."""
    return [code for text in given or () for code in text.split(",")]


def _statistics(reports: list[Findings]) -> str:
    from nccompile.codes import PAGES

    counts: Counter[str] = Counter()
    for report in reports:
        counts.update(report.diagnostics.counts)
    rows = sorted(counts.items(), key=lambda row: (-row[1], row[0]))
    return "".join(f"{count:8}  {code}  {PAGES[code].title}\n" for code, count in rows)


def _close(reports: list[Findings], strict: bool) -> None:
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
