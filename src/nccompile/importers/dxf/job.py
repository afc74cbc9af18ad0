"""Job files: how the layers and colours of a drawing are machined.

    [program]                      what holds for the whole program
    [[operation]]                  machined in the order of the file
    layers = ["CUT*"]              which paths it takes: patterns of layer names, colours, or all without either
    side = "outside"               on, left, right, inside, outside; by "geometry" or by "g41"

Lengths in mm, feeds in mm/s, as in the programs that are written.  Unknown keys are errors with a suggestion.
"""

from __future__ import annotations

import tomllib
from enum import StrEnum
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from nccompile.errors import UsageError
from nccompile.machine.messages import explain, explain_syntax

__all__ = ["Job", "Lead", "Operation", "Program", "Side", "Tabs", "load_job"]

Length = Annotated[float, Field(ge=0.0, le=1e5, allow_inf_nan=False)]
Positive = Annotated[float, Field(gt=0.0, le=1e6, allow_inf_nan=False)]
Place = Annotated[float, Field(ge=-1e6, le=1e6, allow_inf_nan=False)]
Number = Annotated[int, Field(ge=0, le=9999)]
Switch = Annotated[int, Field(ge=1, le=32767)]

COLORS = {"red": 1, "yellow": 2, "green": 3, "cyan": 4, "blue": 5, "magenta": 6, "white": 7}


class _Section(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class Side(StrEnum):
    """Where the tool runs: on the line, beside it in its direction, or inside or outside a closed contour."""

    ON = "on"
    LEFT = "left"
    RIGHT = "right"
    INSIDE = "inside"
    OUTSIDE = "outside"


class Lead(_Section):
    """How a contour is entered or left: on a straight line at `angle` [deg] to it, or on a quarter arc."""

    kind: Literal["line", "arc"] = "arc"
    length: Positive = 2.0
    """Length of the line or radius of the arc [mm]."""
    angle: Annotated[float, Field(gt=0.0, le=90.0)] = 45.0


class Tabs(_Section):
    """Bridges that hold the part: how many, how long and how high [mm]."""

    count: Annotated[int, Field(ge=1, le=1000)] = 4
    length: Positive = 5.0
    height: Positive = 1.0


class Operation(_Section):
    """What is done to the paths it takes."""

    name: str = ""
    layers: tuple[str, ...] = ()
    colors: tuple[int | str, ...] = ()
    kind: Literal["contour", "drill", "ignore"] = "contour"
    tool: Number | None = None
    tool_radius: Length = 0.0
    side: Side = Side.ON
    by: Literal["geometry", "g41"] = "geometry"
    depth: Length = 0.0
    pass_depth: Positive | None = None
    feed: Positive = 20.0
    plunge_feed: Positive | None = None
    accel: Positive | None = None
    decel: Positive | None = None
    safe_height: Length | None = None
    lead_in: Lead | None = None
    lead_out: Lead | None = None
    clearance: Length = 0.0
    overcut: Length = 0.0
    tabs: Tabs | None = None
    dwell: Length = 0.0
    switch: Switch | None = None
    m_on: Number | None = None
    m_off: Number | None = None
    start: Literal["nearest", "corner", "longest"] | tuple[Place, Place] = "nearest"
    direction: Literal["drawn", "climb", "conventional"] = "drawn"

    @model_validator(mode="after")
    def _together(self) -> Operation:
        if self.side is not Side.ON and self.tool_radius == 0.0:
            raise ValueError(f'side = "{self.side}" needs a tool_radius above 0')
        if self.by == "g41" and (self.lead_in or self.lead_out or self.overcut):
            raise ValueError(
                'lead_in, lead_out and overcut go with by = "geometry"; with G41 the pass makes the leads: '
                'compile with -p "tool-radius{lead=arc,length=3}"'
            )
        if self.tabs is not None and self.tabs.height > self.depth:
            raise ValueError(f"tabs.height {self.tabs.height:g} must not be above depth {self.depth:g}")
        unknown = [c for c in self.colors if isinstance(c, str) and c.lower() not in COLORS]
        if unknown:
            raise ValueError(
                f"colors: {unknown[0]!r} is none of {', '.join(COLORS)} or a number from 1 to 255"
            )
        return self

    @property
    def height(self) -> float:
        """Z of rapids [mm]: 5 above the work if it cuts below Z0, else Z0."""
        if self.safe_height is not None:
            return self.safe_height
        return 5.0 if self.depth > 0.0 else 0.0

    @property
    def levels(self) -> list[float]:
        """Z of every pass [mm], the last at -depth."""
        if self.depth == 0.0:
            return [0.0]
        count = 1 if self.pass_depth is None else max(1, -int(-self.depth // self.pass_depth))
        return [-self.depth * (k + 1) / count for k in range(count)]

    def takes(self, layer: str, color: int) -> bool:
        """Whether a path of this layer and colour belongs to the operation."""
        named = any(fnmatchcase(layer.lower(), pattern.lower()) for pattern in self.layers)
        wanted = {COLORS[c.lower()] if isinstance(c, str) else c for c in self.colors}
        if self.layers and self.colors:
            return named and color in wanted
        return named or color in wanted or not (self.layers or self.colors)


class Program(_Section):
    """What holds for the whole program: M functions around it and at tool changes, the place at its end."""

    begin_m: tuple[Number, ...] = ()
    end_m: tuple[Number, ...] = ()
    tool_change_m: Number = 6
    origin: tuple[Place, Place] = (0.0, 0.0)
    park: tuple[Place, Place] | None = None


class Job(_Section):
    """A whole job file."""

    program: Program = Program()
    operation: tuple[Operation, ...] = (Operation(),)


def load_job(path: Path) -> Job:
    """The job of a TOML file; raises UsageError with file, key and what was expected."""
    try:
        text = path.read_bytes().decode("utf-8-sig")
    except UnicodeDecodeError:
        raise UsageError(f"{path}: not a job file: it is not UTF-8 text") from None
    except OSError as error:
        raise UsageError(f"{path}: cannot be read: {error.strerror or error}") from None
    try:
        return Job.model_validate(tomllib.loads(text))
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise UsageError(explain_syntax(str(path), error)) from None
    except ValidationError as error:
        raise UsageError(explain(str(path), Job, error)) from None
