"""The order in which the blocks of a program with jumps run (SoftMotion §3.2.7)."""

from __future__ import annotations

from collections.abc import Callable

from nccompile.decoder.core import Core
from nccompile.decoder.program import Program
from nccompile.errors import Cancelled
from nccompile.parser import Block
from nccompile.source import Span

__all__ = ["Flow"]


class Flow:
    """Says which block of a program with jumps runs next; `jump` decides what comes after the one handed out last.

    at: index of the next block;  left: how many more may run before the program is stopped.
    """

    def __init__(self, core: Core, program: Program, wanted: Callable[[], bool] | None = None) -> None:
        """`wanted` is asked at every jump that is taken, which raises `Cancelled` if it says no."""
        self._core = core
        self._wanted = wanted
        self._program = program
        self.at = 0
        self.left = core.options.max_blocks
        self._taken = 0
        self._versions: dict[int, int] = {}

    @property
    def has_ended(self) -> bool:
        """Whether no block is left to run."""
        return self.at >= len(self._program)

    def skip(self, blocks: int) -> None:
        """Goes on behind blocks that have been run without `next`."""
        self.at += blocks
        self.left -= blocks

    def next(self) -> Block | None:
        """The next block; None if the program ends or is stopped here."""
        if self.has_ended:
            return None
        block = self._program.block(self.at)
        if self.left == 0:
            most = self._core.options.max_blocks
            self._stop(f"the program is stopped after {most:,} executed blocks", block.span)
            return None
        self.skip(1)
        return block

    def jump(self, number: int, is_taken: bool, block: Block, span: Span) -> None:
        """G20 in `block`: the next one is block `number` if the jump is taken; its target is checked anyway."""
        targets = self._program.targets(number)
        if len(targets) != 1:
            self._report_target(number, targets, span)
            return
        if not is_taken:
            return
        if self._wanted is not None and not self._wanted():
            raise Cancelled
        here = self.at - 1
        version = self._core.variables.version
        self._taken += 1
        if targets[0] <= here and self._versions.get(here) == version:
            self._stop(
                "this jump would repeat for ever: nothing between it and its target changes", block.span
            )
        elif self._taken > self._core.options.max_jumps:
            self._stop(f"the program is stopped after {self._taken - 1:,} jumps", block.span)
        else:
            self.at = targets[0]
        self._versions[here] = version

    def _stop(self, message: str, span: Span) -> None:
        self._core.error(
            "NC115", message, span, "let G37 bring the jump condition K to exactly 0, or raise the limit"
        )  # fmt: skip
        self.at = len(self._program)

    def _report_target(self, number: int, targets: list[int], span: Span) -> None:
        if not targets:
            near = self._program.nearest(number)
            help = "" if near is None else f"the nearest block number is N{near}"
            self._core.error("NC113", f"there is no block N{number} to jump to", span, help)
        else:
            lines = ", ".join(str(self._program.block(at).line) for at in targets[:5])
            self._core.error(
                "NC114", f"block number N{number} occurs more than once", span, f"on lines {lines}"
            )
