"""Programs of any size for the benchmarks, the same every time."""

from __future__ import annotations

import random
from math import cos, sin

__all__ = ["program"]


def program(blocks: int) -> str:
    """A contour of short lines with an arc every 10 blocks and a rapid every 200; CAM-like, 0.2 to 1 mm a block."""
    generator = random.Random(66025)
    lines = ["% bench", "N1 G0 Z5", "N2 G1 Z0 F50 E1000 E-1000"]
    x = y = direction = 0.0
    for number in range(3, blocks + 1):
        direction += generator.uniform(-0.15, 0.15)
        step = generator.uniform(0.2, 1.0)
        if abs(x) > 100 or abs(y) > 100:
            direction += 0.3
        x, y = x + step * cos(direction), y + step * sin(direction)
        if number % 200 == 0:
            lines.append(f"N{number} G0 X{x:.3f} Y{y:.3f}")
        elif number % 10 == 0:
            lines.append(f"N{number} G3 X{x:.3f} Y{y:.3f} R{step * 2:.3f}")
        else:
            lines.append(f"N{number} G1 X{x:.3f} Y{y:.3f}")
    return "\n".join(lines) + "\n"
