"""The TextMate grammar of the extension is made from the decoder's tables; `npm test` there tries it."""

from __future__ import annotations

import json
import re

import pytest

from nccompile.decoder.tables import INSTRUCTIONS, LETTERS
from tests.lint.programs import ROOT
from tools import textmate

FOLDER = ROOT / "editors" / "vscode"
RULES = textmate.grammar()["patterns"]


def first_match(text: str) -> str:
    """The name that the grammar gives the word at the start of a text, by its first rule that fits."""
    for rule in RULES:
        found = re.match(rule["match"], text) if "match" in rule else None
        if found:
            return str(rule.get("name") or rule["captures"]["1"]["name"])
    return ""


def test_the_file_is_current() -> None:
    """If this fails run `make docs`."""
    assert textmate.GRAMMAR.read_text(encoding="utf-8") == textmate.text()


@pytest.mark.parametrize("code", range(100))
def test_instructions_that_exist_are_marked_so(code: int) -> None:
    assert (first_match(f"G{code}") == "invalid.illegal.instruction.din66025") is (code not in INSTRUCTIONS)
    assert first_match(f"g0{code}") == first_match(f"G{code}")


@pytest.mark.parametrize("letter", LETTERS)
def test_every_letter_has_a_rule(letter: str) -> None:
    assert first_match(f"{letter}1") != ""
    assert first_match(f"{letter.lower()}1") == first_match(f"{letter}1")


def test_the_extension_knows_the_files_that_the_linter_takes_from_folders() -> None:
    package = json.loads((FOLDER / "package.json").read_text(encoding="utf-8"))
    (language,) = package["contributes"]["languages"]
    assert language["id"] == "din66025"
    assert set(textmate.grammar()["fileTypes"]) == {name.lstrip(".") for name in language["extensions"]}
    assert (FOLDER / package["main"]).is_file()
