"""The drive kernel against a plain reference, and the faults one by one."""

from __future__ import annotations

from math import exp

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nccompile import kernels
from nccompile.errors import RuntimeFault
from nccompile.runtime.drives.protocol import ALL_CHECKS, NO_ACCELERATION_CHECK, NO_CHECKS, FaultCode
from nccompile.runtime.drives.virtual import VirtualDrives
from nccompile.toolpath.columns import Floats
from tests.runtime.recorder import machine

T = 0.001
LAG = 0.009
LIMITED = machine("XY", lag=LAG, axis_more="min = -1\nmax = 1\n")  # travel limits on Y


def reference(path: Floats, start: Floats, lag: float) -> tuple[Floats, tuple[int, int, FaultCode] | None]:
    """Actual positions and the first fault (cycle, axis, code), with whole-array arithmetic."""
    velocity = np.diff(path, axis=0, prepend=start[None, :]) / T
    steps = np.diff(velocity, axis=0, prepend=np.zeros((1, path.shape[1])))
    keep = exp(-T / lag)
    actual = np.empty_like(path)
    for axis in range(path.shape[1]):
        at = start[axis]
        for j in range(len(path)):
            at = path[j, axis] - (path[j, axis] - at) * keep
            actual[j, axis] = at
    wrong = [
        (FaultCode.TRAVEL, (np.abs(path) > 1 + 1e-9) & (np.arange(path.shape[1]) == 1)),
        (FaultCode.VELOCITY, np.abs(velocity) > 200 * (1 + 1e-6) + 1e-6),
        (FaultCode.ACCELERATION, np.abs(steps) > (2000 * T + 5) * (1 + 1e-6) + 2e-6),
        (FaultCode.FOLLOWING_ERROR, np.abs(path - actual) > 2 + 1e-9),
    ]
    any_wrong = np.logical_or.reduce([w for _, w in wrong])
    if not any_wrong.any():
        return actual, None
    cycle, axis = divmod(int(np.argmax(any_wrong)), path.shape[1])
    return actual, (cycle, axis, next(code for code, w in wrong if w[cycle, axis]))


def drives() -> VirtualDrives:
    made = VirtualDrives(LIMITED, ("X", "Y"))
    made.power(True)
    return made


@settings(max_examples=80, deadline=None)
@given(st.integers(0, 2**32 - 1), st.sampled_from([0.5, 3.0, 7.5]), st.sampled_from([30.0, 150.0, 205.0]))
def test_the_kernel_equals_a_plain_reference(seed: int, jolt: float, top: float) -> None:
    """Random walks of velocity, some within all limits and some not."""
    rng = np.random.default_rng(seed)
    velocity = np.clip(np.cumsum(rng.uniform(-jolt, jolt, (200, 2)), axis=0), -top, top)
    start = rng.uniform(-0.5, 0.5, 2)
    path = start + np.cumsum(velocity, axis=0) * T
    made, actual = drives(), np.zeros((200, 2))
    made.reset(start)
    done, fault = made.step(path, actual, ALL_CHECKS)
    wanted, expected = reference(path, start, LAG)
    if expected is None:
        assert (done, fault) == (200, None)
    else:
        assert fault is not None
        assert (done - 1, fault.axis, fault.code) == expected
    np.testing.assert_allclose(actual[:done], wanted[:done], rtol=0, atol=1e-9)


@pytest.mark.parametrize("compiled", [False, True])
def test_compiled_and_plain_give_the_same_bits(compiled: bool) -> None:
    before = kernels.compiled()
    path = np.cumsum(np.random.default_rng(3).uniform(-4e-3, 4e-3, (500, 2)), axis=0)
    results = []
    try:
        for switch in (False, compiled):
            kernels.use(compiled=switch)
            made, actual = drives(), np.zeros((500, 2))
            made.reset(np.zeros(2))
            results.append((made.step(path, actual, ALL_CHECKS), actual))
    finally:
        kernels.use(compiled=before)
    assert results[0][0] == results[1][0]
    np.testing.assert_array_equal(results[0][1], results[1][1])


def ramp(top: float, cycles: int, step: float = 2.0) -> Floats:
    """Set positions of X speeding up by `step` a cycle to `top`; Y stands."""
    velocity = np.minimum(np.arange(1, cycles + 1) * step, top)
    return np.column_stack([np.cumsum(velocity) * T, np.zeros(cycles)])


