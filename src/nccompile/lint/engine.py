"""Runs the rules over a program and puts their findings beside those of `compile`."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from typing import TypeAlias

from nccompile.diagnostics import Diagnostic, Diagnostics, Severity
from nccompile.errors import Cancelled
from nccompile.lint.base import Fix, Rule
from nccompile.lint.config import Config
from nccompile.lint.ignores import Ignores
from nccompile.lint.program import Program, always, prepare
from nccompile.lint.registry import RULES
from nccompile.lint.remedies import remedy
from nccompile.source import Source
from nccompile.toolchain import Options

__all__ = ["Findings", "Report", "Selected", "check", "lint"]

ALL = 2**62
"""A limit that is none."""

ALIKE = 5
"""Notes of a kind that are shown one by one; more of them are the habit of a post-processor."""

Fixable: TypeAlias = tuple[Diagnostic, Fix | None]


@dataclass
class Findings:
    """What was found in one program: its text, all findings kept, and the safe fixes by their finding."""

    source: Source
    diagnostics: Diagnostics
    fixes: dict[Diagnostic, Fix] = field(default_factory=dict)

    @property
    def closing(self) -> str:
        """One line that totals the findings by severity."""
        counts = self.diagnostics.counts
        notes = sum(counts[rule.code] for rule in RULES if rule.severity is Severity.NOTE)
        errors, total = self.diagnostics.errors, sum(counts.values())
        parts = [(errors, "error"), (total - errors - notes, "warning"), (notes, "note")]
        text = ", ".join(f"{n} {what}{'s' * (n != 1)}" for n, what in parts if n or what == "error")
        hidden = total - len(self.diagnostics.found)
        return text + (f" ({hidden} more of the same kinds, --limit 0 shows them)" if hidden else "")

    def ordered(self) -> list[Diagnostic]:
        """The findings in the order of the text."""
        return list(self.diagnostics)


@dataclass
class Report(Findings):
    """Findings together with the program as the rules saw it, which takes a hundred times their memory."""

    program: Program = field(kw_only=True)

    def findings(self) -> Findings:
        """The findings alone."""
        source = Source(self.source.name, self.source.text, self.source.sha256)
        return Findings(source, self.diagnostics, self.fixes)


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
    wanted: Callable[[], bool] = always,
) -> Report:
    """Checks a program.

    Args:     limit: findings kept of each code, all if 0; if None those of `compile`, and of notes beyond `ALIKE`
              one that counts them;  wanted: asked now and then whether to go on.
    Raises:   Cancelled: it was not wanted any more.
    """
    most = ALL if limit == 0 else limit
    return check(prepare(source, options, config, limit=most, wanted=wanted), gather=limit is None)


def check(program: Program, *, gather: bool) -> Report:
    """Runs the selected rules over a prepared program; with `gather` many notes of a kind become one."""
    compiled = program.diagnostics
    selected = Selected(program.config, Ignores(program.blocks))
    report = Report(program.source, Diagnostics(compiled.limit), program=program)
    kept = report.diagnostics
    hidden: Counter[str] = Counter()
    for found in compiled.found:
        if selected.wants(found):
            kept.found.append(found)
            _keep_fix(report, found, remedy(program, found))
        else:
            hidden[found.code] += 1
    shown = Counter(found.code for found in kept.found)
    for code, count in compiled.counts.items():
        if shown[code] or not hidden[code]:
            kept.counts[code] = count - hidden[code]
    kept.errors = compiled.errors
    for rule, findings in _by_rules(program, selected):
        total = len(findings)
        if gather and rule.severity is Severity.NOTE and total > ALIKE:
            findings = [_gathered(findings)]
        for found, fix in findings:
            kept.add(found)
            if kept.counts[found.code] <= kept.limit:
                _keep_fix(report, found, fix)
        kept.counts[rule.code] += total - len(findings)
    return report


def _keep_fix(report: Report, found: Diagnostic, fix: Fix | None) -> None:
    if fix is not None:
        report.fixes[found] = fix


def _by_rules(program: Program, selected: Selected) -> Iterator[tuple[Rule, list[Fixable]]]:
    """The rules that found something, with the wanted findings and their fixes; none where there is no program."""
    if all(block.is_empty for block in program.blocks):
        return
    for rule in RULES:
        if not program.config.shows(rule.code, rule.default):
            continue
        if rule.needs_path and program.diagnostics.errors:
            continue
        if not program.wanted():
            raise Cancelled
        findings: list[Fixable] = []
        for finding in rule.check(program):
            found = Diagnostic(
                rule.code, rule.severity, finding.message, finding.span, program.source.name, finding.help
            )
            if selected.wants(found, rule.default):
                findings.append((found, finding.fix))
        if findings:
            found, fix = findings[0]
            findings[0] = found, fix or rule.fix_all(program)
            yield rule, findings


def _gathered(findings: list[Fixable]) -> Fixable:
    """Many findings of a rule as one, at the first place."""
    ordered = sorted(findings, key=lambda one: one[0].span)
    found, fix = ordered[0]
    more, last = len(findings) - 1, ordered[-1][0].span.line
    fixes = [one for _, one in ordered if one is not None]
    if len(fixes) > 1:
        fix = Fix(
            f"{fixes[0].title}, and {len(fixes) - 1} more", tuple(e for one in fixes for e in one.edits)
        )
    return replace(found, message=f"{found.message}; {more} more like this, the last in line {last}"), fix
