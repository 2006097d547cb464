"""In which roles times have to be above zero, which ones may be zero, and which ones are free."""

import pytest
from excerpts import assert_said, messages

STIMULUS = '<stimuliModel><stimuli t="{}" name="S">{}</stimuli></stimuliModel>'
CLOCK = '<stimuliModel><clocks t="{}" name="C">{}</clocks></stimuliModel>'
ACTIVATION = '<swModel><activations t="{}" name="A">{}</activations></swModel>'
CONSTRAINT = '<constraintsModel><timingConstraints t="{}" name="C">{}</timingConstraints></constraintsModel>'
DATA_AGE = """<constraintsModel><dataAgeConstraints name="C"><dataAge t="{}">{}</dataAge></dataAgeConstraints>
</constraintsModel>"""

POSITIVE = [
    (STIMULUS, "PeriodicStimulus", "recurrence"),
    (STIMULUS, "PeriodicSyntheticStimulus", "recurrence"),
    (STIMULUS, "PeriodicBurstStimulus", "recurrence"),
    (ACTIVATION, "PeriodicActivation", "recurrence"),
    (CLOCK, "ClockFunction", "period"),
    (CLOCK, "ClockStepList", "period"),
]
NOT_NEGATIVE = [
    (STIMULUS, "PeriodicStimulus", "offset"),
    (STIMULUS, "PeriodicSyntheticStimulus", "offset"),
    (STIMULUS, "PeriodicBurstStimulus", "offset"),
    (STIMULUS, "SingleStimulus", "occurrence"),
    (STIMULUS, "PeriodicSyntheticStimulus", "occurrenceTimes"),
    (STIMULUS, "ArrivalCurveStimulus", "entries/lowerTimeBorder"),
    (STIMULUS, "ArrivalCurveStimulus", "entries/upperTimeBorder"),
    (ACTIVATION, "PeriodicActivation", "offset"),
    (ACTIVATION, "PeriodicActivation", "min"),
    (ACTIVATION, "PeriodicActivation", "max"),
    (ACTIVATION, "SingleActivation", "min"),
    (ACTIVATION, "SingleActivation", "max"),
    (CLOCK, "ClockFunction", "xOffset"),
    (CLOCK, "ClockStepList", "entries/time"),
    (DATA_AGE, "DataAgeTime", "minimumTime"),
    (DATA_AGE, "DataAgeTime", "maximumTime"),
    (CONSTRAINT, "DelayConstraint", "lower"),
    (CONSTRAINT, "DelayConstraint", "upper"),
    (CONSTRAINT, "EventChainLatencyConstraint", "minimum"),
    (CONSTRAINT, "EventChainLatencyConstraint", "maximum"),
    (CONSTRAINT, "RepetitionConstraint", "lower"),
    (CONSTRAINT, "RepetitionConstraint", "upper"),
    (CONSTRAINT, "RepetitionConstraint", "jitter"),
    (CONSTRAINT, "RepetitionConstraint", "period"),
    (CONSTRAINT, "EventSynchronizationConstraint", "tolerance"),
    (CONSTRAINT, "EventChainSynchronizationConstraint", "tolerance"),
]
FREE = [
    (STIMULUS, "PeriodicStimulus", "minDistance"),
    (STIMULUS, "PeriodicBurstStimulus", "burstLength"),
    (STIMULUS, "PeriodicBurstStimulus", "occurrenceMinDistance"),
    (STIMULUS, "RelativePeriodicStimulus", "offset"),
    (STIMULUS, "VariableRateStimulus", "step"),
    (ACTIVATION, "VariableRateActivation", "step"),
]


def role(frame, kind, path, time):
    """A model with a time in a role."""
    *outer, feature = path.split("/")
    return frame.format(
        kind, "".join(f"<{each}>" for each in outer) + f"<{feature} {time}/>" + "".join(f"</{each}>" for each in outer)
    )


@pytest.mark.parametrize(("frame", "kind", "feature"), POSITIVE, ids="-".join)
def test_times_that_have_to_be_above_zero(frame, kind, feature, tmp_path):
    for time, is_wrong in (
        ('value="1" unit="ps"', False),
        ('value="0" unit="s"', True),
        ('unit="s"', True),
        ('value="-1" unit="ps"', True),
    ):
        assert len(messages(tmp_path, "AM-Basic-Time-Range", role(frame, kind, feature, time))) is int(is_wrong)


@pytest.mark.parametrize(("frame", "kind", "feature"), NOT_NEGATIVE, ids="-".join)
def test_times_that_may_be_zero(frame, kind, feature, tmp_path):
    for time, is_wrong in (('value="0" unit="s"', False), ('unit="s"', False), ('value="-1" unit="ps"', True)):
        assert len(messages(tmp_path, "AM-Basic-Time-Range", role(frame, kind, feature, time))) is int(is_wrong)


@pytest.mark.parametrize(("frame", "kind", "feature"), FREE, ids="-".join)
def test_times_that_may_be_negative(frame, kind, feature, tmp_path):
    assert not messages(tmp_path, "AM-Basic-Time-Range", role(frame, kind, feature, 'value="-1" unit="ms"'))


def test_a_message_names_the_role_and_the_unit(tmp_path):
    excerpt = role(STIMULUS, "ArrivalCurveStimulus", "entries/lowerTimeBorder", 'value="-2" unit="us"')
    assert messages(tmp_path, "AM-Basic-Time-Range", excerpt) == ["the lower time border is -2 us, but must be 0 or more"]
    excerpt = role(STIMULUS, "PeriodicStimulus", "recurrence", "")
    assert messages(tmp_path, "AM-Basic-Time-Range", excerpt) == ["the recurrence is 0, but must be greater than 0"]


def test_each_of_several_times_is_looked_at(tmp_path):
    times = "".join(f'<occurrenceTimes value="{value}" unit="ms"/>' for value in (1, -1, 0, -3))
    said = messages(tmp_path, "AM-Basic-Time-Range", STIMULUS.format("PeriodicSyntheticStimulus", times))
    assert_said(said, ["occurrence times is -1 ms", "occurrence times is -3 ms"])
