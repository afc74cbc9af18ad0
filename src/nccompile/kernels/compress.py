"""Runs of lines that are one line: the kernel of the pass `compress`."""

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel

__all__ = ["merge_runs"]


@kernel
def merge_runs(
    points: npt.NDArray[np.float64], joins: npt.NDArray[np.bool_], epsilon: float, most: int,
    keep: npt.NDArray[np.bool_],
) -> int:  # fmt: skip
    """Marks the segments whose end stays a corner of the path; returns where the last, open run begins.

    Args:     points: Shape (n + 1, k), start position and ends;  joins: Shape (n,), segment i may be one with
              segment i - 1;  epsilon: greatest distance of a dropped point from the line on any axis;
              most: segments in a run;  keep: Shape (n,), out.

    A run grows while all its inner points are within epsilon of the point at the same share of the way on the
    line from its start to its end, and the shares ascend.  Shares go by the axis that moves farthest.
    """
    n = len(joins)
    k = points.shape[1]
    first = 0
    for i in range(n):
        keep[i] = True
    for i in range(1, n):
        together = bool(joins[i]) and i - first < most
        if together:
            axis = 0
            far = -1.0
            for c in range(k):
                d = abs(float(points[i + 1, c]) - float(points[first, c]))
                if d > far:
                    far = d
                    axis = c
            whole = float(points[i + 1, axis]) - float(points[first, axis])
            together = whole != 0.0
            before = 0.0
            j = first + 1
            while together and j <= i:
                share = (float(points[j, axis]) - float(points[first, axis])) / whole
                together = before < share < 1.0
                before = share
                for c in range(k):
                    straight = float(points[first, c]) + share * (
                        float(points[i + 1, c]) - float(points[first, c])
                    )
                    if abs(float(points[j, c]) - straight) > epsilon:
                        together = False
                j += 1
        if together:
            keep[i - 1] = False
        else:
            first = i
    return first
