"""The cyclic task end to end on virtual drives: motion, stops, M functions, jumps, faults, shortage, real time."""

from __future__ import annotations

import json
from collections.abc import Iterator
from time import sleep

import numpy as np
import pytest

from nccompile import kernels
from nccompile.backend.samples import sample
from nccompile.errors import QueueError
from nccompile.machine.model import Machine
from nccompile.runtime.axes import AxisState
from nccompile.runtime.interpolator import Status
from nccompile.runtime.schedule import parse_command
from nccompile.runtime.task import CyclicTask, Options
from nccompile.toolpath.columns import Floats, Kind, Toolpath
from tests.runtime.paths import planned
from tests.runtime.recorder import Recorder, machine, run

SWITCH, M, DWELL = 0, 1, 2
ON_4, OFF_4 = (0, SWITCH, 4, 0.25, 0.0, 0.0, -1), (1, SWITCH, -4, 0.5, 0.0, 0.0, -1)
M_7 = (2, M, 7, 0.0, 1.5, -2.5, 0)


def bracket() -> Toolpath:
    """Two lines with a switch on and off, an M function, a line, a dwell of 50 ms, a line back."""
    return planned(
        [[10, 0, 0], [10, 10, 0], [10, 10, 0], [20, 10, 0], [20, 10, 0], [0, 0, 0]],
        kinds=[Kind.LINE, Kind.LINE, Kind.M_FUNCTION, Kind.LINE, Kind.DWELL, Kind.LINE],
        events=[ON_4, OFF_4, M_7, (4, DWELL, 0, 0.0, 0.05, 0.0, -1)],
        names=("clamp",),
    )


def jumping() -> Toolpath:
    """A line, a jump of the position, a line."""
    return planned(
        [[10, 0, 0], [40, 20, -5], [50, 20, -5]], kinds=[Kind.LINE, Kind.SET_POSITION, Kind.LINE], accel=500
    )


def offline(path: Toolpath) -> Floats:
    return np.concatenate([block.position for block in sample([path], 0.001)])


def test_set_positions_equal_the_offline_samples_to_the_bit() -> None:
    report, trace = run([bracket()])
    np.testing.assert_array_equal(trace.column("setpoints"), offline(bracket()))
    assert (report.outcome, report.faults, report.underruns) == ("finished", [], 0)
    assert report.cycles == len(offline(bracket()))
    assert report.job_time == pytest.approx((report.cycles - 1) * 0.001)
    assert report.end_position == {"X": 0.0, "Y": 0.0, "Z": 0.0}


def test_chunks_and_queue_size_do_not_change_the_motion() -> None:
    whole = run([bracket()])[1].column("setpoints")
    rows = [bracket().rows(i, i + 1) for i in range(6)]
    tiny = machine(more="[runtime]\nqueue = 2\nlow_water = 1\n")
    np.testing.assert_array_equal(run(rows, tiny)[1].column("setpoints"), whole)
    np.testing.assert_array_equal(run(iter(rows), machine())[1].column("setpoints"), whole)


def test_peaks_are_those_of_the_trace() -> None:
    report, trace = run([bracket()])
    path = trace.column("setpoints")
    velocity = np.diff(path, axis=0, prepend=path[:1]) / 0.001
    steps = np.abs(np.diff(velocity, axis=0, prepend=0 * velocity[:1])).max(axis=0)
    for i, axis in enumerate(report.axes):
        assert axis.axis == "XYZ"[i]
        assert axis.peak_velocity == pytest.approx(np.abs(velocity[:, i]).max())
        assert axis.velocity_ratio == pytest.approx(axis.peak_velocity / 200)
        assert axis.peak_acceleration == pytest.approx(steps[i] / 0.001)
        assert axis.acceleration_ratio == pytest.approx(steps[i] / (2000 * 0.001 + 5))
        errors = np.abs(path - trace.column("actual"))[:, i]
        assert axis.max_following_error == pytest.approx(errors.max())
        assert axis.end_position == path[-1, i]


