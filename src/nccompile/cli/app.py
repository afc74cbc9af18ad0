"""The subcommands and what is common to them: exit codes, errors in one line, closed pipes, Ctrl-C.

0    done
1    the program has errors, or the run stopped on a fault
2    wrong usage: an option, a file that cannot be read or is of another kind, a machine file
3    internal error
130  interrupted by Ctrl-C (143: terminated)
"""

from __future__ import annotations

import os
import signal
import traceback
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from types import FrameType
from typing import Annotated, Any

import typer
from typer.core import TyperCommand, TyperGroup

from nccompile import kernels
from nccompile.cli.compile import compile_program
from nccompile.cli.dump import dump
from nccompile.cli.explain import explain
from nccompile.cli.export_dxf import export_dxf
from nccompile.cli.fmt import format_programs
from nccompile.cli.groups import expanded
from nccompile.cli.import_dxf import import_dxf
from nccompile.cli.info import info
from nccompile.cli.lint import lint_programs
from nccompile.cli.lsp import serve
from nccompile.cli.machine import check
from nccompile.cli.plot import plot
from nccompile.cli.run import run_program
from nccompile.cli.sample import sample
from nccompile.cli.streams import forget_stdout, prepare_streams, say, written
from nccompile.errors import NccompileError
from nccompile.version import VERSION

__all__ = ["app", "run"]

INTERNAL = 3
INTERRUPTED = 130
TERMINATED = 143


@contextmanager
def _whoever_reads() -> Iterator[None]:
    """A reader that goes has what it wanted; typer would end with 1."""
    try:
        yield
    except BrokenPipeError as error:
        forget_stdout()
        raise typer.Exit(0) from error


class Commands(TyperGroup):
    """The commands; `--help | head` is no error."""

    def make_context(self, *given: Any, **named: Any) -> Any:
        """Reads the options before the command, `--help` among them."""
        with _whoever_reads():
            return super().make_context(*given, **named)

    def invoke(self, ctx: Any) -> Any:
        """Finds the command, reads its options and runs it."""
        with _whoever_reads():
            return super().invoke(ctx)


class Guarded(TyperCommand):
    """A command whose failures are one line on stderr and a documented exit code, never a traceback."""

    def invoke(self, ctx: Any) -> Any:
        """Runs the command's function."""
        kernels.on_first_compilation(_announce)
        try:
            return super().invoke(ctx)
        except NccompileError as error:
            say(f"error: {error}")
            raise typer.Exit(error.exit_code) from error
        except MemoryError as error:
            say("error: not enough memory")
            raise typer.Exit(INTERNAL) from error
        except (typer.Exit, typer.Abort, KeyboardInterrupt, BrokenPipeError):
            raise
        except OSError as error:
            say(f"error: {error.strerror or error}" + (f": {error.filename}" if error.filename else ""))
            raise typer.Exit(2) from error
        except Exception as error:
            if os.environ.get("NCCOMPILE_DEBUG"):
                traceback.print_exc()
            say(
                f"internal error: {type(error).__name__}: {str(error).splitlines()[:1]}; please report it "
                f"with the command line and the input (NCCOMPILE_DEBUG=1 shows where it happened)"
            )
            raise typer.Exit(INTERNAL) from error


app = typer.Typer(
    name="nccompile",
    cls=Commands,
    help="Compiles CNC part programs (DIN 66025) to planned toolpaths and runs them on virtual drives.",
    add_completion=False,
    no_args_is_help=True,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)
COMMANDS: dict[str, Callable[..., None]] = {
    "compile": compile_program,
    "info": info,
    "dump": dump,
    "sample": sample,
    "run": run_program,
    "plot": plot,
    "explain": explain,
    "lint": lint_programs,
    "fmt": format_programs,
    "lsp": serve,
    "import-dxf": import_dxf,
    "export-dxf": export_dxf,
}
for _name, _function in COMMANDS.items():
    app.command(_name, cls=Guarded)(expanded(_function))
_machine = typer.Typer(help="Machine files.", no_args_is_help=True, rich_markup_mode=None)
_machine.command("check", cls=Guarded)(check)
_machine.callback()(lambda: None)
app.add_typer(_machine, name="machine")


def _show_version(wanted: bool) -> None:
    if wanted:
        print(f"nccompile {VERSION}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool,
        typer.Option("--version", "-V", callback=_show_version, is_eager=True, help="Show the version."),
    ] = False,
) -> None:
    """Options before the subcommand; `--version` acts in its callback."""


def run(arguments: Sequence[str]) -> int:
    """Runs one command line and returns its exit code; nothing but Python's own start can raise."""
    prepare_streams()
    _exit_on_terminate()
    return written(lambda: _run(arguments))


def _run(arguments: Sequence[str]) -> int:
    """Raises OSError: help cannot be written; no command has begun."""
    code = 0
    try:
        app(args=list(arguments), prog_name="nccompile")
    except SystemExit as leaving:
        code = leaving.code if isinstance(leaving.code, int) else int(leaving.code is not None)
    except KeyboardInterrupt:
        code = INTERRUPTED
    if code == INTERRUPTED:
        say("interrupted")
    return code


def _exit_on_terminate() -> None:
    """A polite kill ends like an exception does, so that unfinished output is removed."""

    def leave(number: int, frame: FrameType | None) -> None:
        raise SystemExit(TERMINATED)

    try:
        signal.signal(signal.SIGTERM, leave)
    except ValueError:  # not in the main thread: whoever runs us there handles signals
        return


def _announce() -> None:
    say("compiling kernels for this computer, once (10 to 30 s) ...")
