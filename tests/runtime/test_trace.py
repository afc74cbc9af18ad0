"""Trace files: every cycle, to the bit, the same bytes for the same run, whole or not there."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from nccompile.errors import QueueError, UsageError
from nccompile.runtime.task import CyclicTask
from nccompile.runtime.trace import open_trace
from nccompile.toolpath.columns import Kind, Toolpath
from tests.runtime.paths import planned
from tests.runtime.recorder import Recorder, machine, run

COLUMNS = [
    "t", "set_X", "set_Y", "set_Z", "act_X", "act_Y", "act_Z", "v", "line", "status", "switches", "gap",
]  # fmt: skip


def path() -> Toolpath:
    return planned(
        [[3, 1, 0], [9, 2, 1 / 3], [9, 5, 0]],
        kinds=[Kind.LINE, Kind.SET_POSITION, Kind.LINE],
        events=[(0, 0, 32, 0.5, 0.0, 0.0, -1)],
    )


def written(file: Path) -> Recorder:
    with open_trace(file) as trace:
        CyclicTask([path()], machine(), trace=trace).run()
    return run([path()])[1]


def columns(kept: Recorder) -> dict[str, list[float]]:
    tables = {f"{p}_{a}": kept.column(n)[:, i].tolist() for p, n in (("set", "setpoints"), ("act", "actual"))
              for i, a in enumerate("XYZ")}  # fmt: skip
    names = {"v": "velocity", "line": "line", "status": "status", "switches": "switches"}
    gap = kept.gap.astype(int).tolist()
    return {**tables, **{k: kept.column(n).tolist() for k, n in names.items()}, "gap": gap}


def test_csv_reads_back_to_the_same_bits(tmp_path: Path) -> None:
    kept = written(tmp_path / "t.csv")
    with (tmp_path / "t.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0]) == COLUMNS
    for name, values in columns(kept).items():
        assert [float(row[name]) for row in rows] == values
    assert [row["t"] for row in rows[:2]] == ["0.000000", "0.001000"]
    assert float(rows[-1]["t"]) == pytest.approx((len(rows) - 1) * 0.001)
    assert max(int(row["switches"]) for row in rows) == 2**31


def test_npz_reads_back_to_the_same_bits(tmp_path: Path) -> None:
    kept = written(tmp_path / "t.npz")
    with np.load(tmp_path / "t.npz") as file:
        assert list(file) == COLUMNS
        for name, values in columns(kept).items():
            assert file[name].tolist() == values
        np.testing.assert_allclose(file["t"], np.arange(len(file["t"])) * 0.001, rtol=1e-15)


@pytest.mark.parametrize("suffix", ["csv", "npz"])
def test_equal_runs_give_equal_bytes(tmp_path: Path, suffix: str) -> None:
    for name in "ab":
        written(tmp_path / f"{name}.{suffix}")
    assert (tmp_path / f"a.{suffix}").read_bytes() == (tmp_path / f"b.{suffix}").read_bytes()


@pytest.mark.parametrize("suffix", ["csv", "npz"])
def test_a_run_that_breaks_leaves_no_file(tmp_path: Path, suffix: str) -> None:
    def broken() -> Iterator[Toolpath]:
        yield path()
        raise QueueError("damaged")

    with pytest.raises(QueueError), open_trace(tmp_path / f"t.{suffix}") as trace:
        CyclicTask(broken(), machine(), trace=trace).run()
    assert list(tmp_path.iterdir()) == []


def test_a_run_without_a_path_leaves_an_empty_trace(tmp_path: Path) -> None:
    for suffix in ("csv", "npz"):
        with open_trace(tmp_path / f"t.{suffix}") as trace:
            CyclicTask([], machine(), trace=trace).run()
    assert (tmp_path / "t.csv").read_bytes() == b""
    with np.load(tmp_path / "t.npz") as file:
        assert list(file) == []


def test_other_suffixes_are_refused(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"a trace is \.csv or \.npz"), open_trace(tmp_path / "t.xlsx"):
        pass
