"""Writes what is generated from the docstrings of the lint rules and from the codes:

src/nccompile/codes/lint_rules.py     the rules' pages, so that `nccompile explain` need not load the rules
docs/rules/*.md                       one page a code, and an index

`make docs` runs it; a test holds that the files are current.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

from nccompile.codes import PAGES
from nccompile.codes.page import Page
from nccompile.lint.base import Rule
from nccompile.lint.pages import markdown, sheet_of
from nccompile.lint.registry import RULES
from nccompile.lint.remedies import REMEDIES

ROOT = Path(__file__).parents[1]
MODULE = ROOT / "src" / "nccompile" / "codes" / "lint_rules.py"
FOLDER = ROOT / "docs" / "rules"

_HEAD = '''"""Pages of the lint rules.  Made from their docstrings by tools/rule_pages.py: do not edit."""

from nccompile.codes.page import Page

__all__ = ["PAGES"]

# fmt: off
PAGES: tuple[Page, ...] = (
'''


def module_text() -> str:
    """The text of codes/lint_rules.py."""
    rows = []
    for rule in RULES:
        page = sheet_of(rule).page(rule.code)
        fields = [f"{_literal(page.code)}, {_literal(page.title)}", _literal(page.why)]
        fields += [_literal(page.bad), _literal(page.good)]
        rows.append("    Page(\n" + "".join(f"        {text},\n" for text in fields) + "    ),\n")
    return _HEAD + "".join(rows) + ")\n"


def _literal(text: str) -> str:
    """A string literal in double quotes, cut where lines end so that none is long."""
    shown = [
        '"' + part.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n").replace("\r", "\\r")
        .replace("\t", "\\t").replace("\x0c", "\\x0c") + '"'
        for part in re.findall(r"[^\n]*\n|[^\n]+", text) or [""]
    ]  # fmt: skip
    joined = '"' + "".join(part[1:-1] for part in shown) + '"'
    return joined if len(joined) < 108 else "\n        ".join(shown)


def documents() -> dict[str, str]:
    """The documents of docs/rules by file name."""
    rules = {rule.code: rule for rule in RULES}
    texts = {}
    for code, page in pages().items():
        rule = rules.get(code)
        if rule is None:
            texts[f"{code}.md"] = markdown(page, REMEDIES[code].says if code in REMEDIES else "")
        else:
            texts[f"{code}.md"] = markdown(page, sheet_of(rule).fix, rule.severity, rule.default)
    rows = [
        f"| [{code}]({code}.md) | {page.title} | {_origin(code, rules.get(code))} |"
        for code, page in pages().items()
    ]
    texts["README.md"] = "\n".join(
        ["# Diagnostic codes", "", "Made by `make docs`; `nccompile explain CODE` prints the same pages.", "",
         "| code | | given by |", "| --- | --- | --- |", *rows, ""]
    )  # fmt: skip
    return texts


def pages() -> dict[str, Page]:
    """All pages; those of rules as their docstrings say now."""
    current = {rule.code: sheet_of(rule).page(rule.code) for rule in RULES}
    return dict(sorted({**PAGES, **current}.items()))


_ORIGINS = {
    "NC": "`compile`, `lint`",
    **dict.fromkeys(("NC302", "NC303", "NC304"), "`compile -p`"),
    "NC5": "`compile --verify`",
    "NC6": "`import-dxf`",
    "NC7": "`run`",
}
"""What gives the codes that begin so; the longest counts."""


def _origin(code: str, rule: Rule | None) -> str:
    if rule is None:
        return _ORIGINS[max((begin for begin in _ORIGINS if code.startswith(begin)), key=len)]
    return "`lint`" if rule.default else "`lint`, if selected"


def main() -> None:
    """Writes the files and removes documents of codes that are gone."""
    MODULE.write_text(module_text(), encoding="utf-8")
    FOLDER.mkdir(parents=True, exist_ok=True)
    wanted = documents()
    for path in FOLDER.glob("*.md"):
        if path.name not in wanted:
            path.unlink()
    for name, text in wanted.items():
        (FOLDER / name).write_text(text, encoding="utf-8")
    print(
        f"{MODULE.relative_to(ROOT)} and {len(wanted)} documents in {FOLDER.relative_to(ROOT)}",
        file=sys.stderr,
    )


if __name__ == "__main__":
    main()
