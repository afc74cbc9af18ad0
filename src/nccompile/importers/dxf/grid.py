"""Points that lie close together, found by hashing them into a grid of cells: near-linear, no tree."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from nccompile.importers.dxf.pieces import Complexes

__all__ = ["close_pairs", "cluster", "components"]

Indices = npt.NDArray[np.int64]

_HALF_PLANE = ((0, 0), (1, 0), (0, 1), (1, 1), (1, -1))
"""A cell and one half of its neighbours: every pair of cells is looked at once."""


def close_pairs(points: Complexes, distance: float) -> tuple[Indices, Indices]:
    """Index pairs (i, j), each once, i != j, of points not farther apart than `distance` [mm]."""
    cells = np.floor(np.column_stack([points.real, points.imag]) / distance).astype(np.int64)
    key = _hash(cells)
    order = np.argsort(key, kind="stable")
    ranked = key[order]
    firsts, seconds = [np.zeros(0, np.int64)], [np.zeros(0, np.int64)]
    for step in _HALF_PLANE:
        other = _hash(cells[order] + np.array(step))
        low, high = np.searchsorted(ranked, other, "left"), np.searchsorted(ranked, other, "right")
        if step == (0, 0):
            low = np.arange(1, len(points) + 1)
        counts = np.maximum(high - low, 0)
        first = np.repeat(np.arange(len(points)), counts)
        base = np.repeat(low - np.concatenate([[0], np.cumsum(counts)[:-1]]), counts)
        second = base + np.arange(len(first))
        i, j = order[first], order[second]
        near = (np.abs(points[i] - points[j]) <= distance) & (i != j)
        firsts.append(i[near])
        seconds.append(j[near])
    return np.concatenate(firsts), np.concatenate(seconds)


def _hash(cells: Indices) -> Indices:
    """One number a cell; cells that share one by chance cost a comparison, no more."""
    with np.errstate(over="ignore"):
        mixed: Indices = cells[:, 0] * np.int64(0x9E3779B97F4A7C1) + cells[:, 1] * np.int64(0xC2B2AE3D27D4EB4)
    return mixed


def components(count: int, i: Indices, j: Indices) -> Indices:
    """Shape (count,): the least index of everything that the pairs (i, j) connect an index with."""
    label = np.arange(count)
    while True:
        before = label.copy()
        least = np.minimum(label[i], label[j])
        np.minimum.at(label, i, least)
        np.minimum.at(label, j, least)
        np.minimum.at(label, before, label)
        label = label[label]
        if np.array_equal(label, before):
            return label


def cluster(points: Complexes, distance: float) -> Indices:
    """Shape (n,): numbers 0..k-1 of the groups of points that hang together over steps up to `distance` [mm]."""
    unique, inverse = np.unique(points, return_inverse=True)
    label = components(len(unique), *close_pairs(unique, distance))
    _, dense = np.unique(label, return_inverse=True)
    numbers: Indices = dense[inverse.ravel()]
    return numbers
