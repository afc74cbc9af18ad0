"""One program by both routes: statement by statement from text, and as columns from bytes."""

from __future__ import annotations

import io
import random
from dataclasses import fields
from typing import Any

import numpy as np

from nccompile.decoder import DecodeOptions
from nccompile.decoder.din66025 import Din66025
from nccompile.diagnostics import Diagnostic, Diagnostics, render
from nccompile.source import LargeSource, Source
from nccompile.toolpath import Curves, Events, Toolpath

PART = 1 << 20


def large(data: bytes, part: int = PART) -> LargeSource:
    """The bytes as a file that is read by parts."""
    return LargeSource("a.nc", io.BytesIO(data), part)


def decoded(
    source: Source, columnar: bool, **options: Any
) -> tuple[Toolpath, list[Diagnostic], dict[str, int]]:
    """The whole path, the findings, and how often each code was found."""
    diagnostics = Diagnostics()
    decoder = Din66025(source, DecodeOptions(**options), diagnostics, columnar=columnar)
    path = Toolpath.join(list(decoder.chunks()))
    return path, list(diagnostics), dict(diagnostics.counts)


def differences(one: object, two: object, name: str = "path") -> list[str]:
    """Names of the parts that are not the same bit for bit."""
    if isinstance(one, (Toolpath, Curves, Events)):
        parts = [(part.name, getattr(one, part.name), getattr(two, part.name)) for part in fields(one)]
        return [found for part, a, b in parts for found in differences(a, b, f"{name}.{part}")]
    if isinstance(one, np.ndarray):
        assert isinstance(two, np.ndarray)
        same = one.dtype == two.dtype and one.shape == two.shape and one.tobytes() == two.tobytes()
        return [] if same else [name]
    return [] if one == two else [name]


def compare(data: bytes, part: int = PART, **options: Any) -> tuple[Toolpath, list[Diagnostic]]:
    """What both routes make of a program; fails where they differ."""
    text, file = Source.from_bytes("a.nc", data), large(data, part)
    path, found, counts = decoded(text, False, **options)
    columns, found_there, counts_there = decoded(file, True, **options)
    if any(d.code == "NC010" for d in found):  # refused unread: its axes are not known
        assert len(path) == len(columns) == 0
    else:
        assert differences(path, columns) == []
    assert found_there == found
    assert counts_there == counts
    assert [render(d, file) for d in found[:5]] == [render(d, text) for d in found[:5]]
    return columns, found


def damaged(data: bytes, generator: random.Random) -> bytes:
    """A copy with some bytes changed, lines cut, merged or doubled."""
    lines = data.splitlines(keepends=True)
    for _ in range(generator.randint(1, 4)):
        at = generator.randrange(len(lines))
        line = lines[at]
        place = generator.randrange(len(line) + 1)
        kind = generator.randrange(4)
        if kind == 0:
            lines[at] = (
                line[:place]
                + bytes([generator.choice(b"0189.-+GXYZEFIJRN ()$%/;\xe4\x00,") for _ in range(2)])
                + line[place + 2 :]
            )
        elif kind == 1:
            lines[at] = line[:place]
        elif kind == 2:
            lines[at] = line.rstrip(b"\r\n")
        else:
            lines[at] = line * 2
    return b"".join(lines)