@pytest.mark.parametrize(
    ("path", "code", "cycle", "value", "limit"),
    [
        (ramp(300, 200), FaultCode.VELOCITY, 100, 202, 200),
        (ramp(100, 200, step=7.5), FaultCode.ACCELERATION, 0, 7500, 7000),
        (np.column_stack([np.zeros(300), ramp(5, 300)[:, 0]]), FaultCode.TRAVEL, 200, 1.001, 1),
        (np.column_stack([np.zeros(300), -ramp(5, 300)[:, 0]]), FaultCode.TRAVEL, 200, -1.001, -1),
    ],
)
def test_each_limit_faults_in_its_cycle(
    path: Floats, code: FaultCode, cycle: int, value: float, limit: float
) -> None:
    made, actual = drives(), np.zeros((len(path), 2))
    made.reset(np.zeros(2))
    done, fault = made.step(path, actual, ALL_CHECKS)
    assert fault is not None
    assert (done - 1, fault.code) == (cycle, code)
    assert fault.limit == pytest.approx(limit)
    assert fault.value == pytest.approx(value)


def test_following_error_is_velocity_times_lag() -> None:
    made = VirtualDrives(machine("XY", lag=LAG), ("X", "Y"))
    made.power(True)
    path = ramp(100, 400)
    actual = np.zeros_like(path)
    assert made.step(path, actual, ALL_CHECKS) == (400, None)
    assert path[-1, 0] - actual[-1, 0] == pytest.approx(100 * LAG, abs=0.6 * 100 * T)  # half a cycle less


def test_following_error_faults() -> None:
    """No velocity the axis may have faults it (the model sees to that): a step with the other checks off does."""
    made = drives()
    made.reset(np.zeros(2))
    path = np.array([[2.0, 0.0], [4.5, 0.0]])
    done, fault = made.step(path, np.zeros((2, 2)), int(FaultCode.FOLLOWING_ERROR))
    keep = exp(-T / LAG)
    assert fault is not None
    assert (done, fault.axis, fault.code, fault.limit) == (2, 0, FaultCode.FOLLOWING_ERROR, 2)
    assert fault.value == pytest.approx((2 * keep + 2.5) * keep)


def test_a_step_of_the_set_position_faults_on_what_is_watched() -> None:
    path, actual = np.array([[5.0, 0.0]]), np.zeros((1, 2))
    seen = []
    for watch in (
        ALL_CHECKS,
        NO_ACCELERATION_CHECK & ~FaultCode.VELOCITY,
        int(FaultCode.ACCELERATION),
        NO_CHECKS,
    ):
        made = drives()
        made.reset(np.zeros(2))
        _, fault = made.step(path, actual, watch)
        seen.append(None if fault is None else fault.code)
    assert seen == [FaultCode.VELOCITY, FaultCode.FOLLOWING_ERROR, FaultCode.ACCELERATION, None]


def test_a_faulted_axis_brakes_and_the_others_follow() -> None:
    made, path = drives(), ramp(202, 140)
    actual = np.zeros_like(path)
    done, fault = made.step(path, actual, ALL_CHECKS)
    assert fault is not None
    further = np.column_stack([np.full(200, 50.0), np.full(200, 0.5)])
    after = np.zeros_like(further)
    made.step(further, after, NO_CHECKS)
    x = np.diff(np.concatenate([actual[done - 2 : done, 0], after[:, 0]])) / T
    assert np.all(np.abs(np.diff(x)[1:]) <= 2000 * T + 1e-9)  # by its acceleration, whatever is set
    assert x[-1] == 0
    assert after[-1, 1] == pytest.approx(0.5)


def test_a_drive_without_lag_follows_at_once() -> None:
    made = VirtualDrives(machine("XY", lag=0), ("X", "Y"))
    made.power(True)
    path = ramp(100, 50)
    actual = np.zeros_like(path)
    made.step(path, actual, ALL_CHECKS)
    np.testing.assert_array_equal(actual, path)


def test_drives_without_power_refuse() -> None:
    made = VirtualDrives(LIMITED, ("X", "Y"))
    with pytest.raises(RuntimeFault, match="without power"):
        made.step(np.zeros((1, 2)), np.zeros((1, 2)))
