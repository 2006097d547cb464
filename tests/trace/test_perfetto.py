"""Perfetto files, read with the message classes of Perfetto itself."""

import pytest
from effort import every
from hand_made_systems import SYSTEMS
from hypothesis import given
from hypothesis import strategies as st
from test_btf_writer import ENTITIES, PREEMPTION, SLICES, TASK_A, TASK_B, in_nanoseconds
from traces import chunks, encoded, random_trace, table

from amalthea_uros.services.simulate import simulate
from amalthea_uros.trace.table import Entity, EntityKind, EventKind
from amalthea_uros.trace.viewers.perfetto import varint
from amalthea_uros.trace.viewers.timeline import Timeline, TrackChange

messages = pytest.importorskip("perfetto.protos.perfetto.trace.perfetto_trace_pb2", reason="perfetto is not installed")
BEGIN, END, INSTANT = 1, 2, 3


class Picture:
    """What a viewer makes of a file; it refuses what viewers report as errors."""

    def __init__(self, data):
        trace = messages.Trace()
        trace.ParseFromString(data)
        self.tracks, self.parents, names = {}, {}, {}
        self.slices, self.instants = [], []
        open_slices, last = {}, {}
        is_cleared = False
        for packet in trace.packet:
            assert packet.trusted_packet_sequence_id == 1
            is_cleared = is_cleared or packet.sequence_flags == 1
            for name in packet.interned_data.event_names:
                assert name.iid not in names
                names[name.iid] = name.name
            if packet.HasField("track_descriptor"):
                track = packet.track_descriptor
                assert track.uuid not in self.tracks
                assert not track.parent_uuid or track.parent_uuid in self.tracks
                self.tracks[track.uuid] = track.name
                self.parents[track.name] = self.tracks.get(track.parent_uuid)
            if packet.HasField("track_event"):
                assert is_cleared
                assert packet.sequence_flags == 2
                event = packet.track_event
                track = self.tracks[event.track_uuid]
                assert packet.timestamp >= last.get(track, 0)
                last[track] = packet.timestamp
                stack = open_slices.setdefault(track, [])
                if event.type == END:
                    begin, name = stack.pop()
                    self.slices.append((track, begin, packet.timestamp, name))
                elif event.type == BEGIN:
                    stack.append((packet.timestamp, names[event.name_iid]))
                else:
                    assert event.type == INSTANT
                    self.instants.append((track, packet.timestamp, names[event.name_iid], list(event.flow_ids)))
        assert not any(open_slices.values())


def picture(*tables):
    return Picture(encoded(".pftrace", *tables))


def test_a_preemption():
    shown = picture(table(ENTITIES, in_nanoseconds(PREEMPTION)))
    assert set(shown.slices) == {(track, *each) for track, slices in SLICES.items() for each in slices}
    groups = {"Cores": None, "Tasks and ISRs": None}
    assert shown.parents == groups | {"Core_1": "Cores", "Task_A": "Tasks and ISRs", "Task_B": "Tasks and ISRs"}


def test_arrows_along_a_chain():
    entities = [*ENTITIES, Entity(EntityKind.CHAIN, "Chain")]
    steps = [(1000, TASK_A, 5, 0), (2000, TASK_B, 5, 1), (3000, TASK_A, 6, 0)]
    shown = picture(
        table(entities, [(time, EventKind.CHAIN_STEP, task, 0, 7, number, step) for time, task, number, step in steps])
    )
    assert [instant[:3] for instant in shown.instants] == [
        ("Task_A", 1, "Chain"),
        ("Task_B", 2, "Chain"),
        ("Task_A", 3, "Chain"),
    ]
    [first], [second], [other] = (instant[3] for instant in shown.instants)
    assert first == second != other


def test_picoseconds_are_rounded_down_and_stay_in_order():
    shown = picture(table(ENTITIES, [(1999, *rest) for _, *rest in PREEMPTION]))
    assert {time for _, begin, end, _ in shown.slices for time in (begin, end)} == {1}


@given(st.randoms(use_true_random=False), st.integers(1, 40))
def test_random_traces_are_shown_without_errors(random, size):
    trace = random_trace(random, steps=150)
    shown = picture(trace, *chunks(trace.rows(0, 0), size)) if not len(trace) else picture(*chunks(trace, size))
    begins = sum(mark.change is TrackChange.BEGIN for mark in complete(trace))
    assert len(shown.slices) == begins


def complete(trace):
    timeline = Timeline()
    return [*timeline.marks(trace), *timeline.finish()]


@given(st.integers(0, 2**64 - 1))
def test_numbers_are_encoded_as_perfetto_decodes_them(number):
    packet = messages.TracePacket()
    packet.ParseFromString(b"\x40" + varint(number))  # field 8: the time stamp
    assert packet.timestamp == number


@pytest.mark.parametrize("name", every(4, list(SYSTEMS)))
def test_simulated_systems_are_shown_without_errors(name):
    trace = simulate(SYSTEMS[name], "600 us", trace=True).trace
    shown = picture(*chunks(trace, 500))
    assert len(shown.slices) == sum(mark.change is TrackChange.BEGIN for mark in complete(trace))


def test_arrows_of_a_simulation_lead_from_job_to_job_of_the_chain():
    shown = picture(simulate(SYSTEMS["triggers to another core"], "600 us", trace=True).trace)
    running = {(track, begin, end) for track, begin, end, name in shown.slices if name == "running"}
    ways = {}
    for track, time, _, [flow] in shown.instants:
        assert any(task == track and begin <= time <= end for task, begin, end in running)
        # A trigger and data lead to the next task; both mark the same jobs.
        found = ways.setdefault(flow, [])
        found += [(time, track)] * ((time, track) not in found)
    # Each job of the first task, every 20 us, leads to one of the second and one of the third.
    assert len(ways) == 30
    assert [track for _, track in ways.popitem()[1]][:1] == ["first"]
    assert all([track for _, track in way] == ["first", "then", "last"] for way in ways.values())
    assert all(way == sorted(way) for way in ways.values())
