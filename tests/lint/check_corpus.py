"""Lints, fixes and formats every .nc program of folders, as the tests do with the samples.

python -m tests.lint.check_corpus FOLDER|FILE..

No program may have errors; `lint` must give what `compile` gives, and of programs that docs/lint.md lists the
findings that are listed there; all fixes, each rule's alone and all together, and the formatter must keep the
toolpath to the bit and do nothing when run again.
"""

from __future__ import annotations

import re
import sys
from collections import Counter, defaultdict

from nccompile.lint.config import Config
from nccompile.lint.engine import lint
from nccompile.lint.fix import apply_fixes
from nccompile.lint.fmt import format_text, renumbered
from nccompile.lint.pages import sheet_of
from nccompile.lint.registry import RULES
from nccompile.lint.remedies import REMEDIES
from nccompile.lint.rewrite import same_path
from nccompile.source import Source
from nccompile.toolchain import Compilation
from nccompile.toolpath import Toolpath
from tests.corpus import checked
from tests.lint.programs import EVERY_RULE, OPTIONS, ROOT, read
from tests.lint.test_engine import compiled, linted

FIXING = [rule.code for rule in RULES if sheet_of(rule).fix] + list(REMEDIES)
_ROW = re.compile(r"^\| (\S+\.nc) \| (\d+)(?: (NC\d{3}))? \|", re.MULTILINE)


def path_of(source: Source) -> list[Toolpath]:
    return list(Compilation(source, OPTIONS).decoded())


def mangled(text: str) -> str:
    """The program with things to fix: small letters, tabs, blanks, repeated feeds."""
    lines = text.split("\n")
    for at in range(1, len(lines)):
        line = lines[at]
        if at % 5 == 0:
            line = line.lower()
        if at % 7 == 0:
            line = line.replace(" ", "\t", 1) + "  "
        if at % 11 == 0:
            line = line.replace(" ", "\v", 1)
        lines[at] = line
    return "\n".join(lines)


def listed() -> dict[str, Counter[str]]:
    """The findings by program that docs/lint.md lists."""
    found: dict[str, Counter[str]] = defaultdict(Counter)
    for name, count, code in _ROW.findall((ROOT / "docs" / "lint.md").read_text("utf-8")):
        found[name] += Counter({code: int(count)} if code else {})
    return found


def findings(source: Source) -> Counter[str]:
    """All findings by code; of NC451, which stands once, the moves it counts."""
    report = lint(source, OPTIONS, Config(), limit=0)
    assert report.diagnostics.errors == 0
    counts = Counter(report.diagnostics.counts)
    for found in report.ordered():
        more = re.search(r"; (\d+) more moves are", found.message)
        counts[found.code] += int(more[1]) if more is not None else 0
    return counts


def check(source: Source, expected: Counter[str] | None) -> str:
    assert linted(source) == compiled(source)
    counts = findings(source)
    assert expected is None or counts == expected, f"{dict(counts)}, docs/lint.md says {dict(expected)}"
    before = path_of(source)
    odd = Source(source.name, mangled(source.text))
    done = 0
    for start in (source, odd):
        for config in (EVERY_RULE, *(Config(select=(code,)) for code in FIXING)):
            fixed = apply_fixes(start, OPTIONS, config)
            assert same_path(before, path_of(Source(source.name, fixed.text)))
            done += fixed.applied
        laid_out = Source(source.name, format_text(start))
        assert same_path(before, path_of(laid_out))
        assert format_text(laid_out) == laid_out.text
        assert same_path(before, path_of(renumbered(start, 7)))
    found = ", ".join(f"{count} {code}" for code, count in sorted(counts.items()))
    return f"{done} fixes kept the path; findings: {found or 'none'}"


def main(places: list[str]) -> int:
    known = listed()
    return checked(places, lambda path: check(read(path), known.get(path.name)))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
