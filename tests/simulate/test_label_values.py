"""Which values of a label are read, against a definition that looks back from each read."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from amalthea_uros.perf.activities import Communication
from amalthea_uros.perf.events import LabelChange, LabelEvent, ProcessChange, ProcessEvent
from amalthea_uros.simulate.metrics.label_values import LabelValues
from amalthea_uros.simulate.program.watches import EventSource

PROCESSES = ("A", "B", "C")
PHASES = (ProcessChange.ACTIVATE, ProcessChange.START, ProcessChange.TERMINATE)
SOURCES = [
    *(EventSource(ProcessEvent, name, change, None, name) for name in PROCESSES for change in PHASES),
    *(
        EventSource(LabelEvent, "x", change, None, name, communication)
        for name in PROCESSES
        for change in LabelChange
        for communication in Communication
    ),
]


@st.composite
def histories(draw):
    """What three processes do: (time, source), each time later than the one before it."""
    states, history = dict.fromkeys(PROCESSES, ProcessChange.TERMINATE), []
    for time in range(draw(st.integers(0, 40))):
        name = draw(st.sampled_from(PROCESSES))
        following = {
            ProcessChange.TERMINATE: ProcessChange.ACTIVATE,
            ProcessChange.ACTIVATE: ProcessChange.START,
            ProcessChange.START: ProcessChange.TERMINATE,
        }[states[name]]
        if states[name] is ProcessChange.START and draw(st.integers(0, 3)):
            change, communication = draw(st.sampled_from(LabelChange)), draw(st.sampled_from(Communication))
            history.append((time, EventSource(LabelEvent, "x", change, None, name, communication)))
        else:
            states[name] = following
            history.append((time, EventSource(ProcessEvent, name, following, None, name)))
    return history


@given(histories(), st.none() | st.sampled_from(Communication), st.integers(1, 5))
def test_the_value_that_is_read(history, override, size):
    values = LabelValues(["x"], SOURCES, override)
    readings = []
    for first in range(0, len(history), size):
        chunk = history[first : first + size]
        times = np.array([time for time, _ in chunk])
        readings += values.readings(times, np.array([SOURCES.index(source) for _, source in chunk]))
    found = [(each.time, None if each.value is None else each.value.time) for each in readings]
    reads = [(time, source) for time, source in history if source.change is LabelChange.READ]
    assert found == [(time, value_at(history, time, source, override)) for time, source in reads]
    assert values.writes["x"] == sum(source.change is LabelChange.WRITE for _, source in history)
    assert 0 <= values.overwritten["x"] <= values.writes["x"]


def value_at(history, time, reader, override):
    """The time of the write whose value is read: of those that are visible when the reader takes it, the one that got visible last."""
    how = override or reader.communication
    if how is Communication.EXPLICIT:
        taken = time
    else:
        phase = ProcessChange.START if how is Communication.IMPLICIT else ProcessChange.ACTIVATE
        taken = max(t for t, source in history if t < time and source.process == reader.process and source.change is phase)
    writes = [(t, source, override or source.communication) for t, source in history if source.change is LabelChange.WRITE]
    own = [t for t, s, kind in writes if taken < t < time and s.process == reader.process and kind is Communication.IMPLICIT]
    if how is Communication.IMPLICIT and own:
        return own[-1]
    visible = [(visible_from(history, t, s, kind), t) for t, s, kind in writes]
    # What becomes visible at a release is there for who reads at this release.
    return max(((since, t) for since, t in visible if since is not None and since <= taken), default=(None, None))[1]


def visible_from(history, time, writer, how):
    """When others see what is written at a time."""
    phase = {Communication.IMPLICIT: ProcessChange.TERMINATE, Communication.LET: ProcessChange.ACTIVATE}.get(how)
    if phase is None:
        return time
    later = [t for t, source in history if t > time and source.process == writer.process and source.change is phase]
    return later[0] if later else None
