"""A block's words to a statement: one instruction and its operands (SoftMotion §3.2).

Words are evaluated from right to left, so of a repeated word the leftmost holds.  Nothing here moves; the
modal words D, E, F and S take effect when the whole block is found to be sound.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from nccompile.decoder.core import LIMIT, Core
from nccompile.decoder.tables import (
    DWELL,
    INSTRUCTIONS,
    LETTERS,
    M_FUNCTION,
    MODAL,
    MOTION,
    PROFILE_AXES,
    Group,
    Instruction,
)
from nccompile.parser import Block, Variable, Word
from nccompile.source import Span

__all__ = ["Statement", "evaluate", "resolve", "set_modal"]

_COLLECTED = frozenset("GMEHOLS")
"""Letters that need more than their last value."""

_SWITCH = frozenset("HOL")


@dataclass(slots=True)
class Statement:
    """A block ready to be executed.

    instruction: None if the block has none;  number: of the M function;  values: operand values by letter,
    without switch words;  words: where they stand;  switches: H, O and L words in written order if there is
    an H;  variable: name in the O word of G36, G37 and M;  limits: the E words.
    """

    block: Block
    instruction: Instruction | None = None
    number: int = 0
    values: dict[str, float] = field(default_factory=dict)
    switches: list[tuple[Word, float]] = field(default_factory=list)
    variable: str | None = None
    limits: list[tuple[Word, float]] = field(default_factory=list)
    profiles: list[tuple[Word, float]] = field(default_factory=list)

    @property
    def line(self) -> int:
        """The source line."""
        return self.block.line

    @property
    def span(self) -> Span:
        """Where the instruction stands, or the whole block."""
        for word in self.block.words:
            if word.letter in {"G", "M"}:
                return word.span
        return self.block.span

    @property
    def name(self) -> str:
        """The instruction as a program writes it."""
        assert self.instruction is not None
        return self.instruction.name if self.instruction.code >= 0 else f"M{self.number}"

    def place(self, letter: str) -> Span:
        """Where the word that holds stands, or the whole block."""
        for word in self.block.words:
            if word.letter == letter:
                return word.span
        return self.block.span


def evaluate(core: Core, block: Block) -> Statement | None:
    """The statement of a block; None if it has an error, which is reported."""
    statement = Statement(block)
    values = statement.values
    collected: list[tuple[Word, float]] = []
    repeated: set[str] = set()
    sound = True
    for word in reversed(block.words):
        letter = word.letter
        value = word.value
        if value.__class__ is not float:
            if core.options.ignore and _is_ignored(core, word):
                continue
            if letter == "O" and isinstance(value, Variable):
                collected.append((word, 0.0))
                continue
            value = resolve(core, word)
            if value is None:
                sound = sound and word.value is None
                continue
        assert isinstance(value, float)
        if not -LIMIT <= value <= LIMIT:
            core.error("NC120", f"{word.text} is out of range: the limit is {LIMIT:.0e}", word.span)
            sound = False
        elif core.options.ignore and _is_ignored(core, word):
            continue
        elif letter in _COLLECTED:
            collected.append((word, value))
        else:
            if letter in values:
                repeated.add(letter)
            values[letter] = value
    for letter in sorted(repeated):
        _repeated(core, statement, letter)
    if collected and not _sort(core, statement, collected):
        sound = False
    return statement if sound and _check(core, statement) else None


def resolve(core: Core, word: Word) -> float | None:
    """The value of a word; None (reported) for an unknown variable or a word without value."""
    value = word.value
    if isinstance(value, float):
        return value
    if value is None:
        core.warn(
            "NC013", f"{word.text} has no value and is left out", word.span,
            "a post-processor wrote it where it had no value",
        )  # fmt: skip
        return None
    found = core.variables.get(value.name)
    if found is None:
        core.error(
            "NC110", f"variable ${value.name}$ is not defined", word.span, core.variables.advice(value.name)
        )
    return found


def _is_ignored(core: Core, word: Word) -> bool:
    ignore = core.options.ignore
    if word.letter in ignore:
        return True
    value = word.value
    return isinstance(value, float) and f"{word.letter}{value:g}" in ignore


def _repeated(core: Core, statement: Statement, letter: str) -> None:
    spans = [word.span for word in statement.block.words if word.letter == letter]
    core.warn(
        "NC104", f"{letter} is programmed {len(spans)} times in this block; the first one holds", spans[1],
        "words are evaluated from right to left; remove all but one",
    )  # fmt: skip


def _sort(core: Core, statement: Statement, collected: list[tuple[Word, float]]) -> bool:
    """Sorts the words that need more than their last value into the statement."""
    collected.reverse()
    if not _set_instruction(core, statement, [pair for pair in collected if pair[0].letter in {"G", "M"}]):
        return False
    statement.limits = [pair for pair in collected if pair[0].letter == "E"]
    statement.profiles = [pair for pair in collected if pair[0].letter == "S"]
    places = [pair for pair in collected if pair[0].letter in _SWITCH]
    if any(word.letter == "H" for word, _ in places):
        statement.switches = places
        return _resolve_switches(core, statement)
    instruction = statement.instruction
    for word, value in reversed(places):
        if isinstance(word.value, Variable) and instruction is not None and "O" in instruction.operands:
            statement.variable = word.value.name
        if word.letter in statement.values:
            _repeated(core, statement, word.letter)
        statement.values[word.letter] = value
    return True


def _resolve_switches(core: Core, statement: Statement) -> bool:
    """Puts the values of variables into O words beside H."""
    resolved = []
    for word, value in statement.switches:
        found = resolve(core, word) if isinstance(word.value, Variable) and word.letter == "O" else value
        if found is None:
            return False
        resolved.append((word, found))
    statement.switches = resolved
    return True


def _set_instruction(core: Core, statement: Statement, found: list[tuple[Word, float]]) -> bool:
    if not found:
        return True
    if len(found) > 1:
        first, second = found[0][0], found[1][0]
        core.error(
            "NC103", f"{first.text} and {second.text} are two instructions in one block", second.span,
            "write one instruction a block",
        )  # fmt: skip
        return False
    word, value = found[0]
    if not value.is_integer():
        core.error("NC107", f"{word.letter} needs a whole number, not {word.number}", word.span)
        return False
    if word is not statement.block.words[0]:
        core.warn(
            "NC128", f"{word.text} does not stand first in its block", word.span, "put it after the N word"
        )
    if word.letter == "M":
        statement.instruction, statement.number = M_FUNCTION, int(value)
        return True
    statement.instruction = INSTRUCTIONS.get(int(value))
    if statement.instruction is None:
        core.error(
            "NC102", f"{word.text.upper()} is not an instruction of this language", word.span,
            "it has " + " ".join(row.name for row in INSTRUCTIONS.values()),
        )  # fmt: skip
        return False
    return True


def _check(core: Core, statement: Statement) -> bool:
    """Finds the instruction of a block without one and reports words that have no effect."""
    instruction = statement.instruction
    values = statement.values
    if instruction is None:
        if not statement.switches and MOTION.isdisjoint(values):
            _report_unused(core, statement, values.keys() - MODAL, "in a block that moves nothing")
            return True
        if core.modal.drive is None:
            core.modal.drive = 0
            if not core.incomplete:
                core.warn(
                    "NC106", "no instruction has been programmed yet; the block runs as G0",
                    statement.block.span, "start it with G0 or G1",
                )  # fmt: skip
        instruction = statement.instruction = INSTRUCTIONS[core.modal.drive]
    if instruction.group is not Group.DRIVE:
        for word, _ in statement.switches:
            core.warn("NC105", f"{word.letter} has no effect with {statement.name}", word.span)
        statement.switches = []
    if not values.keys() <= instruction.accepts:
        _report_unused(core, statement, values.keys() - instruction.accepts, f"with {statement.name}")
    return True


def _report_unused(core: Core, statement: Statement, letters: set[str], where: str) -> None:
    for letter in sorted(letters):
        hint = f"{letter}: {LETTERS[letter].meaning}"
        if letter in "OL":
            hint = f"to place a switch put H before {letter}"
        core.warn("NC105", f"{letter} has no effect {where}", statement.place(letter), hint)
        del statement.values[letter]


def set_modal(core: Core, statement: Statement) -> bool:
    """Lets the modal words of a block take effect; False if one of them is wrong (reported)."""
    values, modal = statement.values, core.modal
    instruction = statement.instruction
    sound = True
    if "F" in values and instruction is not DWELL:
        sound = _set_feed(core, statement)
    if "D" in values and (instruction is None or "D" not in instruction.operands):
        if values["D"] < 0.0:
            core.error(
                "NC126", f"the radius D must not be negative, not {values['D']:g}", statement.place("D")
            )
            sound = False
        else:
            modal.radius = values["D"]
    for word, value in statement.limits:
        if abs(value) < 1.0:
            core.error(
                "NC109", f"{word.text} is too low: an acceleration is at least 1 mm/s2, a deceleration at most -1",
                word.span,
            )  # fmt: skip
            sound = False
        elif value > 0.0:
            modal.accel = value
        else:
            modal.decel = -value
    for word, value in statement.profiles:
        sound = _set_profile(core, word, value) and sound
    return sound


def _set_feed(core: Core, statement: Statement) -> bool:
    feed = statement.values["F"]
    if feed <= 0.0:
        core.error("NC108", f"the feed F must be greater than 0, not {feed:g}", statement.place("F"))
        return False
    core.modal.feed = feed
    return True


def _set_profile(core: Core, word: Word, value: float) -> bool:
    letter = PROFILE_AXES.get(int(abs(value))) if value.is_integer() else None
    if letter is None:
        known = " ".join(f"{number}={name}" for number, name in PROFILE_AXES.items())
        core.error("NC122", f"{word.text} names no axis with an S-profile", word.span, f"S takes {known}")
        return False
    bit = 1 << core.index[letter] if letter in core.index else 0
    core.modal.profile = core.modal.profile | bit if value > 0 else core.modal.profile & ~bit
    return True
