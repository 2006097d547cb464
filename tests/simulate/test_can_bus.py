"""Messages on a CAN bus against arbitration by hand, and against the response times of Davis, Burns, Bril and Lukkien (2007)."""

import json

import pytest
from effort import every
from support import SHARED

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.distributions import Uniform
from amalthea_uros.perf.stimuli import Periodic
from amalthea_uros.perf.system import System
from amalthea_uros.simulate.options import Mode, Options
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import MILLISECOND as MS
from amalthea_uros.units import NANOSECOND as NS
from amalthea_uros.units import SECOND, Duration
from amalthea_uros.uros.network.classic_bus import BusTransmission, with_bus
from amalthea_uros.uros.transports.can import CanBus


def message(name, identifier, frames, offset=0, period=SECOND, jitter=0):
    """A message whose frames have a number of data bytes each."""
    return BusTransmission(
        name=name,
        frames=[(data, data) for data in frames],
        identifier=identifier,
        stimulus=Periodic(
            name=f"queues {name}", period=period, offset=offset, jitter=Uniform(lower=0, upper=jitter) if jitter else None
        ),
    )


def simulated(messages, duration=100 * MS, mode=Mode.WORST, bit_rate=1_000_000):
    return simulate_system(
        with_bus(System(), CanBus(bit_rate=bit_rate), messages), Options(duration=Duration(duration), mode=mode)
    )


def response_times(messages, **options):
    found = simulated(messages, **options)
    return {each.name: found[each.name].response_time.max for each in messages}


# A frame with 8 data bytes has 135 bits with all stuff bits: 135 us at 1 Mbit/s.


def test_the_lowest_identifier_wins_before_each_frame_and_no_frame_is_interrupted():
    found = response_times(
        [
            message("two frames", 9, [8, 8]),
            message("lost twice", 5, [8], offset=50 * US),
            message("wins", 3, [8], offset=50 * US),
        ]
    )
    # The first frame is on the bus until 135, then "wins" until 270, then "lost twice" until 405.
    assert found == {"two frames": 540 * US, "lost twice": 355 * US, "wins": 220 * US}


def test_messages_with_the_same_identifier_are_sent_in_the_order_in_which_they_were_queued():
    found = response_times([message("second", 1, [8], offset=10 * US), message("first", 1, [8, 8])])
    assert found == {"first": 270 * US, "second": 395 * US}


def test_a_message_that_is_queued_again_before_it_is_sent_is_not_lost():
    found = simulated([message("long", 1, [8] * 20), message("often", 2, [8], period=MS)], duration=10 * MS)
    # 20 frames take 2.7 ms: "often" is queued three times, and sent up to 3.105 ms.
    assert found["often"].response_time.max == (2700 + 135) * US
    assert found["often"].lost_activations == 0


def test_the_bus_is_a_core_with_the_load_of_its_frames():
    found = simulated([message("every 10 ms", 1, [8, 8, 8], period=10 * MS)], duration=SECOND, bit_rate=250_000)
    # 3 frames of 540 us.
    assert float(found.cores["CAN"].load) == 0.162


def test_frames_without_stuff_bits_are_shortest():
    found = response_times([message("one", 1, [8])], mode=Mode.BEST)
    assert found["one"] == (34 + 64 + 13) * US


def can_vectors(accept=lambda case: True):
    path = SHARED / "vectors" / "rta_random.json"
    if not path.exists():
        return [pytest.param(None, marks=pytest.mark.skip("the vectors are not at hand"))]
    cases = json.loads(path.read_text())["cases"]
    accepted = [case for case in cases if case["scheduling"].startswith("can") and accept(case)]
    return [pytest.param(case, id=case["id"]) for case in every(5, accepted)]


def messages_of(case, offsets):
    return [
        message(
            task["name"],
            task["priority"],
            [task["payload_bytes"]],
            offset=offsets.get(task["name"], 0),
            period=task["period"] * NS,
            jitter=task["jitter"] * NS,
        )
        for task in case["tasks"]
    ]


def bus_of(case, offsets=None):
    return with_bus(System(), CanBus(bit_rate=SECOND // (case["bit_time"] * NS)), messages_of(case, offsets or {}))


@pytest.mark.parametrize("mode", [Mode.WORST, Mode.SAMPLED])
@pytest.mark.parametrize("case", can_vectors())
def test_no_message_takes_longer_than_independent_analyses_say(case, mode):
    system = bus_of(case)
    bounds = dict(zip((task["name"] for task in case["tasks"]), case["expected_wcrt"], strict=True))
    found = simulate_system(system, Options(duration=Duration(SECOND), mode=mode))
    assert {name: found[name].response_time.max <= bound * NS for name, bound in bounds.items()} == dict.fromkeys(bounds, True)
    analysis = analyze_system(system)
    # Their analysis counts messages that are queued up to a bit time after the start of a frame, ours does not.
    assert all(found[name].response_time.max <= analysis.processes[name].response.worst <= bounds[name] * NS for name in bounds)


def has_no_jitter(case):
    return not any(task["jitter"] for task in case["tasks"])


@pytest.mark.parametrize("case", can_vectors(has_no_jitter))
def test_the_worst_case_is_reached_where_all_are_queued_just_after_the_longest_frame_of_lower_priority(case):
    tasks = case["tasks"]
    shortest = min(task["period"] for task in tasks)
    for number, (task, bound) in enumerate(zip(tasks, case["expected_wcrt"], strict=True)):
        # In a busy period that is shorter than all periods, each message interferes once.
        if bound <= shortest:
            blocking = max(tasks[number + 1 :], key=lambda other: other["wcet"], default=None)
            offsets = {other["name"]: 1 for other in tasks if other is not blocking} if blocking else {}
            found = simulate_system(bus_of(case, offsets), Options(duration=Duration(2 * bound * NS), mode=Mode.WORST))
            assert found[task["name"]].response_time.max == bound * NS - (1 if blocking else 0)
