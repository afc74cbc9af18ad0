"""The machine model: what machine.toml says, validated.

    [machine]     name, cycle_us
    [path]        feed, acceleration, deceleration, quick_deceleration, angle_tolerance, corner_angle,
                  centripetal_acceleration, centripetal_jump, time_law, max_switches
    [axes.X]      kind, min, max, velocity, acceleration, jerk, velocity_step, rapid, following_error, lag, home
    [kinematics]  type, offset
    [runtime]     queue, low_water

Units are mm, mm/s, mm/s² and s; degrees in place of mm for a rotary axis.  Every key is described where it
is declared below; an unknown key, a wrong type and a value out of bounds are a `MachineError` that names the
file, the dotted key and what was expected.
"""

from __future__ import annotations

import functools
import tomllib
from collections.abc import Mapping
from importlib import resources
from pathlib import Path
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError, field_validator, model_validator

from nccompile.errors import MachineError
from nccompile.machine.messages import explain, explain_syntax
from nccompile.toolpath.columns import AXIS_LETTERS
from nccompile.units import seconds_from_us

__all__ = [
    "Axis",
    "Identity",
    "Kinematics",
    "Machine",
    "PathDefaults",
    "Runtime",
    "default_machine",
    "load",
    "parse",
]

_VELOCITY_MAX = 1e6
_ACCELERATION_MAX = 1e9
_POSITION_MAX = 1e7


def _unit(unit: str) -> dict[str, Any]:
    """The unit of a key, read back by the error messages."""
    return {"unit": unit}


class _Section(BaseModel):
    """What all sections share: no unknown keys, no silent conversions, never changed, finite numbers."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=False)


class Identity(_Section):
    """Section [machine]."""

    name: str = Field(min_length=1, max_length=100, json_schema_extra=_unit("the name in reports"))
    cycle_us: int = Field(default=1000, ge=100, le=100_000, json_schema_extra=_unit("µs"))
    """Cycle of the interpolator and the drives [µs]."""


class PathDefaults(_Section):
    """Section [path]: what holds where the program says nothing, and how the path is run."""

    feed: float = Field(default=20.0, gt=0, le=_VELOCITY_MAX, json_schema_extra=_unit("mm/s"))
    """Path velocity of a program without F [mm/s]."""
    acceleration: float = Field(default=100.0, gt=0, le=_ACCELERATION_MAX, json_schema_extra=_unit("mm/s²"))
    """Path acceleration without E [mm/s²]; SoftMotion §6.6 predefines 100."""
    deceleration: float = Field(default=100.0, gt=0, le=_ACCELERATION_MAX, json_schema_extra=_unit("mm/s²"))
    """Path deceleration without negative E [mm/s²]; SoftMotion §6.6 predefines 100."""
    quick_deceleration: float = Field(
        default=1000.0, gt=0, le=_ACCELERATION_MAX, json_schema_extra=_unit("mm/s²")
    )
    """Deceleration of a quick stop [mm/s²]; the path's own counts if it is greater (SoftMotion §6.2.8)."""
    angle_tolerance: float = Field(default=20.0, ge=0, le=180, json_schema_extra=_unit("deg"))
    """Bend of the path up to which the path does not stop [deg] (SoftMotion §6.2.7)."""
    corner_angle: float = Field(default=180.0, ge=0, le=180, json_schema_extra=_unit("deg"))
    """Bend in all axes together above which the path stops [deg] (OPENcontrol's MDA); 180: no such limit."""
    centripetal_acceleration: float | None = Field(
        default=None, gt=0, le=_ACCELERATION_MAX, json_schema_extra=_unit("mm/s²")
    )
    """Greatest centripetal acceleration v² / r [mm/s²] (SoftMotion §6.2.7, dMaxAcc); no limit without the key."""
    centripetal_jump: float | None = Field(
        default=None, gt=0, le=_ACCELERATION_MAX, json_schema_extra=_unit("mm/s²")
    )
    """Greatest jump of it where the curvature jumps [mm/s²] (§6.2.7, dMaxAccJump); no limit without the key."""
    time_law: Literal["trapezoid", "sigmoid", "parabolic"] = "trapezoid"
    """Velocity profile (SoftMotion §6.2.8)."""
    max_switches: int = Field(default=8, ge=1, le=1000, json_schema_extra=_unit("switch points"))
    """Switch points (H) that one segment can carry."""


