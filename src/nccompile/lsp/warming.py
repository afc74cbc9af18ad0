"""Machine code for large programs, made ahead in a process of its own.

Compiling the kernels takes half a minute when no earlier process left them in the cache, and whoever compiles answers
nothing.  The server therefore runs them as plain Python, which gives the same bits, until a child has run all of them
that an analysis needs:

    first large document ──> python -m nccompile.lsp.warming ──> ends well ──> from here compiled kernels
"""

from __future__ import annotations

import asyncio
import os
import sys
from pathlib import Path

from nccompile import kernels
from nccompile.lint.config import Config
from nccompile.lint.program import always
from nccompile.lsp.analysis import Settings, analyse, timed
from nccompile.lsp.document import Document
from nccompile.machine.model import default_machine
from nccompile.source import STREAMED

__all__ = ["Warming", "compile_all", "program"]

_VARIABLE = "NCCOMPILE_KERNELS"


class Warming:
    """Keeps the kernels plain until a child has compiled them; a choice of the user's stays."""

    def __init__(self) -> None:
        self._is_open = _VARIABLE not in os.environ and not _mark().exists()
        self._process: asyncio.subprocess.Process | None = None
        self._task: asyncio.Task[None] | None = None
        if self._is_open:
            os.environ[_VARIABLE] = "python"

    def start(self, lines: int) -> None:
        """A document of so many lines was opened: the first large one starts the child."""
        if self._is_open and self._task is None and lines >= kernels.LARGE:
            self._task = asyncio.get_running_loop().create_task(self._run())

    async def _run(self) -> None:
        nothing = asyncio.subprocess.DEVNULL
        self._process = await asyncio.create_subprocess_exec(
            sys.executable, "-m", "nccompile.lsp.warming",
            stdin=nothing, stdout=nothing, stderr=nothing, env=os.environ | {_VARIABLE: "numba"},
        )  # fmt: skip
        if await self._process.wait() == 0:
            os.environ.pop(_VARIABLE, None)

    def stop(self) -> None:
        """Ends the child if it still works."""
        if self._process is not None and self._process.returncode is None:
            self._process.kill()


_SHAPES = (
    "G1 X1 Y1", "G1 X1 Y-1 Z.1", "G3 X2 Y0 R9", "G2 X2 Y0 I1 J0", "G8 X2 Y0 I1 J0 K0 R.5", "G6 X2 Y0 I1 J1",
    "G5 X1 Y1", "G5 X1 Y-1", "G5 X1 Y1", "G1 X1 Y-1 Z-.1", "G0 X-14",
)  # fmt: skip
"""Relative moves that end where they began: lines, both forms of arcs, an ellipse, a parabola, a spline, a rapid."""


def program(blocks: int) -> str:
    """A program with a bit of everything that kernels decode and plan."""
    turns = -(-blocks // len(_SHAPES))
    return "\n".join(("% all", "G91", "F20", *_SHAPES * turns)) + "\n"


def _mark() -> Path:
    """The file that says that all is in the cache."""
    return kernels.machine_code() / "language-server"


def compile_all() -> None:
    """Analyses programs with compiled kernels, which leaves them in the cache: one in columns, one block by block."""
    settings = Settings(Config(), default_machine())
    size = max(kernels.LARGE, STREAMED // min(len(shape) for shape in _SHAPES))
    for blocks in (size, len(_SHAPES)):
        analysis = analyse(
            Document("untitled:all", 1, program(blocks), "utf-16").source(), 1, settings, always
        )
        assert timed(analysis, always) is not None
    _mark().touch()


if __name__ == "__main__":
    os.nice(10)
    kernels.use(compiled=True)
    compile_all()
