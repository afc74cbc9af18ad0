"""docs/language.md names every letter and instruction of the decoder's tables, and no others."""

import re
from pathlib import Path

from nccompile.decoder.tables import INSTRUCTIONS, LETTERS

PAGE = (Path(__file__).parents[2] / "docs" / "language.md").read_text()


def _first_cells(heading: str) -> set[str]:
    section = PAGE.partition(f"## {heading}\n")[2].partition("\n## ")[0]
    cells = re.findall(r"^\| ([A-Z][A-Z0-9, ]*) \|", section, re.MULTILINE)
    return {name.strip() for cell in cells for name in cell.split(",")}


def test_letters() -> None:
    assert _first_cells("Letters") == set(LETTERS)


def test_instructions() -> None:
    assert _first_cells("Instructions") == {f"G{code}" for code in INSTRUCTIONS}