class Axis(_Section):
    """Section [axes.<letter>]; degrees take the place of mm if the axis is rotary."""

    kind: Literal["linear", "rotary"] = "linear"
    """Linear [mm] or rotary [deg]; without the key A, B and C are rotary and the others linear."""
    min: float | None = Field(
        default=None, ge=-_POSITION_MAX, le=_POSITION_MAX, json_schema_extra=_unit("mm or deg")
    )
    """Least axis position [mm or deg]; no limit without the key."""
    max: float | None = Field(
        default=None, ge=-_POSITION_MAX, le=_POSITION_MAX, json_schema_extra=_unit("mm or deg")
    )
    """Greatest axis position [mm or deg]; no limit without the key."""
    velocity: float = Field(gt=0, le=_VELOCITY_MAX, json_schema_extra=_unit("mm/s or deg/s"))
    """Greatest velocity [mm/s or deg/s]."""
    acceleration: float = Field(gt=0, le=_ACCELERATION_MAX, json_schema_extra=_unit("mm/s² or deg/s²"))
    """Greatest acceleration and deceleration [mm/s² or deg/s²]."""
    jerk: float | None = Field(default=None, gt=0, le=1e12, json_schema_extra=_unit("mm/s³ or deg/s³"))
    """Greatest jerk with the planner `jerk` [mm/s³ or deg/s³]; 40 / s times `acceleration` without the key."""
    velocity_step: float = Field(ge=0, le=_VELOCITY_MAX, json_schema_extra=_unit("mm/s or deg/s"))
    """Greatest jump of the velocity that drive and mechanics take at a junction [mm/s or deg/s]."""
    rapid: float | None = Field(
        default=None, gt=0, le=_VELOCITY_MAX, json_schema_extra=_unit("mm/s or deg/s")
    )
    """Velocity of G0 [mm/s or deg/s]; without the key G0 runs at the program's F as in SoftMotion."""
    following_error: float = Field(default=1.0, gt=0, le=_POSITION_MAX, json_schema_extra=_unit("mm or deg"))
    """Greatest set minus actual position; beyond it the drive faults [mm or deg]."""
    lag: float = Field(default=0.0, ge=0, le=10, json_schema_extra=_unit("s"))
    """Time constant of the virtual drive, which follows as a first-order lag [s]."""
    home: float | None = Field(
        default=None, ge=-_POSITION_MAX, le=_POSITION_MAX, json_schema_extra=_unit("mm or deg")
    )
    """Axis position at power-on [mm or deg]; without the key the axis stands where the program starts."""

    @model_validator(mode="after")
    def _hold_together(self) -> Axis:
        if self.min is not None and self.max is not None and self.min >= self.max:
            raise ValueError(f"min must be less than max, not {self.min:g} and {self.max:g}")
        if self.rapid is not None and self.rapid > self.velocity:
            raise ValueError(f"rapid must not exceed velocity, not {self.rapid:g} and {self.velocity:g}")
        if self.lag * self.velocity >= self.following_error:
            raise ValueError(
                f"lag must be less than following_error / velocity = "
                f"{self.following_error / self.velocity:g} s, not {self.lag:g}: "
                f"at full velocity the drive would fault"
            )
        if self.home is not None and not self.low <= self.home <= self.high:
            raise ValueError(f"home must lie in the travel {self.low:g} to {self.high:g}, not {self.home:g}")
        return self

    @property
    def low(self) -> float:
        """`min`, or -inf."""
        return float("-inf") if self.min is None else self.min

    @property
    def high(self) -> float:
        """`max`, or +inf."""
        return float("inf") if self.max is None else self.max

    @property
    def unit(self) -> str:
        """The unit of its position: "mm" or "deg"."""
        return "deg" if self.kind == "rotary" else "mm"


