"""The decoder of the DIN 66025 dialect: blocks in, toolpath chunks out (SoftMotion §3.2, §6.2.1)."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Set
from contextlib import closing

from nccompile.decoder.columnar import Runs
from nccompile.decoder.core import Core
from nccompile.decoder.flow import Flow
from nccompile.decoder.motion import Motion
from nccompile.decoder.options import DecodeOptions
from nccompile.decoder.program import Listed, Scanned
from nccompile.decoder.tables import Group
from nccompile.decoder.variables import INT_MAX, INT_MIN
from nccompile.decoder.words import Statement, evaluate, set_modal
from nccompile.diagnostics import Diagnostics
from nccompile.errors import Cancelled
from nccompile.kernels import compiled
from nccompile.parser import Block, Reader, parse, report_control
from nccompile.parser.scanner import Table, survey, tables
from nccompile.source import LargeSource, Source
from nccompile.threads import ahead
from nccompile.toolpath.columns import ADDITIONAL, AXIS_LETTERS, EventKind, Kind, Toolpath

__all__ = ["Din66025", "axes_of"]

_MOST_M = 65535
"""Greatest M number: the interpolator shows it as an IEC WORD (SoftMotion §6.2.8, wM)."""

_AXIS_WORD = re.compile(
    r"\([^()\n\r]*\)|^[ \t]*%[^\n\r]*|([ABCPQUVWabcpquvw])(?=[-+.0-9$])|\$[^$\n\r]*\$", re.MULTILINE
)
_JUMP = re.compile(r"[Gg](?:0*20(?![0-9])|\$)")

_PART = 1 << 16
"""Characters that are searched at a time: a millisecond."""

_ASKED = 8
"""Statements after which is asked whether the program is still wanted: at most some milliseconds."""


def axes_of(text: str, options: DecodeOptions) -> tuple[str, ...]:
    """The axes of a program: X Y Z, and those of the others that it or the start position names."""
    letters = {letter.upper() for part in _parts(text) for letter in _AXIS_WORD.findall(part)}
    return _axes(letters, options)


def _parts(text: str) -> Iterator[str]:
    """A text cut at ends of lines: no thread could do anything while a long one is searched."""
    begin = 0
    while begin < len(text):
        end = text.find("\n", begin + _PART) + 1 or len(text)
        yield text[begin:end]
        begin = end


def _axes(letters: Set[str], options: DecodeOptions) -> tuple[str, ...]:
    named = letters | {key.upper() for key in options.start}
    return tuple(letter for letter in AXIS_LETTERS if letter in "XYZ" or letter in named)


class Din66025:
    """Decodes one program; `chunks` may be iterated once."""

    def __init__(
        self,
        source: Source,
        options: DecodeOptions,
        diagnostics: Diagnostics,
        *,
        columnar: bool | None = None,
        wanted: Callable[[], bool] | None = None,
    ) -> None:
        """`columnar`: whether runs of plain blocks are decoded as columns; None: if the source is large."""
        self._source, self._diagnostics = source, diagnostics
        self._stream: LargeSource | None = None
        self._control = -1
        if isinstance(source, LargeSource) and (compiled() if columnar is None else columnar):
            found = survey(source, ADDITIONAL)
            jumps, self._control = found.jumps, found.control
            self.axes = _axes(found.letters, options)
            self._stream = None if options.ignore else source
        else:
            jumps = any(_JUMP.search(part) for part in _parts(source.text))
            self.axes = axes_of(source.text, options)
        self._core = Core(source, self.axes, options, diagnostics, jumps)
        self._jumps = jumps
        self._flow: Flow | None = None
        self._wanted = wanted
        self._taken = 0
        self._motion = Motion(self._core)
        self._skip = options.skip_blocks

    def chunks(self) -> Iterator[Toolpath]:
        """The toolpath, in chunks whose borders are the only thing that depends on their size."""
        if self._stream is None:
            yield from self._statements()
        elif self._control >= 0:
            report_control(self._stream, self._diagnostics, self._control)
        elif self._jumps:
            yield from self._jumping_columns(self._stream)
        else:
            yield from self._columns(self._stream)
        self._motion.spline.close(None)
        self._core.flush_position()
        self._motion.marks.finish()
        yield from self._core.path.finish()

    def _statements(self) -> Iterator[Toolpath]:
        path = self._core.path
        for block in self._in_order():
            self._take(block)
            if path.is_full:
                yield from path.ready()

    def _in_order(self) -> Iterator[Block]:
        """The blocks as they run; all are kept in memory only if there are jumps."""
        blocks = parse(self._source, self._diagnostics)
        if not self._jumps:
            yield from blocks
            return
        self._flow = Flow(self._core, Listed(blocks), self._wanted)
        while (block := self._flow.next()) is not None:
            yield block

    def _jumping_columns(self, source: LargeSource) -> Iterator[Toolpath]:
        path, runs = self._core.path, Runs(self._core, self._motion)
        program = Scanned(tables(source), Reader(source, self._diagnostics))
        flow = self._flow = Flow(self._core, program, self._wanted)
        while not flow.has_ended:
            table, row = program.place(flow.at)
            stop = runs.run(table, row, flow.left)
            flow.skip(stop - row)
            out_of_room = path.rows == path.room
            if path.is_full:
                yield from path.ready()
            if stop < table.blocks and not out_of_room:
                block = flow.next()
                if block is not None:
                    self._take(block)

    def _columns(self, source: LargeSource) -> Iterator[Toolpath]:
        reader = Reader(source, self._diagnostics)
        runs = Runs(self._core, self._motion)
        with closing(ahead(tables(source))) as stream:
            for table in stream:
                yield from self._table(table, reader, runs)
                if reader.stopped:
                    return
        reader.finish()

    def _table(self, table: Table, reader: Reader, runs: Runs) -> Iterator[Toolpath]:
        path = self._core.path
        at = 0
        while at < table.blocks and not reader.stopped:
            if reader.any_block:
                at = runs.run(table, at)
                out_of_room = path.rows == path.room
                if path.is_full:
                    yield from path.ready()
                if at == table.blocks:
                    break
                if out_of_room:
                    continue
            block = reader.take(int(table.block_line[at]), table.text(at))
            if block is not None:
                self._take(block)
            at += 1

    def _take(self, block: Block) -> None:
        self._taken += 1
        if self._taken % _ASKED == 0 and self._wanted is not None and not self._wanted():
            raise Cancelled
        if not (block.skip and self._skip):
            self._run(block)

    def _run(self, block: Block) -> None:
        core = self._core
        if not block.sound:
            core.incomplete = True
        elif block.words:
            statement = evaluate(core, block)
            if statement is not None and set_modal(core, statement):
                self._execute(statement)
            else:
                core.incomplete = True

    def _execute(self, statement: Statement) -> None:
        instruction = statement.instruction
        if instruction is None:
            return
        group, code = instruction.group, instruction.code
        if group is Group.DRIVE:
            self._motion.drive(statement)
        elif group is Group.DISTANCE:
            self._core.modal.absolute = code == 90
        elif group is Group.CENTRE:
            self._core.modal.centre_absolute = code == 98
        elif group in {Group.TOOL, Group.CORNER, Group.LOOP}:
            self._mark(statement, code)
        elif group is Group.POSITION:
            self._set_position(statement)
        elif group is Group.VARIABLE:
            self._assign(statement, code)
        elif group is Group.FLOW:
            self._jump(statement)
        elif code == 4:
            self._dwell(statement)
        else:
            self._m_function(statement)

    def _mark(self, statement: Statement, code: int) -> None:
        if code in {40, 50, 60}:
            self._motion.marks.stop(code)
        else:
            self._motion.marks.start(code, statement.span)

    def _set_position(self, statement: Statement) -> None:
        core = self._core
        if not any(letter in core.index for letter in statement.values):
            core.warn("NC127", "G92 without an axis word has no effect", statement.span)
            return
        target = core.modal.position.copy()
        if not core.modal.absolute:
            core.warn("NC129", "the values of G92 are absolute, also after G91", statement.span)
        for letter, value in statement.values.items():
            if letter in core.index:
                target[core.index[letter]] = value
        self._motion.spline.close(None)
        core.set_position(target, statement.line)

    def _dwell(self, statement: Statement) -> None:
        values = statement.values
        seconds = values.get("T", values.get("F"))
        if seconds is None or seconds < 0.0:
            what = "has no time" if seconds is None else "has a negative time"
            self._core.error(
                "NC130", f"the dwell G4 {what}", statement.span, "write G4 T0.5 for half a second"
            )
            return
        if "T" in values and "F" in values:
            self._core.warn("NC105", "F has no effect beside T", statement.place("F"))
        self._core.wait(Kind.DWELL, EventKind.DWELL, 0, statement.line, seconds)

    def _m_function(self, statement: Statement) -> None:
        if not 0 <= statement.number <= _MOST_M:
            self._core.error("NC121", f"M takes a number from 0 to {_MOST_M}", statement.span)
            return
        values = statement.values
        name = statement.variable
        if name is None and "O" in values:
            name = next(word.number for word in statement.block.words if word.letter == "O")
        self._core.wait(
            Kind.M_FUNCTION, EventKind.M_FUNCTION, statement.number, statement.line,
            values.get("K", 0.0), values.get("L", 0.0), name,
        )  # fmt: skip

    def _assign(self, statement: Statement, code: int) -> None:
        core, values, name = self._core, statement.values, statement.variable
        if "D" not in values:
            core.error("NC111", f"G{code} has no value D", statement.span, f"write G{code} O$name$ D5")
            return
        if name is None:
            if "O" in values:
                core.error(
                    "NC111", f"O of G{code} must name a variable", statement.place("O"), "write O$name$"
                )
            else:
                self._assign_implicit(statement, code)
            return
        old: float | None = 0.0
        if code == 37:
            old = core.variables.get(name)
        if old is None:
            core.error(
                "NC110",
                f"variable ${name}$ is not defined",
                statement.place("O"),
                core.variables.advice(name),
            )
            return
        core.variables.set(name, old + values["D"])

    def _assign_implicit(self, statement: Statement, code: int) -> None:
        step = statement.values["D"]
        value = step if code == 36 else self._core.variables.implicit + step
        if not step.is_integer() or not INT_MIN <= value <= INT_MAX:
            self._core.error(
                "NC112", f"the implicit variable is a whole number from {INT_MIN} to {INT_MAX}, not {value:g}",
                statement.place("D"), "name a variable with O$name$",
            )  # fmt: skip
            return
        self._core.variables.set_implicit(value)

    def _jump(self, statement: Statement) -> None:
        values = statement.values
        number = values.get("L")
        if number is None or not number.is_integer() or number < 0:
            self._core.error(
                "NC116", "the jump G20 needs the number of a block in L", statement.span, "write G20 L100"
            )
            return
        condition = values.get("K", self._core.variables.implicit)
        assert self._flow is not None  # the text has a G20
        self._flow.jump(int(number), condition != 0.0, statement.block, statement.place("L"))
