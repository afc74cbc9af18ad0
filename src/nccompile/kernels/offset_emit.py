"""The rows of a corrected path, in order: copies, approaches, leads, offset pieces with their connectors, departures.

    G0 ·········┐  shifted to the start of the offset (or put in), then the lead-in, the pieces, the lead-out,
                v  and a positioning back to the contour unless one follows
    contour ────┴──────────

A new row takes its columns from the source row `origin`, and the axes beside X and Y at the part `part` of it.
"""

from math import pi

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel
from nccompile.kernels.boxes import Kinds, Rows
from nccompile.kernels.curve_points import ARC, Floats
from nccompile.kernels.intersect import heading
from nccompile.kernels.offset import put_arc, put_line

__all__ = ["CHECKED", "LINKED", "MOVED", "emit_rows"]

Bytes = npt.NDArray[np.uint8]

MOVED = 1
"""Flag of a new row whose X and Y are not those of its origin."""
LINKED = 2
"""Flag of a new row that stands for a part of its origin."""
CHECKED = 4
"""Flag of a new row along which the tool must keep its distance."""

_POSITIONING = 0
_LINE = 1
_SET_POSITION = 5
_COINCIDENT = 1e-9  # [mm], as geometry.tolerance.COINCIDENT


@kernel
def _lead(
    at: int, piece: int, is_in: bool, style: int, length: float, side: float,
    kind: Kinds, curve: Rows, table: Floats, ends: Floats,
) -> None:  # fmt: skip
    """Row `at` of the table becomes the lead into the start, or out of the end, of a piece: line (1), arc (2)."""
    tx, ty = heading(int(kind[piece]), table[max(int(curve[piece]), 0)], ends[piece], 0.0 if is_in else 1.0)
    x = float(ends[piece, 0] if is_in else ends[piece, 2])
    y = float(ends[piece, 1] if is_in else ends[piece, 3])
    way = -length if is_in else length
    is_arc = style == 2 and (tx != 0.0 or ty != 0.0)
    cx = x - side * length * ty
    cy = y + side * length * tx
    ax = (cx if is_arc else x) + way * tx
    ay = (cy if is_arc else y) + way * ty
    x0, y0, x1, y1 = (ax, ay, x, y) if is_in else (x, y, ax, ay)
    put_line(at, x0, y0, x1, y1, kind, curve, ends)
    if is_arc:
        put_arc(at, cx, cy, x0, y0, x1, y1, side * 0.5 * pi, kind, curve, table, ends)
        table[at, 2] = length


@kernel
def _put_row(
    at: int, kind: int, origin: int, part: float, piece: int, x: float, y: float, flags: int, contour: int,
    out_kind: Bytes, out_origin: Rows, out_part: Floats, out_piece: Rows, out_xy: Floats, out_flags: Bytes,
    out_link: Floats, out_contour: Rows,
) -> int:  # fmt: skip
    """Writes row `at`, which stands for the whole of its origin if it is linked; returns the next one."""
    out_kind[at] = kind
    out_origin[at] = origin
    out_part[at] = part
    out_piece[at] = piece
    out_xy[at, 0] = x
    out_xy[at, 1] = y
    out_flags[at] = flags
    out_link[at, 0] = 0.0
    out_link[at, 1] = 1.0
    out_contour[at] = contour
    return at + 1


@kernel
def _contour_ends(
    k: int, end: int, moving: Rows, dropped: Bytes, begin: Rows, stop: Rows, connector: Rows, connectors: Rows
) -> tuple[int, int, int, int, int]:
    """The contour whose moving rows begin with k and lie before source row `end`.

    Returns:  the moving row behind it;  its first piece, -1 if there is none, and the moving row that piece is of;
              its last piece and the moving row that is of.
    """
    first_piece = -1
    last_piece = -1
    lead_at = -1
    trail_at = -1
    while k < len(moving) and moving[k] < end:
        has_pieces = begin[k] < stop[k]
        if dropped[k] == 0 and (has_pieces or connectors[k] != 0):
            if first_piece < 0:
                first_piece = int(begin[k] if has_pieces else connector[k])
                lead_at = k
            last_piece = int(stop[k]) - 1
            trail_at = k
            if connectors[k] != 0:
                last_piece = int(connector[k]) + abs(int(connectors[k])) - 1
        k += 1
    return k, first_piece, lead_at, last_piece, trail_at


