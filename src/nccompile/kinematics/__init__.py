"""Path point to axis positions and back; one file a machine kind.

`build` picks the transformation that the machine file names.
"""

from __future__ import annotations

from collections.abc import Sequence

from nccompile.kinematics.gantry import Gantry
from nccompile.kinematics.protocol import Kinematics
from nccompile.machine.model import Machine

__all__ = ["Kinematics", "build"]

_KINDS = {"gantry": Gantry}


def build(machine: Machine, path_axes: Sequence[str]) -> Kinematics:
    """The transformation of a machine for paths in `path_axes`."""
    return _KINDS[machine.kinematics.type](machine, path_axes)
