"""What is wrong with a machine file, in words: file, dotted key, what was expected, what was found."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable, Sequence
from typing import Any, get_args

from pydantic import BaseModel, ValidationError
from pydantic.fields import FieldInfo
from pydantic_core import ErrorDetails

__all__ = ["explain", "explain_syntax"]

_SHOWN = 10
_SHOWN_VALUE = 40


def explain_syntax(name: str, error: tomllib.TOMLDecodeError | RecursionError) -> str:
    """One line `file:line:column: what` for a text that is not TOML."""
    if isinstance(error, RecursionError):
        return f"{name}: not a machine file: values are nested too deeply"
    text = str(error)
    place = re.search(r" \(at line (\d+), column (\d+)\)$", text)
    if place is None:
        text = text.replace(" (at end of document)", " at the end of the file")
        return f"{name}: TOML syntax: {_lower_first(text)}"
    return f"{name}:{place[1]}:{place[2]}: TOML syntax: {_lower_first(text[: place.start()])}"


def explain(name: str, model: type[BaseModel], error: ValidationError) -> str:
    """One line for each finding of pydantic, at most 10 of them, in the order of the model."""
    found = error.errors(include_url=False)
    lines = [f"{name}: {_finding(model, detail)}" for detail in found[:_SHOWN]]
    if len(found) > _SHOWN:
        lines.append(f"{name}: and {len(found) - _SHOWN} more errors")
    return "\n".join(lines)


def _finding(model: type[BaseModel], detail: ErrorDetails) -> str:
    """The finding of one key."""
    keys = tuple(str(key) for key in detail["loc"] if key != "[key]")
    dotted = ".".join(keys)
    kind = detail["type"]
    if kind == "value_error":
        said = str(detail["ctx"]["error"])
        return f"{dotted}: {said}" if dotted else said
    if kind == "extra_forbidden":
        return f"{dotted}: unknown key{_suggestion(keys[-1], _known(model, keys[:-1]))}"
    field = _field(model, keys)
    if kind == "missing":
        return f"{dotted}: missing; expected {_expected(field, detail)}"
    return f"{dotted}: expected {_expected(field, detail)}, found {_shown(detail['input'])}"


def _known(model: type[BaseModel], keys: Sequence[str]) -> list[str]:
    """The keys that may stand at a place of the file."""
    for key in keys:
        model = _submodel(_by_name(model, key)) or model
    return [field.alias or name for name, field in model.model_fields.items()]


def _field(model: type[BaseModel], keys: Sequence[str]) -> FieldInfo | None:
    """The declaration of the key at the end of `keys`; a letter below a table of sections is passed over."""
    field: FieldInfo | None = None
    current: type[BaseModel] | None = model
    for key in keys:
        declared = _by_name(current, key) if current is not None else None
        if declared is None:
            continue
        field = declared
        current = _submodel(declared)
    return field


def _by_name(model: type[BaseModel], key: str) -> FieldInfo | None:
    return next((f for n, f in model.model_fields.items() if (f.alias or n) == key), None)


def _submodel(field: FieldInfo | None) -> type[BaseModel] | None:
    """The section type that a key holds, directly or in a table by name."""
    if field is None:
        return None
    for candidate in (field.annotation, *get_args(field.annotation)):
        if isinstance(candidate, type) and issubclass(candidate, BaseModel):
            return candidate
    return None


def _expected(field: FieldInfo | None, detail: ErrorDetails) -> str:
    """What a key takes: type, unit and bounds."""
    kind = detail["type"]
    if kind == "literal_error":
        return str(detail["ctx"]["expected"]).replace("'", '"')
    if kind == "too_short":
        return "at least one section [axes.<letter>]"
    if kind in ("model_type", "dict_type", "model_attributes_type") or field is None or _submodel(field):
        return "a section (a TOML table)"
    unit = field.json_schema_extra.get("unit", "") if isinstance(field.json_schema_extra, dict) else ""
    types = {field.annotation, *get_args(field.annotation)}
    if str in types and float not in types:
        return f"a text of 1 to 100 characters ({unit})"
    choices = [str(c) for c in types if isinstance(c, str)]
    if choices:
        return " or ".join(f'"{c}"' for c in sorted(choices))
    noun = "a number" if float in types else "a whole number"
    return f"{noun} of {unit}{_bounds(field.metadata)}"


def _bounds(metadata: Iterable[Any]) -> str:
    """The bounds in words, e.g. ", greater than 0 and at most 1e+06"."""
    words = {"gt": "greater than", "ge": "at least", "le": "at most"}
    parts = [
        f"{text} {getattr(m, name):.10g}"
        for m in metadata
        for name, text in words.items()
        if hasattr(m, name)
    ]
    return ", " + " and ".join(parts) if parts else ""


def _suggestion(key: str, known: Sequence[str]) -> str:
    """The nearest known key, or the list of all."""
    import difflib  # noqa: PLC0415 - only when something is wrong

    near = difflib.get_close_matches(key, known, n=1, cutoff=0.6)
    return f"; did you mean {near[0]}?" if near else f"; known keys: {', '.join(known)}"


def _shown(value: Any) -> str:
    if isinstance(value, dict):
        return "a table" if value else "an empty table"
    if isinstance(value, list):
        return "a list"
    if isinstance(value, str):
        text = '"' + value + '"'
    elif isinstance(value, bool):
        text = str(value).lower()
    else:
        text = str(value)
    return text if len(text) <= _SHOWN_VALUE else text[: _SHOWN_VALUE - 3] + "..."


def _lower_first(text: str) -> str:
    return text[:1].lower() + text[1:]
