"""Large programs on the command line: pipes, progress, interruption."""

from __future__ import annotations

import os
import pty
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

COMMAND = [sys.executable, "-m", "nccompile", "compile"]


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Path:
    x = np.cumsum(np.full(600_000, 0.01))
    rows = "".join(f"N{n} G1 X{x:.2f} Y{n % 7}.5\n" for n, x in enumerate(x.tolist(), 1))
    file = tmp_path_factory.mktemp("large") / "large.nc"
    file.write_text("% large\nG1 F100 E1000 E-1000\n" + rows)
    return file


def test_a_pipe_gives_the_queue_of_the_file(program: Path, tmp_path: Path) -> None:
    file, pipe = tmp_path / "file.ncq", tmp_path / "pipe.ncq"
    subprocess.run([*COMMAND, str(program), "-o", str(file)], check=True, capture_output=True)
    with program.open("rb") as feed:
        subprocess.run([*COMMAND, "-", "-o", str(pipe)], stdin=feed, check=True, capture_output=True)
    with np.load(file) as one, np.load(pipe) as two:
        assert one.files == two.files
        assert all(np.array_equal(one[name], two[name]) for name in one.files if name.endswith("target"))


def test_interrupted_compilations_leave_no_file(program: Path, tmp_path: Path) -> None:
    out = tmp_path / "out.ncq"
    process = subprocess.Popen([*COMMAND, str(program), "-o", str(out)], stderr=subprocess.PIPE)
    for _ in range(2000):
        if any(tmp_path.iterdir()):
            break
        time.sleep(0.005)
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=60)
    assert (process.returncode, list(tmp_path.iterdir())) == (130, [])
    assert b"interrupted" in said


def test_progress_is_shown_on_a_terminal_only(program: Path, tmp_path: Path) -> None:
    quiet = subprocess.run(
        [*COMMAND, str(program), "-o", str(tmp_path / "a.ncq")], check=True, capture_output=True
    )
    assert b"\r" not in quiet.stderr
    terminal, end = pty.openpty()
    seen: list[bytes] = []

    def listen() -> None:
        try:
            while part := os.read(terminal, 1000):
                seen.append(part)
        except OSError:  # Linux reports the end of a terminal so
            return

    large = tmp_path / "large.nc"
    head, rows = program.read_text().split("\n", 1)
    large.write_text("\n".join([head, rows, rows, rows]))  # a short compilation shows nothing
    listener = threading.Thread(target=listen, daemon=True)
    listener.start()
    subprocess.run([*COMMAND, str(large), "-o", str(tmp_path / "b.ncq")], check=True, stderr=end)
    os.close(end)
    listener.join(10)
    assert b"%" in b"".join(seen)
