"""Hover: what a word means, and what is in force behind its block."""

from __future__ import annotations

from nccompile.codes import PAGES
from nccompile.decoder.tables import AXES, INSTRUCTIONS, LETTERS, M_FUNCTION, Instruction
from nccompile.lsp.analysis import Analysis
from nccompile.lsp.document import Document
from nccompile.lsp.features.state import State, state_behind
from nccompile.lsp.features.words import Spot, spot_at
from nccompile.lsp.text import Place
from nccompile.parser import Word

__all__ = ["hover_text", "instruction_text", "word_text"]


def hover_text(document: Document, analysis: Analysis | None, at: Place) -> str | None:
    """Markdown for a position; None where nothing stands."""
    spot = spot_at(document, at)
    if spot is None or spot.word is None:
        return None
    parts = [word_text(spot.word, analysis)]
    if analysis is not None:
        if analysis.version == document.version:
            parts.append(_state_text(state_behind(analysis, spot.block.line)))
        parts += _findings(analysis, spot)
    return "\n\n".join(part for part in parts if part)


def word_text(word: Word, analysis: Analysis | None = None) -> str:
    """What a word means."""
    value = word.value
    letter = LETTERS.get(word.letter)
    if word.letter == "G" and isinstance(value, float):
        instruction = INSTRUCTIONS.get(int(value))
        return f"`{word.text}` is no instruction" if instruction is None else instruction_text(instruction)
    if word.letter == "M":
        return instruction_text(M_FUNCTION, word.text.upper())
    if letter is None:
        return f"`{word.text}`"
    unit = f" [{letter.unit}]" if letter.unit else ""
    return f"**{word.letter}**: {letter.meaning}{unit}"


def instruction_text(instruction: Instruction, name: str = "") -> str:
    """An instruction with the words that belong to it."""
    text = f"**{name or instruction.name}**: {instruction.effect}"
    if not instruction.operands:
        return text
    others = sorted(instruction.operands - AXES)
    rows = ["- axis words: target"] if instruction.operands & AXES else []
    rows += [f"- `{letter}` {LETTERS[letter].meaning}" for letter in others]
    return text + "\n\n" + "\n".join(rows)


def _state_text(state: State) -> str:
    words = [f"G{code}" for code in state.instructions]
    words += [f"{letter}{value}" for letter, value in _modal(state) if value]
    lines = ["Behind this block: `" + " ".join(words) + "`"]
    if state.position:
        shown = " ".join(f"{letter}{value:.6g}" for letter, value in state.position.items())
        lines.append(f"Position: `{shown}`")
    return "  \n".join(lines)


def _modal(state: State) -> list[tuple[str, str]]:
    return [("F", state.feed), ("E", state.accel), ("E", state.decel), ("D", state.radius)]


def _findings(analysis: Analysis, spot: Spot) -> list[str]:
    """The pages of the findings at a word."""
    assert spot.word is not None
    column = spot.word.column
    codes = {
        found.code
        for found in analysis.report.ordered()
        if found.span.line == spot.block.line and found.span.column <= column < found.span.end
    }
    return [f"{code}: {PAGES[code].why}" for code in sorted(codes) if code in PAGES]
