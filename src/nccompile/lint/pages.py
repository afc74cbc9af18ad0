"""The docstrings of rules as pages of their codes, and as Markdown."""

from __future__ import annotations

import inspect
import re
from typing import NamedTuple

from nccompile.codes.page import Page
from nccompile.lint.base import Rule

__all__ = ["Sheet", "markdown", "sheet_of"]

_LABEL = re.compile(r"(What|Why|Fix|Machine|Settings|Okay|NC\d{3}): ?(.*)")
_ESCAPE = re.compile(r"\\(n|r|t|x[0-9a-f]{2})")
_MEANING = {"n": "\n", "r": "\r", "t": "\t"}


class Sheet(NamedTuple):
    """The parts of a rule's docstring; `bad` and `okay` are its sample programs.

    fix: what its fix does, empty if it has none;  machine, settings: what the samples' machine must have, and
    the lines below [lint] in their settings.
    """

    title: str
    what: str
    why: str
    bad: tuple[str, ...]
    okay: tuple[str, ...]
    fix: str = ""
    machine: str = ""
    settings: str = ""

    def page(self, code: str) -> Page:
        """The page for `nccompile explain`."""
        why = f"{_sentence(self.what)}\n{_sentence(self.why)}"
        if self.settings:
            why += f"\nThe example below gives it with this in the settings, below [lint]: {self.settings}"
        return Page(code, self.title.rstrip("."), why, self.bad[0], self.okay[0])


def sheet_of(rule: Rule | type[Rule]) -> Sheet:
    """The parts of a rule's docstring."""
    kind = rule if isinstance(rule, type) else type(rule)
    lines = (inspect.getdoc(kind) or "").splitlines()
    parts: dict[str, list[str]] = {}
    label = ""
    for line in lines[1:]:
        found = _LABEL.fullmatch(line)
        if found is not None:
            label = found[1]
            parts.setdefault(label, []).append(found[2])
        elif label and line.strip():
            parts[label][-1] += "\n" + line
    texts = {name: "\n".join(values) for name, values in parts.items()}
    return Sheet(
        lines[0],
        texts["What"],
        texts["Why"],
        tuple(_program(text) for text in parts[kind.code]),
        tuple(_program(text) for text in parts["Okay"]),
        texts.get("Fix", ""),
        texts.get("Machine", ""),
        texts.get("Settings", ""),
    )


def _program(text: str) -> str:
    def meaning(found: re.Match[str]) -> str:
        return _MEANING.get(found[1]) or chr(int(found[1][1:], 16))

    return _ESCAPE.sub(meaning, text)


def _sentence(text: str) -> str:
    return text[:1].upper() + text[1:]


def markdown(page: Page, fix: str = "", severity: str = "", is_default: bool = True) -> str:
    """The page of a code as a Markdown document."""
    parts = [f"# {page.code}: {page.title}", page.why]
    notes = [f"Given by `nccompile lint` as a {severity}."] if severity else []
    if not is_default:
        notes.append(f'Off by default: `extend-select = ["{page.code}"]` turns it on.')
    if fix:
        notes.append(f"`--fix` {fix}" if severity else f"`nccompile lint --fix` {fix}")
    if notes:
        parts.append(" ".join(notes))
    if page.bad:
        parts.append(f"Gives it:\n\n```\n{_shown(page.bad)}\n```")
    if page.good:
        parts.append(f"Use instead:\n\n```\n{_shown(page.good)}\n```")
    return "\n\n".join(parts) + "\n"


def _shown(program: str) -> str:
    return "".join(
        c if c == "\n" or c.isprintable() else f"<{ord(c):02X}>" for c in program.replace("\r\n", "<0D>\n")
    ).strip("\n")
