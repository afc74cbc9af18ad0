"""Neovim and Emacs, set up by the very lines of docs/editors.md, open a program and use the server.

python -m tests.lsp.real_editors [neovim] [neovim-0.8] [emacs]

NVIM and EMACS name the editors if they are not on the path; without arguments those that are there are tried.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "editors.md"
TIMEOUT = 180.0
"""Time after which an editor counts as stuck [s]."""

PROGRAM = ROOT / "editors" / "bracket.nc"
"""What is opened; it has a few things to find and to mend."""

Command = Callable[[Path, Path], list[str]]


def set_up(language: str, at: int) -> str:
    """The set-up lines of the page: the `at`-th block in a language."""
    blocks: list[str] = re.findall(rf"```{language}\n(.*?)```", PAGE.read_text(), re.DOTALL)
    return blocks[at]


def neovim(at: int) -> Command:
    """Neovim with a block of set-up lines as its init.lua."""

    def command(home: Path, program: Path) -> list[str]:
        (home / "nvim").mkdir()
        (home / "nvim" / "init.lua").write_text(set_up("lua", at))
        check = ROOT / "editors" / "neovim" / "check.lua"
        return ["--headless", str(program), "-c", f"luafile {check}"]

    return command


def emacs(home: Path, program: Path) -> list[str]:
    """Emacs in batch mode with the set-up lines as its init file."""
    (home / "init.el").write_text(set_up("lisp", 0))
    check = ROOT / "editors" / "emacs" / "check.el"
    return ["--batch", "-l", str(home / "init.el"), "-l", str(check)]


class Editor(NamedTuple):
    """An editor: the program, the variable that names another one, a probe that ends with 0 if it is new enough."""

    program: str
    variable: str
    probe: tuple[str, ...]
    command: Command

    def path(self) -> str:
        return os.environ.get(self.variable, self.program)

    def is_there(self) -> bool:
        if shutil.which(self.path()) is None:
            return False
        return subprocess.run([self.path(), *self.probe], capture_output=True, check=False).returncode == 0


def _neovim(version: str, at: int) -> Editor:
    has = f"lua os.exit(vim.fn.has('nvim-{version}') == 1 and 0 or 1)"
    return Editor("nvim", "NVIM", ("--clean", "--headless", "-c", has), neovim(at))


EDITORS = {
    "neovim": _neovim("0.11", 0),
    "neovim-0.8": _neovim("0.8", 1),
    "emacs": Editor("emacs", "EMACS", ("--batch", "--eval", "(require 'eglot)"), emacs),
}


def tried(name: str) -> bool:
    """Runs one editor and prints what it saw; whether all was right."""
    with tempfile.TemporaryDirectory() as folder:
        home, results = Path(folder), Path(folder) / "results"
        program = home / "work" / "bracket.nc"
        program.parent.mkdir()
        shutil.copy(PROGRAM, program)
        environment = os.environ | {
            "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}",
            "HOME": folder,
            "XDG_CONFIG_HOME": folder,
            "XDG_STATE_HOME": folder,
            "RESULTS": str(results),
            "PROGRAM": str(program),
        }
        done = subprocess.run(
            [EDITORS[name].path(), *EDITORS[name].command(home, program)],
            env=environment, stdin=subprocess.DEVNULL, capture_output=True, timeout=TIMEOUT, check=False,
        )  # fmt: skip
        seen = results.read_text().splitlines() if results.exists() else []
    for line in seen:
        print(f"{name}: {line}")
    if not seen:
        print(f"{name}: no results, exit code {done.returncode}\n{done.stderr.decode()[-4000:]}")
    return bool(seen) and all(line.startswith("ok ") for line in seen)


def main(names: list[str]) -> int:
    """0 if all editors saw what they should, or none is there."""
    wanted = names or [name for name, editor in EDITORS.items() if editor.is_there()]
    return 0 if all([tried(name) for name in wanted]) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
