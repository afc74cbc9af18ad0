"""Part program to toolpath: modal state, variables, jumps.

`din66025` is the dialect's decoder over the shared `core`; `tables` describes each word and instruction.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from nccompile.decoder.din66025 import Din66025
from nccompile.decoder.options import DecodeOptions
from nccompile.diagnostics import Diagnostics
from nccompile.kernels import LARGE, expect_work
from nccompile.parser import read_header
from nccompile.source import LargeSource, Source
from nccompile.toolpath.columns import Toolpath

__all__ = ["DecodeOptions", "Decoded", "decode"]


class Decoded:
    """A program while it is decoded: iterating gives its toolpath chunks, once, as they are made.

    axes: letters of the axes in use, X Y Z first;  header: the program's name, empty if it has none.
    Findings are added to the diagnostics during iteration; with errors among them the chunks are not to be
    used.  There is at least one chunk; that of a program without motion is empty.
    """

    def __init__(self, decoder: Din66025, header: str) -> None:
        self.axes = decoder.axes
        self.header = header
        self._chunks = decoder.chunks()

    def __iter__(self) -> Iterator[Toolpath]:
        return self._chunks


def decode(
    source: Source,
    options: DecodeOptions,
    diagnostics: Diagnostics,
    wanted: Callable[[], bool] | None = None,
) -> Decoded:
    """Starts decoding a DIN 66025 program; memory is that of a chunk, or of the blocks if there are jumps.

    wanted: asked now and then in a program with jumps, which may run long without a chunk; if it says no,
    iterating raises `Cancelled`.
    """
    if isinstance(source, LargeSource):
        expect_work(LARGE)
    header = read_header(source)
    return Decoded(
        Din66025(source, options, diagnostics, wanted=wanted), "" if header is None else header.name
    )
