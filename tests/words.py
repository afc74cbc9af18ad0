"""Text with numbers, compared to the letter and to a tolerance."""

from __future__ import annotations

__all__ = ["is_same"]


def is_same(word: str, wanted: str, absolute: float, relative: float = 0.0) -> bool:
    """Whether two words are the same, numbers to the greater of an absolute and a relative tolerance."""
    if word == wanted:
        return True
    try:
        number, aim = float(word), float(wanted)
    except ValueError:
        return False
    return abs(number - aim) <= max(absolute, relative * abs(aim))
