"""Runs the rules over a program and puts their findings beside those of `compile`."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

from nccompile.diagnostics import Diagnostic, Diagnostics, Severity
from nccompile.lint.base import Fix
from nccompile.lint.config import Config
from nccompile.lint.ignores import Ignores
from nccompile.lint.program import Cancelled, Program, prepare
from nccompile.lint.registry import RULES
from nccompile.source import Source
from nccompile.toolchain import Options

__all__ = ["Report", "Selected", "check", "lint"]

ALL = 2**62
"""A limit that is none."""


@dataclass
class Report:
    """What was found in one program: all findings kept, and the safe fixes by the finding they belong to."""

    program: Program
    diagnostics: Diagnostics
    fixes: dict[Diagnostic, Fix] = field(default_factory=dict)

    @property
    def source(self) -> Source:
        """The program's text."""
        return self.program.source

    @property
    def closing(self) -> str:
        """One line that totals the findings by severity."""
        counts = self.diagnostics.counts
        notes = sum(counts[rule.code] for rule in RULES if rule.severity is Severity.NOTE)
        errors, total = self.diagnostics.errors, sum(counts.values())
        parts = [(errors, "error"), (total - errors - notes, "warning"), (notes, "note")]
        text = ", ".join(f"{n} {what}{'s' * (n != 1)}" for n, what in parts if n or what == "error")
        hidden = total - len(self.diagnostics.found)
        return text + (f" ({hidden} more of the same kinds not shown)" if hidden else "")

    def ordered(self) -> list[Diagnostic]:
        """The findings in the order of the text."""
        return list(self.diagnostics)


@dataclass(frozen=True)
class Selected:
    """Which findings are wanted: the settings and the program's own comments."""

    config: Config
    ignores: Ignores

    def wants(self, found: Diagnostic, on_by_default: bool = True) -> bool:
        """Whether a finding is shown; errors of `compile` always are."""
        if found.severity is Severity.ERROR:
            return True
        return self.config.shows(found.code, on_by_default) and not self.ignores.hides(found)


def lint(
    source: Source,
    options: Options,
    config: Config,
    *,
    limit: int | None = None,
    wanted: Callable[[], bool] | None = None,
) -> Report:
    """Checks a program.

    Args:     limit: findings kept of each code, those of `compile` if None, all if 0;  wanted: asked now and
              then whether to go on.
    Raises:   Cancelled: it was not wanted any more.
    """
    most = ALL if limit == 0 else limit
    goes_on = {} if wanted is None else {"wanted": wanted}
    return check(prepare(source, options, config, limit=most, **goes_on))


def check(program: Program) -> Report:
    """Runs the selected rules over a prepared program."""
    compiled = program.diagnostics
    selected = Selected(program.config, Ignores(program.blocks))
    report = Report(program, Diagnostics(compiled.limit))
    kept = report.diagnostics
    hidden: Counter[str] = Counter()
    for found in compiled.found:
        if selected.wants(found):
            kept.found.append(found)
        else:
            hidden[found.code] += 1
    shown = Counter(found.code for found in kept.found)
    for code, count in compiled.counts.items():
        if shown[code] or not hidden[code]:
            kept.counts[code] = count - hidden[code]
    kept.errors = compiled.errors
    for found, fix in _by_rules(program, selected):
        kept.add(found)
        if fix is not None and kept.counts[found.code] <= kept.limit:
            report.fixes[found] = fix
    return report


def _by_rules(program: Program, selected: Selected) -> Iterator[tuple[Diagnostic, Fix | None]]:
    """The wanted findings of the rules with their fixes."""
    if not program.blocks:
        return
    for rule in RULES:
        if not program.config.shows(rule.code, rule.default):
            continue
        if rule.needs_path and program.diagnostics.errors:
            continue
        if not program.wanted():
            raise Cancelled
        for finding in rule.check(program):
            found = Diagnostic(
                rule.code, rule.severity, finding.message, finding.span, program.source.name, finding.help
            )
            if selected.wants(found, rule.default):
                yield found, finding.fix