def test_switches_and_m_functions_are_logged() -> None:
    report, trace = run([bracket()], None, options=Options(m_delay=0.02))
    on, off = report.switches.entries
    assert [(s.number, s.line) for s in (on, off)] == [(4, 1), (-4, 2)]
    path, switches = trace.column("setpoints"), trace.column("switches")
    for entry, reached in ((on, path[:, 0] >= 2.5 - 1e-9), (off, path[:, 1] >= 5 - 1e-9)):
        cycle = round(entry.time / 0.001)
        assert cycle == int(np.argmax(reached))
        assert entry.position == tuple(path[cycle])
    assert [round(s.time / 0.001) for s in (on, off)] == np.flatnonzero(np.diff(switches, prepend=0)).tolist()
    (m,) = report.m_functions.entries
    assert (m.number, m.k, m.l, m.o, m.line) == (7, 1.5, -2.5, "clamp", 3)
    assert m.waited == pytest.approx(0.021)  # the delay, and the cycle that acknowledges
    assert report.cycles == len(offline(bracket())) + 20


def test_an_m_function_waits_for_a_scripted_acknowledge() -> None:
    script = Options(m_delay=None, commands=[parse_command("2s ack_m=1")])
    report, _ = run([bracket()], options=script)
    (m,) = report.m_functions.entries
    assert report.outcome == "finished"
    assert m.time + m.waited == pytest.approx(2.0)


def test_an_m_function_that_nobody_acknowledges_ends_the_run() -> None:
    report, _ = run([bracket()], options=Options(m_delay=None, file="part.nc"))
    assert report.outcome == "stopped"
    (finding,) = report.diagnostics
    assert (finding.code, finding.span.line, finding.file) == ("NC706", 3, "part.nc")
    assert report.end_position == {"X": 10.0, "Y": 10.0, "Z": 0.0}
    assert report.m_functions.count == 1


def test_consecutive_m_functions_are_acknowledged_one_by_one() -> None:
    path = planned(
        [[0, 0, 0]] * 3, kind=Kind.M_FUNCTION, events=[(i, M, 10 + i, 0.0, 0.0, 0.0, -1) for i in range(3)]
    )
    report, _ = run([path], options=Options(m_delay=0.004))
    assert [m.number for m in report.m_functions.entries] == [10, 11, 12]
    assert [m.waited for m in report.m_functions.entries] == pytest.approx([0.005] * 3)


COMMANDS = {
    "override": ["100ms override=0.3", "1s override=2"],
    "slow stop": ["123ms slow_stop=1", "600ms slow_stop=0"],
    "quick stop": ["123ms quick_stop=1", "600ms quick_stop=0"],
    "emergency stop": ["123ms emergency_stop=1", "600ms emergency_stop=0"],
    "wait at next stop": ["50ms wait_at_next_stop=1", "600ms wait_at_next_stop=0"],
    "single step": ["50ms single_step=1"],
    "sigmoid": ["0s vel_mode=sigmoid"],
}


@pytest.mark.parametrize("commands", COMMANDS.values(), ids=COMMANDS)
def test_commands_act_in_their_cycle_whatever_the_burst(commands: list[str]) -> None:
    """Bursts of one cycle are the definition of what has to happen."""
    parsed = [parse_command(text) for text in commands]
    runs = [run([bracket()], options=Options(commands=parsed, burst=b))[1] for b in (1, 37, 4096)]
    for name in ("setpoints", "actual", "velocity", "line", "status", "switches"):
        first = runs[0].column(name)
        for other in runs[1:]:
            np.testing.assert_array_equal(other.column(name), first)
    np.testing.assert_array_equal(runs[0].column("setpoints")[-1], [0, 0, 0])


def test_a_stop_that_nobody_releases_ends_the_run_where_it_stands() -> None:
    parsed = [parse_command("100ms slow_stop=1")]
    lengths = set()
    for burst in (1, 4096):
        report, trace = run([bracket()], options=Options(commands=parsed, burst=burst))
        assert report.outcome == "stopped"
        assert [d.code for d in report.diagnostics] == ["NC705"]
        assert report.diagnostics.errors == 0
        lengths.add(report.cycles)
        velocity = trace.column("velocity")
        assert velocity[-1] == 0
        assert velocity[-2] > 0  # the first cycle at rest is the last of the run
    assert len(lengths) == 1


def test_abort_gives_the_path_up() -> None:
    report, trace = run([bracket()], None, "100ms abort=1")
    assert report.outcome == "aborted"
    assert len(trace.column("velocity")) == 101
    assert report.faults == []


