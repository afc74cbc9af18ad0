"""The order in which blocks run: one after the other, or by jumps (SoftMotion §3.2.7)."""

from __future__ import annotations

from collections.abc import Iterator

from nccompile.decoder.core import LIMIT, Core
from nccompile.parser import Block
from nccompile.source import Span

__all__ = ["Flow"]


class Flow:
    """Hands out blocks; `jump` decides what comes after the one handed out last.

    Without jumps in the program blocks pass through one by one; with jumps all of them are kept.
    """

    def __init__(self, core: Core, blocks: Iterator[Block], jumps: bool) -> None:
        self._core = core
        self._source = blocks
        self._jumps = jumps
        self._at = 0
        self._taken = 0
        self._versions: dict[int, int] = {}
        self._numbers: dict[int, list[int]] = {}
        self._program: list[Block] = []

    def __iter__(self) -> Iterator[Block]:
        if not self._jumps:
            yield from self._source
            return
        self._program = list(self._source)
        for at, block in enumerate(self._program):
            number = block.number.value if block.number is not None else None
            if isinstance(number, float) and number <= LIMIT:
                self._numbers.setdefault(int(number), []).append(at)
        ran = 0
        while self._at < len(self._program):
            block = self._program[self._at]
            self._at += 1
            ran += 1
            if ran > self._core.options.max_blocks:
                self._stop(f"the program is stopped after {ran - 1:,} executed blocks", block.span)
                return
            yield block

    def jump(self, number: int, is_taken: bool, block: Block, span: Span) -> None:
        """G20 in `block`: the next one is block `number` if the jump is taken; its target is checked anyway."""
        targets = self._numbers.get(number, [])
        if len(targets) != 1:
            self._report_target(number, targets, span)
            return
        if not is_taken:
            return
        here = self._at - 1
        version = self._core.variables.version
        self._taken += 1
        if targets[0] <= here and self._versions.get(here) == version:
            self._stop(
                "this jump would repeat for ever: nothing between it and its target changes", block.span
            )
        elif self._taken > self._core.options.max_jumps:
            self._stop(f"the program is stopped after {self._taken - 1:,} jumps", block.span)
        else:
            self._at = targets[0]
        self._versions[here] = version

    def _stop(self, message: str, span: Span) -> None:
        self._core.error(
            "NC115", message, span, "let G37 bring the jump condition K to exactly 0, or raise the limit"
        )  # fmt: skip
        self._at = len(self._program)

    def _report_target(self, number: int, targets: list[int], span: Span) -> None:
        if not targets:
            near = min(self._numbers, key=lambda known: abs(known - number), default=None)
            help = "" if near is None else f"the nearest block number is N{near}"
            self._core.error("NC113", f"there is no block N{number} to jump to", span, help)
        else:
            lines = ", ".join(str(self._program[at].line) for at in targets[:5])
            self._core.error(
                "NC114", f"block number N{number} occurs more than once", span, f"on lines {lines}"
            )
