"""The latencies of a chain through one label with each kind of communication, derived by hand."""

import pytest
from by_hand import built
from hand_made_systems import READ, WRITE, Proc, access, chain, ticks
from opponent.simulation import latencies, record

from amalthea_uros.perf.activities import Communication
from amalthea_uros.perf.events import ProcessChange, ProcessEvent
from amalthea_uros.perf.software import Label
from amalthea_uros.simulate.options import Options
from amalthea_uros.units import MICROSECOND as US

EVENTS = (
    ProcessEvent(name="begin", process="producer", change=ProcessChange.START),
    ProcessEvent(name="end", process="consumer", change=ProcessChange.TERMINATE),
)


@pytest.mark.parametrize(
    ("communication", "expected"),
    [
        # The consumer reads at 13 and 33; the producer has written at 11 and 31: the responses at 14 and 34 show 10 and 30.
        (
            Communication.EXPLICIT,
            {
                "reduced_data_age": (4, 4),
                "data_age": (24, 24),  # 34 - 10
                "reduced_reaction_time": (4, 14),  # 14 - 10, and 34 - 20
                "reaction_time": (14, 24),  # 14 - 0, and 34 - 10
                "last_to_first": (4, 4),
                "first_to_last": (24, 24),
            },
        ),
        # It reads at its start at 11 and 31; the jobs of 0 and 20 have ended at 7 and 27: 14 and 34 show 0 and 20.
        (
            Communication.IMPLICIT,
            {
                "reduced_data_age": (14, 14),
                "data_age": (34, 34),  # 34 - 0
                "reduced_reaction_time": (14, 24),  # 14 - 0, and 34 - 10
                "reaction_time": (24, 34),  # 34 - 10, and 34 - 0
                "last_to_first": (14, 14),
                "first_to_last": (34, 34),
            },
        ),
        # It reads at its activation at 25 and 45; at 20 and 40 the values of 10 and 30 have been published: 34 and 54 show these.
        (
            Communication.LET,
            {
                "reduced_data_age": (24, 24),
                "data_age": (44, 44),  # 54 - 10
                "reduced_reaction_time": (24, 34),  # 34 - 10, and 34 - 0
                "reaction_time": (34, 44),  # 34 - 0, and 54 - 10
                "last_to_first": (24, 24),
                "first_to_last": (44, 44),
            },
        ),
    ],
)
def test_latencies_from_the_start_of_a_producer_to_the_end_of_a_consumer(communication, expected):
    # The producer starts at 0, 10, ..., writes after 1, ends after 7. The consumer is activated at 5, 25, ..., starts at 11, 31, ...
    # when the more urgent task on its core has ended, reads after 2 and ends after 3.
    producer = Proc("producer", (ticks(1), access("data", WRITE, communication), ticks(6)), 10, priority=1)
    rival = Proc("rival", (ticks(6),), 20, 5, priority=2, scheduler="s1")
    consumer = Proc("consumer", (ticks(2), access("data", READ, communication), ticks(1)), 20, 5, priority=1, scheduler="s1")
    parts = {"labels": (Label(name="data"),), "events": EVENTS, "chains": (chain("through", "begin", "end"),)}
    run = record(built(producer, rival, consumer, **parts), Options(duration=400 * US))
    found = latencies(run, "through", 0)
    assert {name: (found[name].min / US, found[name].max / US) for name in expected} == expected
