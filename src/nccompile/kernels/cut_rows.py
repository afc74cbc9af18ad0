"""Cutting rows into parts by shares of their length."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel
from nccompile.kernels.curve_parts import curve_piece
from nccompile.kernels.curves import parameter, point3, tabulate
from nccompile.kernels.planes import SPACE, plane_axes

__all__ = ["cut_rows"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int32]
Kinds = npt.NDArray[np.uint8]


@kernel
def cut_rows(
    kind: Kinds, start: Floats, target: Floats, curve: Ints, plane: Kinds, parameters: Floats, length: Floats,
    nodes_u: Floats, nodes_s: Floats, row: Ints, p0: Floats, p1: Floats, out_target: Floats,
    out_parameters: Floats, out_length: Floats,
) -> None:  # fmt: skip
    """Parts p0..p1 (shares of the path length) of rows: their ends, curves and lengths.

    row, p0, p1: Shape (m,); out_target (m, k); out_parameters (m, 12), of curved rows only; out_length (m,).
    A part that ends with its row ends at the row's target to the bit.
    """
    axes = target.shape[1]
    last = -1
    nodes = 0
    u_end = 0.0
    for i in range(len(row)):
        j = int(row[i])
        c = int(curve[j])
        out_length[i] = length[j] if p0[i] == 0.0 and p1[i] == 1.0 else length[j] * (p1[i] - p0[i])
        whole = p1[i] >= 1.0
        for a in range(axes):
            out_target[i, a] = target[j, a] if whole else start[j, a] + (target[j, a] - start[j, a]) * p1[i]
        if c < 0:
            continue
        p = parameters[c]
        if p0[i] == 0.0 and whole:
            out_parameters[i, :] = p
            continue
        if last != j:
            nodes = tabulate(int(kind[j]), p, nodes_u, nodes_s)
            u_end = 0.0
            last = j
        u0 = u_end
        u1 = 1.0 if whole else parameter(int(kind[j]), p, nodes_u, nodes_s, nodes, p1[i] * nodes_s[nodes - 1])
        u_end = u1
        curve_piece(int(kind[j]), p, u0, u1, out_parameters[i])
        if not whole:
            x, y, z = point3(int(kind[j]), p, u1)
            first, second = plane_axes(int(plane[c]))
            out_target[i, first] = x
            out_target[i, second] = y
            if plane[c] == SPACE:
                out_target[i, 2] = z
