"""The stimuli that am2inc does not convert."""

from __future__ import annotations

from amalthea_uros.metamodel.classes import ArrivalCurveStimulus, CustomStimulus, EventStimulus, VariableRateStimulus

#: The classes of stimuli that am2inc does not convert.
NOT_CONVERTED = (EventStimulus, CustomStimulus, ArrivalCurveStimulus, VariableRateStimulus)
