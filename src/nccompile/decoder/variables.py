"""Variables: the named ones of the program and `--define`, and the implicit one (SoftMotion §3.2.3, §3.2.8)."""

from __future__ import annotations

import difflib
from collections.abc import Mapping

__all__ = ["INT_MAX", "INT_MIN", "Variables"]

INT_MIN, INT_MAX = -32768, 32767
"""Range of the implicit variable, an IEC INT."""


class Variables:
    """Values by name; names have no case.

    `version` changes whenever a value does: two equal versions mean equal values.
    """

    def __init__(self, defines: Mapping[str, float]) -> None:
        self._values = {name.lower(): float(value) for name, value in defines.items()}
        self._shown = {name.lower(): name for name in defines}
        self.implicit = 0.0
        self.version = 0

    def get(self, name: str) -> float | None:
        """The value, or None for an unknown name."""
        return self._values.get(name.lower())

    def set(self, name: str, value: float) -> None:
        """Sets a value; an unknown name becomes known."""
        key = name.lower()
        if self._values.get(key) != value:
            self.version += 1
        self._shown.setdefault(key, name)
        self._values[key] = value

    def set_implicit(self, value: float) -> None:
        """Sets the implicit variable."""
        if self.implicit != value:
            self.version += 1
        self.implicit = value

    def advice(self, name: str) -> str:
        """What to do about an unknown name: the one that was meant, or all known ones."""
        known = sorted(self._shown.values())
        near = difflib.get_close_matches(name.lower(), list(self._shown), n=1)
        if near:
            return f"did you mean ${self._shown[near[0]]}$?"
        how = f"set it with G36 O${name}$ D.. or --define {name}=VALUE"
        return f"{how}; known are {', '.join(known[:12])}" if known else how