def test_a_jump_is_bridged_within_the_limits_of_each_axis() -> None:
    report, trace = run([jumping()])
    assert report.faults == []
    path, gap = trace.column("setpoints"), trace.gap
    np.testing.assert_array_equal(path[~gap], offline(jumping()))  # only cycles were put in between
    assert 100 < gap.sum() < 300
    assert set(trace.column("status")[gap]) == {Status.WAIT}
    velocity = np.diff(path, axis=0) / 0.001
    assert np.abs(velocity).max() <= 200 * (1 + 1e-9)
    assert np.abs(np.diff(velocity, axis=0)).max() <= 2000 * 0.001 * (1 + 1e-6)
    arrival = [int(np.argmax(np.abs(path[:, i] - end) < 1e-9)) for i, end in enumerate((40, 20, -5))]
    assert arrival[2] < arrival[1] < arrival[0]  # each as fast as it can


def test_an_axis_at_home_runs_to_the_start_first() -> None:
    home = machine(axis_more="home = 30\n")
    report, trace = run([bracket()], home)
    path, gap = trace.column("setpoints"), trace.gap
    assert gap[0]
    assert not gap[gap.argmin() :].any()
    assert 29.9 < path[0, 2] < 30
    assert np.all(np.diff(path[gap, 2]) < 0)
    np.testing.assert_array_equal(path[~gap], offline(bracket()))
    assert report.axes[2].max_following_error > 0


def test_gantry_offsets_shift_the_axes_not_the_path() -> None:
    shifted = machine(more="[kinematics]\noffset = { X = 100, Z = -0.5 }\n")
    report, trace = run([bracket()], shifted)
    np.testing.assert_array_equal(trace.column("setpoints"), np.add(offline(bracket()), [100, 0, -0.5]))
    assert report.end_position == {"X": 0.0, "Y": 0.0, "Z": 0.0}
    assert report.axes[0].end_position == 100


def test_an_axis_the_machine_lacks_is_left_out() -> None:
    report, trace = run([bracket()], machine("XY"))
    assert trace.axes == ("X", "Y")
    np.testing.assert_array_equal(trace.column("setpoints"), offline(bracket())[:, :2])
    assert [axis.axis for axis in report.axes] == ["X", "Y"]


def fault_cases() -> dict[str, tuple[Machine, Toolpath, str, str, int]]:
    """Machine, path, code, axis and source line of the fault."""
    return {
        "velocity": (machine(velocity=45), bracket(), "NC701", "X", 1),
        "acceleration": (machine(step=0, acceleration=900), bracket(), "NC702", "X", 1),
        "travel": (machine("ZXY", axis_more="max = 6\n"), bracket(), "NC703", "Y", 2),
        "travel in a jump": (machine(axis_more="min = -1\n"), jumping(), "NC703", "Z", 2),
    }


@pytest.mark.parametrize("case", fault_cases().values(), ids=fault_cases())
def test_a_fault_brakes_everything_and_is_reported(case: tuple[Machine, Toolpath, str, str, int]) -> None:
    on, path, code, letter, line = case
    runs = []
    for burst in (1, 50, 4096):
        trace = Recorder()
        task = CyclicTask([path], on, Options(burst=burst, file="part.nc"), trace=trace)
        report = task.run()
        assert report.outcome == "fault"
        (fault,), (finding,) = report.faults, report.diagnostics
        assert (fault.axis, fault.line) == (letter, line)
        assert (finding.code, finding.span.line, finding.file) == (code, line, "part.nc")
        assert f"axis {letter} faulted at {fault.time:g} s" in finding.message
        states = {axis.letter: axis.state for axis in task.output.axes.axes}
        assert states.pop(letter) is AxisState.ERRORSTOP
        assert set(states.values()) == {AxisState.STOPPING}
        runs.append(trace)
        actual = trace.column("actual")
        assert np.abs(np.diff(actual[-2:], axis=0)).max() / 0.001 <= 20  # stands, but for the lag
    for name in ("setpoints", "actual", "velocity", "status"):
        for other in runs[1:]:
            np.testing.assert_array_equal(other.column(name), runs[0].column(name))


def test_up_to_a_fault_the_motion_is_the_planned_one() -> None:
    report, trace = run([bracket()], machine(axis_more="", velocity=45))
    cycle = round(report.faults[0].time / 0.001)
    wanted = offline(bracket())
    np.testing.assert_array_equal(trace.column("setpoints")[: cycle + 1], wanted[: cycle + 1])
    assert np.diff(wanted[: cycle + 1, 0]).max() / 0.001 == pytest.approx(report.faults[0].value)
    assert np.diff(wanted[:cycle, 0]).max() / 0.001 <= 45


