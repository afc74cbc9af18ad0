"""Writes the TextMate grammar of the VS Code extension from the decoder's tables; `make docs` runs it.

python -m tools.textmate
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

from nccompile.decoder.tables import AXES, INSTRUCTIONS, LETTERS, Group

ROOT = Path(__file__).parents[1]
GRAMMAR = ROOT / "editors" / "vscode" / "syntaxes" / "din66025.tmLanguage.json"

NUMBER = r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)"
VARIABLE = r"\$[A-Za-z_][A-Za-z0-9_.\[\]]*\$"

SCOPES = {
    Group.DRIVE: "keyword.control.drive",
    Group.FLOW: "keyword.control.flow",
    Group.VARIABLE: "keyword.operator.assignment",
}
"""Scopes of the groups of instructions; of all others `keyword.other.mode`."""

PARAMETERS = "".join(sorted(set(LETTERS) - AXES - set("GMNH")))


def grammar() -> dict[str, Any]:
    """The grammar; case has no meaning, so letters are matched in both."""
    words = [
        *(_word(codes, f"{scope}.din66025") for scope, codes in _instructions().items()),
        _named("invalid.illegal.instruction.din66025", rf"[Gg]{NUMBER}"),
        _word("[Mm]", "support.function.m.din66025"),
        _word("[Hh]", "support.function.switch.din66025"),
        _word(_letters("".join(sorted(AXES))), "variable.parameter.axis.din66025"),
        _word(_letters(PARAMETERS), "entity.other.attribute-name.din66025"),
    ]
    return {
        "name": "DIN 66025",
        "scopeName": "source.din66025",
        "fileTypes": ["nc", "cnc", "din", "iso"],
        "firstLineMatch": r"^%",
        "patterns": [
            {"include": "#comment"},
            {
                "match": r"^\s*(%)([^(]*)",
                "captures": {
                    "1": {"name": "punctuation.definition.program.din66025"},
                    "2": {"name": "entity.name.section.din66025"},
                },
            },
            _named("keyword.operator.skip.din66025", r"^\s*/"),
            _named("entity.name.label.din66025", r"[Nn][0-9]+"),
            *words,
        ],
        "repository": {"comment": _named("comment.block.din66025", r"\([^()]*\)")},
    }


def _instructions() -> dict[str, str]:
    """Expressions for the G codes of each scope."""
    codes: dict[str, list[int]] = {}
    for code, row in INSTRUCTIONS.items():
        codes.setdefault(SCOPES.get(row.group, "keyword.other.mode"), []).append(code)
    return {
        scope: "[Gg]0*(?:" + "|".join(str(c) for c in sorted(found)) + r")(?:\.0*)?(?![0-9.])"
        for scope, found in codes.items()
    }


def _letters(letters: str) -> str:
    return f"[{letters}{letters.lower()}]"


def _named(name: str, match: str) -> dict[str, Any]:
    return {"name": name, "match": match}


def _word(letter: str, name: str) -> dict[str, Any]:
    """A letter and its value; of an instruction both belong together."""
    if letter.startswith("[Gg]"):
        return _named(name, letter)
    return {
        "match": rf"({letter})(?:({NUMBER})|({VARIABLE}))",
        "captures": {
            "1": {"name": name},
            "2": {"name": "constant.numeric.din66025"},
            "3": {"name": "variable.other.din66025"},
        },
    }


def text() -> str:
    """The file's text."""
    return json.dumps(grammar(), indent=2) + "\n"


def main() -> None:
    """Writes the file."""
    GRAMMAR.parent.mkdir(parents=True, exist_ok=True)
    GRAMMAR.write_text(text(), encoding="utf-8")
    print(GRAMMAR.relative_to(ROOT), file=sys.stderr)


if __name__ == "__main__":
    main()
