"""Short ways to decode a program in a test."""

from __future__ import annotations

from typing import Any

from nccompile.decoder import DecodeOptions, decode
from nccompile.diagnostics import Diagnostic, Diagnostics
from nccompile.source import Source
from nccompile.toolpath import Kind, Toolpath
from nccompile.toolpath.verify import verify_chain


def read(program: str, **options: Any) -> tuple[Toolpath, list[Diagnostic]]:
    """The whole toolpath, verified, and all findings."""
    diagnostics = Diagnostics()
    chunks = list(verify_chain(decode(Source("a.nc", program), DecodeOptions(**options), diagnostics)))
    return Toolpath.join(chunks), list(diagnostics)


def path_of(*blocks: str, **options: Any) -> Toolpath:
    """The toolpath of blocks in which nothing is wrong, not even a warning."""
    path, found = read("\n".join(["% test", *blocks]), **options)
    assert found == []
    return path


def codes_of(*blocks: str, **options: Any) -> list[str]:
    """The codes of all findings in blocks after a header."""
    _, found = read("\n".join(["% test", *blocks]), **options)
    return [finding.code for finding in found]


def targets(path: Toolpath) -> list[list[float]]:
    """End positions, one list a segment."""
    rows: list[list[float]] = path.target.tolist()
    return rows


def kinds(path: Toolpath) -> list[Kind]:
    """Segment kinds."""
    return [Kind(int(kind)) for kind in path.kind]


def switches(path: Toolpath) -> list[tuple[int, int, float]]:
    """(segment, number, position) of all events."""
    e = path.events
    return list(zip(e.segment.tolist(), e.number.tolist(), e.position.tolist(), strict=True))
