"""Plain blocks to segments: the modal rules of the common words, as one loop over word columns.

The rules are those of `decoder.words` and `decoder.motion`.  What those would report, and every word and
instruction that is not listed here, ends the run in front of its block: the statement-wise decoder takes that
block, and the next run starts behind it.

    words         N (no meaning here)  G0 G1 G2 G3 G90 G91 G98 G99  axes  I J R  F E D
    ends the run  another word or instruction, a word twice (but E), a word without effect, a value out of range,
                  an arc that cannot be, no feed yet, an S-profile

State between runs is in two arrays, which the statement-wise decoder reads and writes too.
"""

from __future__ import annotations

from math import sqrt

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel
from nccompile.kernels.arcs import by_centre, by_radius

__all__ = [
    "ABSOLUTE", "ACCEL", "ALONG", "AROUND", "CENTRE_ABSOLUTE", "CURVES", "DECEL", "DRIVE", "FEED", "FLAGS", "FREE",
    "LAST_DRIVE", "LEAVE_X", "LEAVE_Y", "LEAVING", "NEEDS_FEED", "NUMBERS", "RADIUS", "ROWS", "SAME", "decode",
]  # fmt: skip

Flags = npt.NDArray[np.uint8]
Ints = npt.NDArray[np.int32]
Longs = npt.NDArray[np.int64]
Floats = npt.NDArray[np.float64]

FEED, ACCEL, DECEL, RADIUS, LEAVE_X, LEAVE_Y, NUMBERS = 0, 1, 2, 3, 4, 5, 6
"""Places in the state of numbers, and its size."""

DRIVE, ABSOLUTE, CENTRE_ABSOLUTE, NEEDS_FEED, LEAVING, LAST_DRIVE, ROWS, CURVES, FLAGS = (
    0,
    1,
    2,
    3,
    4,
    5,
    6,
    7,
    8,
)
"""Places in the state of whole numbers, and its size.  NEEDS_FEED: a feed move without feed must be reported."""

SAME, FREE, ALONG, AROUND = 0, 1, 2, 3
"""LEAVING, how the last segment ends: as before the run, in no direction, along LEAVE_X, LEAVE_Y, as the last curve."""

_N, _D, _E, _F, _G, _I, _J, _R = 78, 68, 69, 70, 71, 73, 74, 82
_I_BIT, _J_BIT, _R_BIT, _F_BIT, _D_BIT = 1 << 8, 1 << 9, 1 << 17, 1 << 5, 1 << 3
_SHAPE = _I_BIT | _J_BIT | _R_BIT


