"""What README.md shows is what the commands print."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest

from nccompile.cli.app import run

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "README.md").read_text()
SESSIONS = re.findall(r"^\$ (nccompile [^\n]*)\n((?:(?!\$ |```)[^\n]*\n)*)", TEXT, re.MULTILINE)


def _masked(text: str) -> str:
    """Without hashes: they change with every byte of the samples, and say nothing to a reader."""
    return re.sub(r"sha256 [0-9a-f]{16}", "sha256 ...", text)


def test_the_sessions_of_the_readme(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Runs them in the order of the page, in a folder that has the samples and the page's own program."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "samples").symlink_to(ROOT / "samples")
    program = re.search(r"\$ cat plate.nc\n(.*?)\n\n", TEXT, re.DOTALL)
    assert program is not None
    (tmp_path / "plate.nc").write_text(program[1] + "\n")
    assert len(SESSIONS) >= 5
    for command, shown in SESSIONS:
        run(shlex.split(command)[1:])
        printed = capsys.readouterr()
        if shown.strip():
            assert _masked(printed.out + printed.err) == _masked(shown.rstrip("\n") + "\n"), command
