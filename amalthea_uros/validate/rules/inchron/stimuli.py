"""Stimuli that am2inc does not convert, or changes."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import dropwhile

from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.magnitudes import in_one_unit
from amalthea_uros.metamodel.naming import name_of
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import Downgraded, changes, model_rule, repair_of
from amalthea_uros.validate.rules.inchron.importer import amount

#: The classes of stimuli that am2inc does not convert.
NOT_CONVERTED = (am.EventStimulus, am.CustomStimulus, am.ArrivalCurveStimulus, am.VariableRateStimulus)


@model_rule("INC-ST-TYPE", am.Process, *NOT_CONVERTED)
def _check_type(element: am.Stimulus | am.Process, context: Context) -> Iterator[str]:
    if isinstance(element, NOT_CONVERTED):
        yield f"the {type(element).__name__} {name_of(element)!r} is not converted by am2inc"
    if isinstance(element, am.Process):
        for stimulus in element.stimuli:
            if isinstance(stimulus, NOT_CONVERTED):
                yield f"{element.name or ''!r} is not activated by its stimulus {stimulus.name or ''!r}, which am2inc does not convert"


@model_rule("INC-ST-ORDER", am.Process)
def _check_order(element: am.Process, context: Context) -> Iterator[str]:
    dropped = list(dropwhile(lambda stimulus: not isinstance(stimulus, NOT_CONVERTED), element.stimuli))
    for stimulus in dropped:
        if not isinstance(stimulus, NOT_CONVERTED):
            cause = f"it follows the unsupported {dropped[0].name!r}"
            yield f"the stimulus {stimulus.name or ''!r} of {element.name or ''!r} is dropped by am2inc because {cause}"


@repair_of("INC-ST-ORDER")
def _fix_order(element: am.Process, context: Context) -> bool:
    # The order of the stimuli has no meaning: each of them activates the process.
    element.stimuli = sorted(element.stimuli, key=lambda stimulus: isinstance(stimulus, NOT_CONVERTED))
    return True


@model_rule("INC-ST-BURST", am.PeriodicBurstStimulus)
def _check_burst(element: am.PeriodicBurstStimulus, context: Context) -> Iterator[str]:
    count = 1 if element.occurrence_count is None else element.occurrence_count
    if count < 1 and not amount(element.occurrence_min_distance) > 0:
        yield f"the burst stimulus {element.name or ''!r} has neither a positive occurrence count nor a positive minimum distance"


@model_rule("INC-ST-JITTER", am.PeriodicStimulus)
def _check_jitter(element: am.PeriodicStimulus, context: Context) -> Iterator[str | Downgraded]:
    jitter = element.jitter
    if isinstance(jitter, am.TimeGaussDistribution):
        if jitter.lower_bound is None or jitter.upper_bound is None or (jitter.mean is not None and jitter.mean.value):
            yield changes(
                f"the Gaussian jitter of the stimulus {element.name or ''!r} has a missing bound or a mean other than 0"
            )
    elif jitter is not None and not isinstance(jitter, am.TimeConstant | am.TimeUniformDistribution):
        yield f"the jitter of the stimulus {element.name or ''!r} is dropped by am2inc"


@model_rule("INC-ST-RELPER", am.RelativePeriodicStimulus)
def _check_relper(element: am.RelativePeriodicStimulus, context: Context) -> Iterator[str | Downgraded]:
    if element.next_occurrence is None:
        yield Downgraded(f"the stimulus {element.name or ''!r} has no next occurrence")
    elif not isinstance(element.next_occurrence, am.TimeGaussDistribution | am.TimeUniformDistribution):
        yield f"the next occurrence of the stimulus {element.name or ''!r} is not a uniform or Gaussian distribution"


@model_rule("INC-ST-RELPER-UNIT", am.RelativePeriodicStimulus)
def _check_relper_unit(element: am.RelativePeriodicStimulus, context: Context) -> Iterator[str]:
    if len({bound.unit for bound in _bounds(element)}) > 1:
        yield f"the bounds of the next occurrence of the stimulus {element.name or ''!r} have different units"


def _bounds(stimulus: am.RelativePeriodicStimulus) -> list[am.Time]:
    distance = stimulus.next_occurrence
    bounds = [distance.lower_bound, distance.upper_bound] if isinstance(distance, am.TimeUniformDistribution) else []
    return [bound for bound in bounds if bound is not None]


@repair_of("INC-ST-RELPER-UNIT")
def _fix_relper_unit(element: am.RelativePeriodicStimulus, context: Context) -> bool:
    """State both bounds in the finer unit, in which both are whole numbers."""
    return in_one_unit(*_bounds(element))
