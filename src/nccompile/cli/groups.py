"""Groups of options: one dataclass field an option, one parameter of a command for all of them.

    @dataclass                                  def dump(path: Input, *, program: ProgramOptions) -> None
    class ProgramOptions:
        start: Start = None                     nccompile dump PATH --start X0 --skip-blocks
        skip_blocks: SkipBlocks = False

typer reads options from a function's signature; `expanded` gives it one with the fields in the group's place.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from dataclasses import fields, is_dataclass
from functools import wraps
from inspect import Parameter
from typing import Annotated, Any, get_origin, get_type_hints

__all__ = ["expanded"]


def expanded(command: Callable[..., None]) -> Callable[..., None]:
    """The command with every parameter that is a group of options replaced by the options."""
    hints = get_type_hints(command, include_extras=True)
    parameters: list[Parameter] = []
    groups: dict[str, tuple[type[Any], list[str]]] = {}
    for parameter in inspect.signature(command).parameters.values():
        kind = hints[parameter.name]
        if is_dataclass(kind) and isinstance(kind, type):
            options = list(_options(kind))
            groups[parameter.name] = kind, [option.name for option in options]
            parameters += options
        else:
            parameters.append(parameter.replace(kind=Parameter.KEYWORD_ONLY, annotation=kind))

    @wraps(command)
    def call(**given: Any) -> None:
        for name, (kind, names) in groups.items():
            given[name] = kind(**{option: given.pop(option) for option in names})
        command(**given)

    call.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]  # what typer looks at
    call.__annotations__ = {parameter.name: parameter.annotation for parameter in parameters}
    return call


def _options(group: type[Any]) -> Iterator[Parameter]:
    """The fields of a group that are options; a field with a plain type is none."""
    hints = get_type_hints(group, include_extras=True)
    for field in fields(group):
        kind = hints[field.name]
        if get_origin(kind) is Annotated:
            yield Parameter(field.name, Parameter.KEYWORD_ONLY, default=field.default, annotation=kind)
