"""Findings as SARIF 2.1.0 (OASIS), the exchange format of code scanning services.

Columns count code points from 1, as everywhere here (`columnKind`).
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import PurePath
from typing import Any
from urllib.parse import quote

from nccompile.codes import PAGES
from nccompile.diagnostics import Diagnostic, Severity
from nccompile.lint.base import Fix
from nccompile.lint.engine import Findings
from nccompile.lint.registry import RULES
from nccompile.version import VERSION

__all__ = ["SCHEMA", "to_sarif"]

SCHEMA = "https://json.schemastore.org/sarif-2.1.0.json"

_LEVELS = {rule.code: str(rule.severity) for rule in RULES}


def to_sarif(reports: Sequence[Findings]) -> str:
    """One run with all findings; its rules are the codes that occur."""
    codes = sorted({found.code for report in reports for found in report.ordered()})
    index = {code: at for at, code in enumerate(codes)}
    results = [
        _result(found, index[found.code], report.fixes.get(found))
        for report in reports
        for found in report.ordered()
    ]
    driver = {"name": "nccompile", "version": VERSION, "rules": [_rule(code) for code in codes]}
    run = {"tool": {"driver": driver}, "columnKind": "unicodeCodePoints", "results": results}
    log = {"$schema": SCHEMA, "version": "2.1.0", "runs": [run]}
    return json.dumps(log, indent=1, ensure_ascii=False) + "\n"


def _rule(code: str) -> dict[str, Any]:
    page = PAGES[code]
    return {
        "id": code,
        "shortDescription": {"text": page.title},
        "fullDescription": {"text": page.why},
        "help": {"text": str(page)},
        "defaultConfiguration": {"level": _LEVELS.get(code, "warning")},
    }


def _result(found: Diagnostic, rule: int, fix: Fix | None) -> dict[str, Any]:
    place: dict[str, Any] = {"artifactLocation": {"uri": _uri(found.file)}}
    if found.span.line:
        place["region"] = _region(found.span.line, found.span.column, found.span.end)
    result: dict[str, Any] = {
        "ruleId": found.code,
        "ruleIndex": rule,
        "level": "note" if found.severity is Severity.NOTE else str(found.severity),
        "message": {"text": found.message + (f"; {found.help}" if found.help else "")},
        "locations": [{"physicalLocation": place}],
    }
    if fix is not None:
        replacements = [
            {"deletedRegion": _region(e.line, e.column, e.end), "insertedContent": {"text": e.text}}
            for e in fix.edits
        ]
        change = {"artifactLocation": {"uri": _uri(found.file)}, "replacements": replacements}
        result["fixes"] = [{"description": {"text": fix.title}, "artifactChanges": [change]}]
    return result


def _region(line: int, column: int, end: int) -> dict[str, int]:
    return {"startLine": line, "startColumn": column, "endColumn": max(end, column)}


def _uri(name: str) -> str:
    path = PurePath(name)
    return path.as_uri() if path.is_absolute() else quote(path.as_posix())
