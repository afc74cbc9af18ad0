"""Commands at times: what is understood, what is refused, when they act."""

from __future__ import annotations

import numpy as np
import pytest

from nccompile.errors import UsageError
from nccompile.runtime.interpolator import Inputs
from nccompile.runtime.schedule import Command, Schedule, parse_command


@pytest.mark.parametrize(
    ("text", "command"),
    [
        ("2.5s override=0.5", Command(2.5, "override", 0.5)),
        ("3 slow_stop=on", Command(3.0, "slow_stop", True)),
        ("  800 ms  vel_mode = Sigmoid ", Command(0.8, "vel_mode", 1)),
        ("1e-1s quick_stop=0", Command(0.1, "quick_stop", False)),
        ("0s quick_deceleration=2000", Command(0.0, "quick_deceleration", 2000.0)),
        ("1s ack_m=TRUE", Command(1.0, "ack_m", True)),
    ],
)
def test_commands_are_read(text: str, command: Command) -> None:
    assert parse_command(text) == command


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("override=0.5", "expected TIME INPUT=VALUE"),
        ("2.5s override", "expected TIME INPUT=VALUE"),
        ("1.2.3s override=1", '"1.2.3" in "1.2.3s override=1" is not a number from 0 to 1e+09 seconds'),
        ("9e99s abort=1", "is not a number from 0 to 1e+09 seconds"),
        (
            "1s overide=1",
            '"overide" in "1s overide=1" is not an input of the interpolator; the inputs are slow_stop,',
        ),
        ("1s override=0", '"0" in "1s override=0" is not a number from 0.01 to 10'),
        ("1s override=nan", '"nan" in "1s override=nan" is not a number from 0.01 to 10'),
        ("1s override=fast", "is not a number"),
        ("1s slow_stop=maybe", '"maybe" in "1s slow_stop=maybe" is not one of on, true, 1, off, false, 0'),
        ("1s vel_mode=3", "is not one of trapezoid, 0, sigmoid, 1, parabolic, 2"),
    ],
)
def test_everything_else_is_refused(text: str, said: str) -> None:
    with pytest.raises(UsageError) as caught:
        parse_command(text)
    assert said in str(caught.value)


def test_commands_act_at_the_first_cycle_not_before_their_time() -> None:
    schedule = Schedule([Command(0.003, "override", 0.3), Command(0.0015, "slow_stop", True)])
    inputs, acted = Inputs(), []
    for cycle in range(6):
        wait = schedule.cycles_until_next(cycle, 0.001)
        taken = schedule.take(cycle, 0.001, inputs)
        assert (wait == 0) == bool(taken)
        acted += [(cycle, c.name) for c in taken]
    assert acted == [(2, "slow_stop"), (3, "override")]
    assert (inputs.slow_stop, inputs.override) == (True, 0.3)
    assert schedule.is_done
    assert schedule.cycles_until_next(9, 0.001) is None


def test_whole_numbers_of_cycles_are_hit_whatever_the_rounding() -> None:
    for n in np.random.default_rng(1).integers(0, 10**8, 500).tolist():
        assert Schedule([Command(n * 0.0007, "abort", True)]).cycles_until_next(0, 0.0007) == n


def test_equal_times_keep_their_order() -> None:
    inputs = Inputs()
    Schedule([Command(0.0, "override", 0.3), Command(0.0, "override", 0.4)]).take(0, 0.001, inputs)
    assert inputs.override == 0.4