@kernel
def decode(
    first: int, blocks: int, block_line: Ints, block_word: Ints, plain: Flags, letter: Flags, value: Floats,
    column: Longs, axis_bits: int, limit: float, coincident: float, mismatch: float, ratio: float, most: float,
    numbers: Floats, flags: Longs, position: Floats, goal: Floats, arc: Floats,
    kind: Flags, targets: Floats, curve: Ints, length: Floats, feed: Floats, accel: Floats, decel: Floats,
    radius: Floats, line: Ints, planes: Flags, parameters: Floats,
) -> int:  # fmt: skip
    """Decodes blocks first..blocks-1 until one is not for it or the tables are full; returns that block.

    Args:     block_line ... value: as `kernels.scan` writes them;  column: Shape (128,), the axis of a letter or
              -1;  axis_bits: bit i set for the axis letter chr(65 + i);  limit: greatest value and coordinate;
              coincident ... most: `geometry.arcs.TOLERANCES`;  goal: Shape (k,) and arc: Shape (5,) for its own
              use;  numbers, flags, position: the state.
    Writes:   rows flags[ROWS].. of kind, targets, curve, length, feed, accel, decel, radius, line and rows
              flags[CURVES].. of planes, parameters; the columns mark and profile of such rows are 0.
    """
    axes = len(position)
    n = int(flags[ROWS])
    curves = int(flags[CURVES])
    room = len(kind)
    curve_room = len(planes)
    drive = int(flags[DRIVE])
    absolute = int(flags[ABSOLUTE])
    centre_absolute = int(flags[CENTRE_ABSOLUTE])
    leaving = int(flags[LEAVING])
    last_drive = int(flags[LAST_DRIVE])
    needs_feed = int(flags[NEEDS_FEED])
    now_feed = float(numbers[FEED])
    now_accel = float(numbers[ACCEL])
    now_decel = float(numbers[DECEL])
    now_radius = float(numbers[RADIUS])
    leave_x = float(numbers[LEAVE_X])
    leave_y = float(numbers[LEAVE_Y])
    b = first
    while b < blocks:
        if plain[b] == 0 or n >= room or curves >= curve_room:
            break
        seen = 0
        code = -1
        good = True
        f = now_feed
        a = now_accel
        d = now_decel
        r = now_radius
        ci = 0.0
        cj = 0.0
        arc_radius = 0.0
        for k in range(axes):
            goal[k] = position[k]
        begin = int(block_word[b])
        if begin < int(block_word[b + 1]) and int(letter[begin]) == _N:
            begin += 1
        for w in range(begin, int(block_word[b + 1])):
            name = int(letter[w])
            v = float(value[w])
            if not (-limit <= v <= limit):
                good = False
                break
            at = int(column[name])
            if name == _E:
                if v >= 1.0:
                    a = v
                elif v <= -1.0:
                    d = -v
                else:
                    good = False
                    break
                continue
            bit = 1 << (name - 65)
            if seen & bit != 0:
                good = False
                break
            seen |= bit
            if at >= 0:
                if absolute == 1:
                    goal[at] = v
                else:
                    goal[at] += v
                    if not (-limit <= goal[at] <= limit):
                        good = False
                        break
            elif name == _G:
                if w != begin:
                    good = False
                    break
                code = int(v)
                known = 0 <= code <= 3 or 90 <= code <= 91 or 98 <= code <= 99
                if v != code or not known:
                    good = False
                    break
            elif name == _F:
                f = v
                if v <= 0.0:
                    good = False
                    break
            elif name == _I:
                ci = v
            elif name == _J:
                cj = v
            elif name == _R:
                arc_radius = v
            elif name == _D:
                r = v
                if v < 0.0:
                    good = False
                    break
            else:
                good = False
                break
        moving = seen & (axis_bits | _SHAPE)
        if not good:
            break
        if code >= 90:
            if moving != 0:
                break
            if code <= 91:
                absolute = 1 if code == 90 else 0
            else:
                centre_absolute = 1 if code == 98 else 0
        elif code >= 0 or moving != 0:
            motion = drive if code < 0 else code
            if motion < 0 or motion > 3:
                break
            if motion <= 1 and seen & _SHAPE != 0:
                break
            if moving != 0:
                if needs_feed == 1 and motion != 0 and f == 0.0:
                    break
                dx = goal[0] - position[0]
                dy = goal[1] - position[1]
                dz = goal[2] - position[2]
                if motion <= 1:
                    run = sqrt(dx * dx + dy * dy + dz * dz)
                    if run == 0.0 and axes > 3:
                        total = 0.0
                        for k in range(3, axes):
                            total += (goal[k] - position[k]) * (goal[k] - position[k])
                        if total > 0.0:
                            run = sqrt(total)
                    if motion == 1 and (dx != 0.0 or dy != 0.0):
                        if run == 0.0:
                            break
                        leaving = 2
                        leave_x = dx
                        leave_y = dy
                    elif run > 0.0 or motion == 0:
                        leaving = 1
                    kind[n] = motion
                    curve[n] = -1
                else:
                    if seen & (_I_BIT | _J_BIT) != 0:
                        if seen & _R_BIT != 0:
                            break
                        if centre_absolute == 0:
                            ci = position[0] + ci
                            cj = position[1] + cj
                        else:
                            if seen & _I_BIT == 0:
                                ci = position[0]
                            if seen & _J_BIT == 0:
                                cj = position[1]
                        status = by_centre(
                            position[0], position[1], goal[0], goal[1], ci, cj, motion == 3, coincident, mismatch,
                            ratio, most, arc,
                        )  # fmt: skip
                    elif seen & _R_BIT != 0:
                        status = by_radius(
                            position[0], position[1], goal[0], goal[1], arc_radius, motion == 3, coincident, mismatch,
                            ratio, most, arc,
                        )  # fmt: skip
                    else:
                        break
                    if status != 0:
                        break
                    run = arc[2] * abs(arc[4])
                    if dz != 0.0:
                        run = sqrt(run * run + dz * dz)
                    for k in range(5):
                        parameters[curves, k] = arc[k]
                    for k in range(5, 12):
                        parameters[curves, k] = 0.0
                    planes[curves] = 0
                    curve[n] = curves
                    curves += 1
                    kind[n] = 2
                    leaving = 3
                for k in range(axes):
                    targets[n, k] = goal[k]
                    position[k] = goal[k]
                length[n] = run
                feed[n] = f
                accel[n] = a
                decel[n] = d
                radius[n] = r
                line[n] = block_line[b]
                last_drive = n
                n += 1
            drive = motion
        now_feed = f
        now_accel = a
        now_decel = d
        now_radius = r
        b += 1
    flags[ROWS] = n
    flags[CURVES] = curves
    flags[DRIVE] = drive
    flags[ABSOLUTE] = absolute
    flags[CENTRE_ABSOLUTE] = centre_absolute
    flags[LEAVING] = leaving
    flags[LAST_DRIVE] = last_drive
    numbers[FEED] = now_feed
    numbers[ACCEL] = now_accel
    numbers[DECEL] = now_decel
    numbers[RADIUS] = now_radius
    numbers[LEAVE_X] = leave_x
    numbers[LEAVE_Y] = leave_y
    return b
