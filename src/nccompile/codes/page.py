"""What a diagnostic code's page says."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["Page"]


@dataclass(frozen=True, slots=True)
class Page:
    """One code: what is wrong, why it matters, a program that shows it and one that does not.

    `bad` and `good` are DIN 66025 programs that the tests compile: the first must give the code, the second
    must not.  They are empty for codes that no program text alone can cause (machine limits, drives).
    """

    code: str
    title: str
    why: str
    bad: str = ""
    good: str = ""

    def __str__(self) -> str:
        parts = [f"{self.code}: {self.title}", self.why]
        if self.bad:
            parts.append("Gives it:\n" + _indent(self.bad))
        if self.good:
            parts.append("Use instead:\n" + _indent(self.good))
        return "\n\n".join(parts)


def _indent(program: str) -> str:
    return "\n".join("    " + line for line in program.strip("\n").split("\n"))
