"""Settings of the linter: nccompile.toml, or [tool.nccompile] of pyproject.toml, nearest above the program.

machine = "mill3.toml"          machine file, relative to this file

[lint]
select = ["NC"]                 codes or their first characters; default: every rule that is on
extend-select = ["NC153"]       in addition, also rules that are off by default
ignore = ["NC055"]              warnings and notes that are not shown; errors always are
min-segment = 0.001             mm, NC254
min-radius = 0.005              mm, NC252
acknowledged-m = [3, 5]         M functions that the machine acknowledges, NC172; default: not known

[format]
step = 10                       distance of block numbers of `fmt --renumber`
"""

from __future__ import annotations

import difflib
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import isfinite
from pathlib import Path
from typing import Any

from nccompile.codes import PAGES
from nccompile.errors import UsageError

__all__ = ["Config", "config_for", "known_codes", "parse_config"]


@dataclass(frozen=True)
class Config:
    """What the linter and the formatter can be told; see the module's docstring."""

    select: tuple[str, ...] = ()
    extend_select: tuple[str, ...] = ()
    ignore: tuple[str, ...] = ()
    min_segment: float = 0.001
    min_radius: float = 0.005
    acknowledged_m: frozenset[int] | None = None
    step: int = 10
    machine: Path | None = None

    def shows(self, code: str, on_by_default: bool = True) -> bool:
        """Whether warnings and notes of a code are wanted; the longest prefix that fits decides."""
        chosen = _longest(self.select, code) if self.select else (0 if on_by_default else -1)
        if not on_by_default and 0 <= chosen < len(code):
            chosen = -1  # rules that are off come only by their full code
        chosen = max(chosen, _longest(self.extend_select, code))
        return chosen > _longest(self.ignore, code) if self.ignore else chosen >= 0

    def with_codes(self, select: tuple[str, ...], ignore: tuple[str, ...]) -> Config:
        """These settings with those of the command line on top."""
        return replace(self, select=select or self.select, ignore=(*self.ignore, *ignore))


def _longest(prefixes: tuple[str, ...], code: str) -> int:
    return max((len(prefix) for prefix in prefixes if code.startswith(prefix)), default=-1)


def known_codes(prefixes: Sequence[str], where: str) -> tuple[str, ...]:
    """Codes or their first characters in upper case; raises UsageError for those that no code starts with."""
    found = tuple(prefix.strip().upper() for prefix in prefixes)
    for prefix in found:
        if not prefix or not any(code.startswith(prefix) for code in PAGES):
            raise UsageError(
                f"{where}: there is no code {prefix or repr(prefix)}; `nccompile explain` lists all"
            )
    return found


_LISTS = ("select", "extend-select", "ignore")
_LENGTHS = ("min-segment", "min-radius")
_KEYS = {
    "": ("machine", "lint", "format"),
    "lint.": (*_LISTS, *_LENGTHS, "acknowledged-m"),
    "format.": ("step",),
}


def parse_config(table: dict[str, Any], name: str, folder: Path) -> Config:
    """The settings of a parsed file; raises UsageError for keys and values it must not have."""
    _known(table, "", name)
    lint, form = table.get("lint", {}), table.get("format", {})
    for section, prefix in ((lint, "lint."), (form, "format.")):
        if not isinstance(section, dict):
            raise UsageError(f"{name}: [{prefix[:-1]}] must be a section")
        _known(section, prefix, name)
    values: dict[str, Any] = {}
    for key in _LISTS:
        values[key.replace("-", "_")] = _codes(lint.get(key, []), f"{name}: lint.{key}")
    for key in _LENGTHS:
        if key in lint:
            values[key.replace("-", "_")] = _length(lint[key], f"{name}: lint.{key}")
    if "acknowledged-m" in lint:
        values["acknowledged_m"] = _numbers(lint["acknowledged-m"], f"{name}: lint.acknowledged-m")
    step = form.get("step", 10)
    if not isinstance(step, int) or isinstance(step, bool) or not 1 <= step <= 1000:
        raise UsageError(f"{name}: format.step must be a whole number from 1 to 1000, not {step!r}")
    machine = table.get("machine")
    if machine is not None and not isinstance(machine, str):
        raise UsageError(f"{name}: machine must be the name of a file")
    return Config(**values, step=step, machine=None if machine is None else folder / machine)


def _known(table: dict[str, Any], prefix: str, name: str) -> None:
    known = _KEYS[prefix]
    for key in table:
        if key not in known:
            near = difflib.get_close_matches(key, known, n=1)
            hint = f"did you mean {near[0]}?" if near else f"known are {', '.join(known)}"
            raise UsageError(f"{name}: unknown key {prefix}{key}; {hint}")


def _codes(value: object, where: str) -> tuple[str, ...]:
    if not isinstance(value, list) or not all(isinstance(v, str) for v in value):
        raise UsageError(f'{where} must be a list of codes or their first characters, as in ["NC15"]')
    return known_codes(value, where)


def _numbers(value: object, where: str) -> frozenset[int]:
    if not isinstance(value, list) or not all(type(v) is int and v >= 0 for v in value):
        raise UsageError(f"{where} must be a list of whole numbers, as in [3, 5]")
    return frozenset(value)


def _length(value: object, where: str) -> float:
    if not isinstance(value, int | float) or isinstance(value, bool) or not isfinite(value) or value < 0:
        raise UsageError(f"{where} must be a length in mm, not {value!r}")
    return float(value)


def config_for(path: Path) -> Config:
    """The settings that hold for a program: of the nearest file above it that has some, else the defaults."""
    for folder in path.absolute().parents:
        own, project = folder / "nccompile.toml", folder / "pyproject.toml"
        if own.is_file():
            return parse_config(_load(own), str(own), folder)
        if project.is_file():
            tool = _load(project).get("tool")
            table = tool.get("nccompile") if isinstance(tool, dict) else None
            if isinstance(table, dict):
                return parse_config(table, str(project), folder)
            if table is not None:
                raise UsageError(f"{project}: [tool.nccompile] must be a section")
    return Config()


def _load(path: Path) -> dict[str, Any]:
    try:
        return tomllib.loads(path.read_text("utf-8-sig"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, OSError, RecursionError) as error:
        raise UsageError(f"{path}: cannot be read: {error}") from None
