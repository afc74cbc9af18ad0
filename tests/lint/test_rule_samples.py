"""Every rule's docstring is run: its bad programs give the code, its good ones do not."""

from __future__ import annotations

import tomllib
from dataclasses import replace
from pathlib import Path

import pytest

from nccompile.lint.base import Rule
from nccompile.lint.config import parse_config
from nccompile.lint.engine import Report, lint
from nccompile.lint.pages import Sheet, sheet_of
from nccompile.lint.registry import RULES
from nccompile.machine.model import Machine, default_machine
from nccompile.source import Source
from nccompile.toolchain import Options

SAMPLES = [
    (rule, text, is_bad)
    for rule in RULES
    for is_bad, texts in ((True, sheet_of(rule).bad), (False, sheet_of(rule).okay))
    for text in texts
]


def machine_for(sheet: Sheet) -> Machine:
    machine = default_machine()
    if sheet.machine != "rapid":
        return machine
    axes = {letter: axis.model_copy(update={"rapid": 100.0}) for letter, axis in machine.axes.items()}
    return machine.model_copy(update={"axes": axes})


def checked(rule: Rule, text: str) -> Report:
    table = {"lint": tomllib.loads(sheet_of(rule).settings)}
    config = replace(parse_config(table, "nccompile.toml", Path()), select=(rule.code,))
    return lint(Source("a.nc", text), Options(machine_for(sheet_of(rule))), config, limit=0)


@pytest.mark.parametrize(("rule", "text", "is_bad"), SAMPLES, ids=lambda value: getattr(value, "code", None))
def test_samples_of_the_docstring(rule: Rule, text: str, is_bad: bool) -> None:
    report = checked(rule, text)
    assert report.diagnostics.errors == 0
    assert (rule.code in {found.code for found in report.ordered()}) is is_bad


@pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule.code)
def test_rules_and_their_pages_have_what_they_need(rule: Rule) -> None:
    sheet = sheet_of(rule)
    assert rule.name.replace("-", "_") == type(rule).__module__.rpartition(".")[2]
    assert sheet.title.endswith(".")
    assert sheet.what
    assert sheet.why
    findings = checked(rule, sheet.bad[0])
    assert bool(findings.fixes) is bool(sheet.fix)


def test_there_are_enough_rules_and_no_code_is_used_twice() -> None:
    codes = [rule.code for rule in RULES]
    assert len(codes) >= 30
    assert codes == sorted(set(codes))