@kernel
def emit_rows(
    count: int, kind: Bytes, x: Floats, y: Floats, contour: Rows, moving: Rows, d: Floats, dropped: Bytes,
    begin: Rows, stop: Rows, connector: Rows, connectors: Rows, pieces: int, style: int, length: float,
    piece_kind: Kinds, piece_curve: Rows, piece_table: Floats, piece_ends: Floats, piece_part: Floats,
    out_kind: Bytes, out_origin: Rows, out_part: Floats, out_piece: Rows, out_xy: Floats, out_flags: Bytes,
    out_link: Floats, out_contour: Rows,
) -> int:  # fmt: skip
    """Writes the new rows of the first `count` source rows.

    Args:     kind: Shape (n,), of all source rows;  x, y: Shape (n + 1,), the start and their ends;  contour: Shape
              (n,), from 0, -1 outside;  moving: Shape (m,), source rows with extent in contours;  d, begin, stop,
              connector, connectors: Shape (m,), as in `join_offsets`;  dropped: Shape (m,), those that are left out;
              pieces: rows in the table so far;  style: leads: 0 none, 1 lines, 2 arcs, of `length` [mm];
              out_link: Shape (., 2), the parameters u of the origin it stands for;  out_piece: row of the table or -1.
    Returns:  the number of new rows.
    """
    at = 0
    k = 0
    i = 0
    hx = float(x[0])
    hy = float(y[0])
    while i < count:
        g = int(contour[i])
        end = i + 1
        last_k = k
        first_piece = last_piece = lead_at = trail_at = -1
        if g >= 0:
            while end < count and contour[end] == g:
                end += 1
            last_k, first_piece, lead_at, last_piece, trail_at = _contour_ends(
                k, end, moving, dropped, begin, stop, connector, connectors
            )
        if first_piece < 0:
            for r in range(i, end):
                at = _put_row(
                    at, int(kind[r]), r, 1.0, -1, hx, hy, LINKED, -1, out_kind, out_origin, out_part, out_piece,
                    out_xy, out_flags, out_link, out_contour,
                )  # fmt: skip
            hx = float(x[end])
            hy = float(y[end])
            k = last_k
            i = end
            continue
        side = 1.0 if d[lead_at] > 0.0 else -1.0
        tx, ty = float(piece_ends[first_piece, 0]), float(piece_ends[first_piece, 1])
        if style > 0:
            _lead(
                pieces, first_piece, True, style, length, side, piece_kind, piece_curve, piece_table, piece_ends
            )  # fmt: skip
            _lead(
                pieces + 1, last_piece, False, style, length, side, piece_kind, piece_curve, piece_table, piece_ends
            )  # fmt: skip
            tx, ty = float(piece_ends[pieces, 0]), float(piece_ends[pieces, 1])
        if at > 0 and out_kind[at - 1] == _POSITIONING:
            out_xy[at - 1, 0] = tx
            out_xy[at - 1, 1] = ty
            out_flags[at - 1] |= MOVED
        elif max(abs(hx - tx), abs(hy - ty)) > 0.0:
            at = _put_row(
                at, _POSITIONING, i, 0.0, -1, tx, ty, MOVED, -1, out_kind, out_origin, out_part, out_piece, out_xy,
                out_flags, out_link, out_contour,
            )  # fmt: skip
        hx = tx
        hy = ty
        for r in range(i, end):
            if k == last_k or moving[k] != r:
                at = _put_row(
                    at, int(kind[r]), r, 1.0, -1, hx, hy, MOVED | LINKED, g, out_kind, out_origin, out_part,
                    out_piece, out_xy, out_flags, out_link, out_contour,
                )  # fmt: skip
                continue
            for stage in range(4):  # lead-in, pieces, connectors, lead-out
                low = 0
                high = 0
                if dropped[k] == 1:
                    break
                if stage == 0 and style > 0 and k == lead_at:
                    low = pieces
                    high = pieces + 1
                elif stage == 1:
                    low = int(begin[k])
                    high = int(stop[k])
                elif stage == 2 and connectors[k] != 0:
                    low = int(connector[k])
                    high = low + abs(int(connectors[k]))
                elif stage == 3 and style > 0 and k == trail_at:
                    low = pieces + 1
                    high = pieces + 2
                if stage == 1 and low >= high:
                    at = _put_row(
                        at, _LINE, r, 1.0, -1, hx, hy, MOVED | LINKED, g, out_kind, out_origin, out_part, out_piece,
                        out_xy, out_flags, out_link, out_contour,
                    )  # fmt: skip
                for q in range(low, high):
                    is_last = q == high - 1
                    if (
                        stage == 1 and not is_last and piece_kind[q] < ARC
                        and max(abs(piece_ends[q, 2] - hx), abs(piece_ends[q, 3] - hy)) <= _COINCIDENT
                    ):  # fmt: skip
                        continue
                    hx = float(piece_ends[q, 2])
                    hy = float(piece_ends[q, 3])
                    part = 0.0 if stage == 0 else 1.0
                    flags = MOVED | CHECKED
                    if stage == 1:
                        flags |= LINKED
                        part = 1.0 if is_last else float(piece_part[q, 1])
                    elif stage == 2 and connectors[k] < 0:
                        flags = MOVED
                    at = _put_row(
                        at, int(piece_kind[q]), r, part, q, hx, hy, flags, g, out_kind, out_origin, out_part,
                        out_piece, out_xy, out_flags, out_link, out_contour,
                    )  # fmt: skip
                    if stage == 1:
                        out_link[at - 1, 0] = 0.0 if q == low else float(piece_part[q, 0])
                        out_link[at - 1, 1] = part
            k += 1
        if style > 0:
            pieces += 2
        after = int(kind[end]) if end < len(kind) else _SET_POSITION
        if after != _POSITIONING and after != _SET_POSITION:
            hx = float(x[end])
            hy = float(y[end])
            at = _put_row(
                at, _POSITIONING, end - 1, 1.0, -1, hx, hy, 0, -1, out_kind, out_origin, out_part, out_piece, out_xy,
                out_flags, out_link, out_contour,
            )  # fmt: skip
        i = end
    return at
