"""When a pressure was held, from steps and from logs made up with known plateaus."""

import numpy as np
import pytest

from spavision.errors import InputError
from spavision.vision.holds import Hold, first_holds, pressure_holds


def test_rows_with_pressures_of_their_own_are_steps():
    holds = pressure_holds(np.array([0.0, 4.0, 9.5]), np.array([0.0, 5.0, 10.0]))
    assert holds == [Hold(0.0, 4.0, 0.0), Hold(4.0, 9.5, 5.0), Hold(9.5, np.inf, 10.0)]


def test_a_log_at_10_Hz_gives_its_plateaus_and_no_ramp():
    # 6 s at 0, 5 and 10 kPa, with ramps of 2 s between; noise of the sensor 0.03 kPa.
    time_s = np.arange(0, 22, 0.1)
    pressure = np.interp(time_s, [0, 6, 8, 14, 16, 22], [0, 0, 5, 5, 10, 10])
    pressure += np.random.default_rng(1).normal(0, 0.03, len(time_s))
    holds = pressure_holds(time_s, pressure)
    assert [round(hold.pressure_kPa) for hold in holds] == [0, 5, 10]
    for hold, (start, end) in zip(holds, [(0, 6), (8, 14), (16, 22)], strict=True):
        # A ramp of 2.5 kPa/s is within the tolerance of 0.5 kPa for 0.2 s.
        assert (hold.start_s, hold.end_s) == pytest.approx((start, end), abs=0.31)
        assert hold.pressure_kPa == pytest.approx(round(hold.pressure_kPa), abs=0.03)


def test_a_slow_leak_stays_one_hold():
    time_s = np.arange(0.0, 20.0, 0.5)
    holds = pressure_holds(time_s, 10.0 - 0.04 * time_s)
    assert len(holds) == 1
    assert (holds[0].start_s, holds[0].end_s) == (0.0, 19.5)


def test_of_holds_at_one_pressure_the_first_is_kept_and_the_rest_are_told():
    holds = [Hold(0, 1, 0.0), Hold(1, 2, 5.0), Hold(2, 3, 0.1)]
    assert first_holds(holds) == (holds[:2], [0.1])


@pytest.mark.parametrize(
    ("time_s", "pressure_kPa", "message"),
    [
        ([0.0, 2.0, 2.0], [0.0, 5.0, 10.0], "row 4"),
        ([-1.0, 2.0], [0.0, 5.0], "row 2"),
        (np.arange(0, 5, 0.1), np.arange(0, 5, 0.1) * 4, "no pressure that stays"),
    ],
)
def test_tables_without_holds_are_refused(time_s, pressure_kPa, message):
    with pytest.raises(InputError, match=message):
        pressure_holds(np.asarray(time_s, dtype=float), np.asarray(pressure_kPa, dtype=float))
