"""Machine code from the cache folder: the same results, without numba, and no code that is in doubt."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

PROGRAM = """
import sys
import numpy as np
from nccompile.kernels import native, use
from nccompile.kernels.arcs import by_centre, distance
from nccompile.kernels.plan import durations
from nccompile.kernels.timelaw import law_times

use(compiled=True)
row = np.zeros(5)
print(by_centre(0.0, 0.0, 1.0, 1.0, 1.0, 0.0, True, 1e-9, 0.01, 0.001, 0.5, row), row.tolist(), distance(3.0, 4.0))
print(law_times(10.0, 0.0, 5.0, 0.0, 100.0, 100.0))
ones, out = np.ones(3), np.empty(3)
print(durations(np.ones(3, np.uint8), ones, ones, ones, np.zeros(3), ones, ones, 0.0, out), out.tolist())
print("numba" in sys.modules, file=sys.stderr)
"""


def run(cache: Path) -> tuple[str, bool]:
    """What the program prints, and whether it needed numba."""
    env = {**os.environ, "NCCOMPILE_CACHE": str(cache)}
    env.pop("NUMBA_CACHE_DIR", None)
    command = [sys.executable, "-c", PROGRAM]
    done = subprocess.run(command, env=env, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout, done.stderr.strip().endswith("True")


@pytest.fixture(scope="module")
def cache(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    folder = tmp_path_factory.mktemp("cache")
    printed, with_numba = run(folder)
    assert with_numba
    return folder, printed


def test_a_second_process_runs_the_kept_code_without_numba(cache: tuple[Path, str]) -> None:
    assert run(cache[0]) == (cache[1], False)


def test_code_of_another_processor_or_damaged_code_is_left_alone(cache: tuple[Path, str]) -> None:
    files = sorted(cache[0].rglob("*.native"))
    assert len(files) == 4
    head, _, code = files[0].read_bytes().partition(b"\n")
    form = json.loads(head)
    form["platform"][3] = "z80"
    files[0].write_bytes(json.dumps(form).encode() + b"\n" + code)
    files[1].write_bytes(b"{")
    files[2].write_bytes(files[2].read_bytes()[:-100])
    assert run(cache[0]) == (cache[1], True)