class Kinematics(_Section):
    """Section [kinematics]: how the axes carry the tool."""

    type: Literal["gantry"] = "gantry"
    """Gantry: every axis is the path coordinate plus its offset (SoftMotion §8.2.1)."""
    offset: dict[str, float] = Field(default_factory=dict, json_schema_extra=_unit("mm or deg"))
    """Axis position minus path coordinate by axis letter [mm or deg]; 0 for letters left out."""


class Runtime(_Section):
    """Section [runtime]: sizes of the cyclic task."""

    queue: int = Field(default=4096, ge=2, le=10_000_000, json_schema_extra=_unit("segments"))
    """Segments that the ring buffer before the interpolator holds."""
    low_water: int | None = Field(default=None, ge=1, le=10_000_000, json_schema_extra=_unit("segments"))
    """The slow task refills when fewer segments than this are left; half the queue without the key."""

    @model_validator(mode="after")
    def _hold_together(self) -> Runtime:
        if self.low_water is not None and self.low_water > self.queue:
            raise ValueError(f"low_water must not exceed queue, not {self.low_water} and {self.queue}")
        return self


class Machine(_Section):
    """A validated machine file."""

    identity: Identity = Field(alias="machine")
    path: PathDefaults = Field(default_factory=PathDefaults)
    axes: dict[str, Axis] = Field(min_length=1)
    kinematics: Kinematics = Field(default_factory=Kinematics)
    runtime: Runtime = Field(default_factory=Runtime)

    @field_validator("axes", mode="before")
    @classmethod
    def _kinds_by_letter(cls, axes: Any) -> Any:
        if not isinstance(axes, Mapping):
            return axes
        return {
            letter: {"kind": "rotary", **axis}
            if letter in ("A", "B", "C") and isinstance(axis, Mapping)
            else axis
            for letter, axis in axes.items()
        }

    @model_validator(mode="after")
    def _known_letters(self) -> Machine:
        for letter in self.axes:
            if letter not in tuple(AXIS_LETTERS):
                raise ValueError(f"axes.{letter}: axes are named by one letter of {' '.join(AXIS_LETTERS)}")
        for letter in self.kinematics.offset:
            if letter not in self.axes:
                known = " ".join(self.axes)
                raise ValueError(f"kinematics.offset.{letter}: no such axis; the machine has {known}")
        return self

    @property
    def name(self) -> str:
        """The name in reports."""
        return self.identity.name

    @property
    def cycle_us(self) -> int:
        """Cycle of interpolator and drives [µs]."""
        return self.identity.cycle_us

    @property
    def cycle(self) -> float:
        """Cycle of interpolator and drives [s]."""
        return seconds_from_us(self.identity.cycle_us)

    @property
    def queue(self) -> int:
        """Segments that the ring buffer holds."""
        return self.runtime.queue

    @property
    def low_water(self) -> int:
        """Fill of the ring buffer below which the slow task refills it [segments]."""
        low = self.runtime.low_water
        return max(1, self.queue // 2) if low is None else low


def parse(text: str, name: str) -> Machine:
    """The machine that a TOML text describes; `name` is the file name in messages.

    Raises: MachineError with one line for each thing that is wrong.
    """
    try:
        tables = tomllib.loads(text)
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise MachineError(explain_syntax(name, error)) from None
    try:
        return Machine.model_validate(tables)
    except ValidationError as error:
        raise MachineError(explain(name, Machine, error)) from None


def load(path: Path | str) -> Machine:
    """The machine of a machine.toml file.

    Raises: MachineError if the file cannot be read, is not TOML or does not hold together.
    """
    try:
        text = Path(path).read_bytes().decode("utf-8-sig")
    except UnicodeDecodeError:
        raise MachineError(f"{path}: not a machine file: it is not UTF-8 text") from None
    except OSError as error:
        raise MachineError(f"{path}: cannot be read: {error.strerror or error}") from None
    return parse(text.replace("\r\n", "\n"), str(path))


@functools.cache
def default_machine() -> Machine:
    """The built-in machine "generic": all axis letters, no travel limits (machine/generic.toml)."""
    text = resources.files("nccompile.machine").joinpath("generic.toml").read_text("utf-8")
    return parse(text, "generic.toml")
