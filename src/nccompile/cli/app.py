"""The subcommands and what is common to them: exit codes, errors in one line, closed pipes, Ctrl-C.

0    done
1    the program has errors, or the run stopped on a fault
2    wrong usage: an option, a file that cannot be read or is of another kind, a machine file
3    internal error
130  interrupted by Ctrl-C (143: terminated)
"""

from __future__ import annotations

import io
import os
import signal
import sys
import traceback
from collections.abc import Callable, Sequence
from pathlib import Path
from types import FrameType
from typing import Annotated, Any

import typer
from typer.core import TyperCommand

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
from nccompile.errors import NccompileError
from nccompile.version import VERSION

__all__ = ["app", "run"]

INTERNAL = 3
INTERRUPTED = 130
TERMINATED = 143


class Guarded(TyperCommand):
    """A command whose failures are one line on stderr and a documented exit code, never a traceback."""

    def invoke(self, ctx: Any) -> Any:
        """Runs the command's function."""
        kernels.on_first_compilation(_announce)
        try:
            return super().invoke(ctx)
        except NccompileError as error:
            _say(f"error: {error}")
            raise typer.Exit(error.exit_code) from error
        except MemoryError as error:
            _say("error: not enough memory")
            raise typer.Exit(INTERNAL) from error
        except (typer.Exit, typer.Abort, KeyboardInterrupt):
            raise
        except BrokenPipeError as error:  # the reader has what it wanted
            _forget_stdout()
            raise typer.Exit(0) from error
        except OSError as error:
            _say(f"error: {error.strerror or error}" + (f": {error.filename}" if error.filename else ""))
            raise typer.Exit(2) from error
        except Exception as error:
            if os.environ.get("NCCOMPILE_DEBUG"):
                traceback.print_exc()
            _say(
                f"internal error: {type(error).__name__}: {str(error).splitlines()[:1]}; please report it "
                f"with the command line and the input (NCCOMPILE_DEBUG=1 shows where it happened)"
            )
            raise typer.Exit(INTERNAL) from error


app = typer.Typer(
    name="nccompile",
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
    _open_closed_streams()
    _write_any_text()
    _exit_on_terminate()
    try:
        app(args=list(arguments), prog_name="nccompile")
    except SystemExit as leaving:
        code = leaving.code if isinstance(leaving.code, int) else int(leaving.code is not None)
    except KeyboardInterrupt:
        code = INTERRUPTED
    except OSError as error:  # help that cannot be written: no command has begun
        _say(f"error: standard output cannot be written: {error.strerror or error}")
        code = 2
        _forget_stdout()
    else:
        code = 0
    if code == INTERRUPTED:
        _say("interrupted")
    return _close_stdout(code)


def _open_closed_streams() -> None:
    """Gives streams that the caller has closed (`>&-`) an empty file, so that nobody need ask for them."""
    for name, mode in (("stdin", "r"), ("stdout", "w"), ("stderr", "w")):
        if getattr(sys, name) is None:
            setattr(sys, name, Path(os.devnull).open(mode, encoding="utf-8"))  # noqa: SIM115 - open till the end


def _write_any_text() -> None:
    """Files and pipes get UTF-8; what a terminal, or the name of a file, cannot say is written as an escape."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            fixed = stream.isatty() or "PYTHONIOENCODING" in os.environ
            stream.reconfigure(encoding=None if fixed else "utf-8", errors="backslashreplace")


def _close_stdout(code: int) -> int:
    """Flushes what is left; a reader that has gone (`| head`) is not an error."""
    try:
        sys.stdout.flush()
    except BrokenPipeError:
        _forget_stdout()
    except OSError as error:
        _say(f"error: standard output cannot be written: {error.strerror or error}")
        _forget_stdout()
        return 2
    return code


def _forget_stdout() -> None:
    """Lets what is still written to standard output vanish, so that leaving Python does not fail on it."""
    nothing = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nothing, sys.stdout.fileno())
    os.close(nothing)


def _exit_on_terminate() -> None:
    """A polite kill ends like an exception does, so that unfinished output is removed."""

    def leave(number: int, frame: FrameType | None) -> None:
        raise SystemExit(TERMINATED)

    try:
        signal.signal(signal.SIGTERM, leave)
    except ValueError:  # not in the main thread: whoever runs us there handles signals
        return


def _announce() -> None:
    _say("compiling kernels for this computer, once (10 to 30 s) ...")


def _say(text: str) -> None:
    """A line on stderr; if stderr is closed nobody wants it."""
    try:
        print(text, file=sys.stderr)
    except (OSError, ValueError):
        return