def test_a_queue_too_short_to_brake_in_slows_down_and_says_so() -> None:
    """Short segments that could be run at 50 mm/s: with two of them at hand it takes longer, exactly on path."""
    n = 300
    v_end = np.sqrt(2 * 300 * 0.01 * np.arange(n - 1, -1, -1.0)).clip(max=50.0)
    path = planned(np.arange(1, n + 1)[:, None] * [0.01, 0, 0], accel=300)
    path = path.replace(v_end=v_end, v_junction=np.full(n, 100.0))
    long, _ = run([path])
    short, trace = run([path], machine(more="[runtime]\nqueue = 2\nlow_water = 1\n"))
    assert (long.outcome, long.underruns) == ("finished", 0)
    assert short.outcome == "finished"
    assert short.underruns > 0
    assert [d.code for d in short.diagnostics] == ["NC707"]
    assert short.cycles > 2 * long.cycles
    x = trace.column("setpoints")[:, 0]
    assert np.all(np.diff(x) >= 0)
    assert x[-1] == path.target[-1, 0]


def test_real_time_puts_out_the_same_cycles() -> None:
    trace = Recorder()
    rows = [bracket().rows(i, i + 1) for i in range(6)]
    tiny = machine(more="[runtime]\nqueue = 3\n", cycle_us=500)
    report = CyclicTask(rows, tiny, Options(realtime=True), trace=trace).run()
    virtual = Recorder()
    CyclicTask(rows, tiny, trace=virtual).run()
    assert report.outcome == "finished"
    assert report.jitter is not None
    assert report.jitter.cycles == report.cycles == len(trace.column("velocity"))
    if report.underruns == 0:  # a computer that is busy elsewhere may let the feeder wait
        np.testing.assert_array_equal(trace.column("setpoints"), virtual.column("setpoints"))
    np.testing.assert_array_equal(trace.column("setpoints")[-1], [0, 0, 0])
    assert [m.number for m in report.m_functions.entries] == [7]
    assert [s.number for s in report.switches.entries] == [4, -4]


def test_real_time_reports_missed_deadlines() -> None:
    class Slow(Recorder):
        def write(self, cycles: object) -> None:
            if len(self.parts) == 20:
                sleep(0.005)
            super().write(cycles)  # type: ignore[arg-type]

    path = planned([[0.5, 0, 0]])
    report = CyclicTask([path], machine(), Options(realtime=True), trace=Slow()).run()
    assert report.jitter is not None
    assert report.jitter.overruns >= 1
    assert "NC708" in [d.code for d in report.diagnostics]
    assert report.cycles == len(offline(path))


@pytest.mark.parametrize("realtime", [False, True])
def test_errors_of_the_supply_come_through(realtime: bool) -> None:
    def broken() -> Iterator[Toolpath]:
        yield planned(np.arange(1, 13.0).reshape(4, 3))
        raise QueueError("chunk 1 is damaged")

    tiny = machine(more="[runtime]\nqueue = 2\n")
    with pytest.raises(QueueError, match="chunk 1 is damaged"):
        CyclicTask(broken(), tiny, Options(realtime=realtime)).run()


def test_no_path_and_an_empty_path_finish() -> None:
    assert run([])[0].cycles == 0
    report, trace = run([planned(np.zeros((0, 3)), [1, 2, 3])])
    assert report.outcome == "finished"
    assert {tuple(p) for p in trace.column("setpoints").tolist()} == {(1.0, 2.0, 3.0)}


def test_compiled_kernels_run_the_same_job() -> None:
    before = kernels.compiled()
    try:
        kernels.use(compiled=False)
        plain = run([bracket()])[1]
        kernels.use(compiled=True)
        compiled = run([bracket()])[1]
    finally:
        kernels.use(compiled=before)
    for name in ("setpoints", "actual", "velocity"):
        np.testing.assert_array_equal(plain.column(name), compiled.column(name))


def test_the_report_is_json() -> None:
    report, _ = run([bracket()])
    read = json.loads(report.to_json())
    assert (read["outcome"], read["cycles"], read["jitter"]) == ("finished", report.cycles, None)
    assert [s["number"] for s in read["switches"]] == [4, -4]
    assert read["m_functions"][0]["o"] == "clamp"
    assert read["axes"][0]["axis"] == "X"
    assert read["end_position"] == {"X": 0.0, "Y": 0.0, "Z": 0.0}
