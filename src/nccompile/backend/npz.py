"""Zip members whose bytes depend on their content only: the ground of OutQueue files and sample tables."""

from __future__ import annotations

import struct
import zipfile
from typing import Any

import numpy as np
import numpy.typing as npt

__all__ = ["npy_header", "npz_entry", "write_npz"]

_OLDEST = (1980, 1, 1, 0, 0, 0)


def npz_entry(name: str) -> zipfile.ZipInfo:
    """A zip entry with a fixed time, host system and file mode."""
    entry = zipfile.ZipInfo(name, _OLDEST)
    entry.create_system = 3
    entry.external_attr = 0o100644 << 16
    return entry


def npy_header(dtype: str, shape: tuple[int, ...]) -> bytes:
    """The header of NumPy's file format 1.0, written here so that the bytes hang on no NumPy version."""
    text = f"{{'descr': '{dtype}', 'fortran_order': False, 'shape': {shape}, }}"
    fill = -(10 + len(text) + 1) % 64
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(text) + fill + 1) + f"{text}{' ' * fill}\n".encode()


def write_npz(file: Any, arrays: dict[str, npt.NDArray[Any]]) -> None:
    """Writes arrays as an `.npz` that `numpy.load` opens; little-endian, not compressed."""
    with zipfile.ZipFile(file, "w", zipfile.ZIP_STORED) as archive:
        for name, array in arrays.items():
            little = np.ascontiguousarray(array, array.dtype.newbyteorder("<"))
            archive.writestr(
                npz_entry(f"{name}.npy"), npy_header(little.dtype.str, little.shape) + little.tobytes()
            )
