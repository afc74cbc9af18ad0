"""SARIF logs are valid by the published schema of SARIF 2.1.0 (tests/lint/schemas)."""

from __future__ import annotations

import functools
import json
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft4Validator  # type: ignore[import-untyped]

from nccompile.lint.engine import lint
from nccompile.lint.output import FORMATS
from nccompile.lint.pages import sheet_of
from nccompile.lint.registry import RULES
from nccompile.source import Source
from tests.lint.programs import EVERY_RULE, OPTIONS, SAMPLES, read

SCHEMA = Path(__file__).parent / "schemas" / "sarif-2.1.0-rtm.5.json"


@functools.cache
def validator() -> Any:
    schema = json.loads(SCHEMA.read_text("utf-8"))
    Draft4Validator.check_schema(schema)
    return Draft4Validator(schema)


def assert_valid(log: dict[str, Any]) -> None:
    errors = [error.message for error in validator().iter_errors(log)]
    assert errors == []


def log_of(sources: list[Source]) -> dict[str, Any]:
    reports = [lint(source, OPTIONS, EVERY_RULE) for source in sources]
    log: dict[str, Any] = json.loads(FORMATS["sarif"](reports))
    return log


def test_every_rule_and_every_sample_in_one_log() -> None:
    bad = [Source(f"{rule.code}.nc", text) for rule in RULES for text in sheet_of(rule).bad]
    log = log_of([*bad, *(read(path) for path in SAMPLES)])
    assert_valid(log)
    assert sum("fixes" in result for result in log["runs"][0]["results"]) > 5


@pytest.mark.parametrize("name", ["größe 1.nc", "/jobs/50%.nc", "<stdin>", "a\\b.nc", "-"])
@pytest.mark.parametrize("text", ["", "N10 G1 X1\n", "% a\nN10 G1 X1,5", "\x00"])
def test_odd_names_and_texts(name: str, text: str) -> None:
    assert_valid(log_of([Source(name, text)]))


def test_no_program_at_all() -> None:
    assert_valid(log_of([]))


def test_the_schema_refuses_what_is_not_sarif() -> None:
    log = log_of([Source("a.nc", "% a\nN10 G7")])
    log["runs"][0]["results"][0]["locations"][0]["physicalLocation"]["region"]["startLine"] = 0
    assert not validator().is_valid(log)
