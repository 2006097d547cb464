"""Which stimuli am2inc converts."""

from __future__ import annotations

from amalthea_uros.metamodel.classes import ArrivalCurveStimulus, CustomStimulus, EventStimulus, VariableRateStimulus

#: The classes of stimuli that it does not convert.
NOT_CONVERTED = (EventStimulus, CustomStimulus, ArrivalCurveStimulus, VariableRateStimulus)
