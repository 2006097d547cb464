"""Ranges and units of values, sizes and shares of transmitted data."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.magnitudes import bits
from amalthea_uros.metamodel.naming import name_of
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import model_rule


@model_rule("AM-Basic-Counter", am.Counter)
def _check_counter(element: am.Counter, context: Context) -> Iterator[str]:
    if (element.offset or 0) < 0:
        yield f"the counter offset is {element.offset}, but must be 0 or more"


@model_rule("AM-Basic-Data-Size", am.AbstractMemoryElement)
def _check_size(element: am.AbstractMemoryElement, context: Context) -> Iterator[str]:
    if element.size is not None and (element.size.value or 0) <= 0:
        yield f"the size of {element.name!r} is {element.size.value or 0}, but must be greater than 0"


@model_rule("AM-Basic-Frequency", am.Frequency)
def _check_frequency(element: am.Frequency, context: Context) -> Iterator[str]:
    holder = element.container
    decides = isinstance(holder, am.FrequencyDomain) or (isinstance(holder, am.ClockFunction) and holder.y_offset is element)
    if decides and (element.value or 0) <= 0:
        yield f"the frequency of {name_of(holder)!r} is {element.value or 0}, but must be greater than 0"


@model_rule("AM-Basic-Quantity", am.Quantity)
def _check_unit(element: am.Quantity, context: Context) -> Iterator[str]:
    if getattr(element, "unit", None) in (None, "_undefined_"):
        yield f"the {type(element).__name__} has no unit"


_POSITIVE, _NOT_NEGATIVE = "greater than 0", "0 or more"


#: The smallest allowed value in any unit: times are whole numbers.
_MINIMUM = {_POSITIVE: 1, _NOT_NEGATIVE: 0}


#: The required range of times, by class and feature; all other times are unrestricted.
_ROLES: tuple[tuple[type[Element], str, str], ...] = (
    (am.FixedPeriodic, "recurrence", _POSITIVE),
    (am.FixedPeriodic, "offset", _NOT_NEGATIVE),
    (am.SingleStimulus, "occurrence", _NOT_NEGATIVE),
    (am.PeriodicSyntheticStimulus, "occurrence_times", _NOT_NEGATIVE),
    (am.ArrivalCurveEntry, "lower_time_border", _NOT_NEGATIVE),
    (am.ArrivalCurveEntry, "upper_time_border", _NOT_NEGATIVE),
    (am.PeriodicActivation, "recurrence", _POSITIVE),
    (am.PeriodicActivation, "offset", _NOT_NEGATIVE),
    (am.PeriodicActivation, "min", _NOT_NEGATIVE),
    (am.PeriodicActivation, "max", _NOT_NEGATIVE),
    (am.SingleActivation, "min", _NOT_NEGATIVE),
    (am.SingleActivation, "max", _NOT_NEGATIVE),
    (am.ClockFunction, "period", _POSITIVE),
    (am.ClockFunction, "x_offset", _NOT_NEGATIVE),
    (am.ClockStepList, "period", _POSITIVE),
    (am.ClockStep, "time", _NOT_NEGATIVE),
    (am.DataAgeTime, "minimum_time", _NOT_NEGATIVE),
    (am.DataAgeTime, "maximum_time", _NOT_NEGATIVE),
    (am.DelayConstraint, "lower", _NOT_NEGATIVE),
    (am.DelayConstraint, "upper", _NOT_NEGATIVE),
    (am.EventChainLatencyConstraint, "minimum", _NOT_NEGATIVE),
    (am.EventChainLatencyConstraint, "maximum", _NOT_NEGATIVE),
    (am.RepetitionConstraint, "lower", _NOT_NEGATIVE),
    (am.RepetitionConstraint, "upper", _NOT_NEGATIVE),
    (am.RepetitionConstraint, "jitter", _NOT_NEGATIVE),
    (am.RepetitionConstraint, "period", _NOT_NEGATIVE),
    (am.SynchronizationConstraint, "tolerance", _NOT_NEGATIVE),
)


@model_rule("AM-Basic-Time-Range", am.Time)
def _check_time_range(element: am.Time, context: Context) -> Iterator[str]:
    feature, required = context.once(_required_ranges).get(element, ("", ""))
    value = element.value or 0
    if required and value < _MINIMUM[required]:
        yield f"the {feature.replace('_', ' ')} is {value} {element.unit or ''}".rstrip() + f", but must be {required}"


def _required_ranges(context: Context) -> dict[am.Time, tuple[str, str]]:
    found: dict[am.Time, tuple[str, str]] = {}
    for cls, feature, required in _ROLES:
        for holder in context.all(cls):
            held = getattr(holder, feature)
            found.update((time, (feature, required)) for time in (held if isinstance(held, list) else [held]))
    return found


@model_rule("DOC-Transmission-Chunk", am.TransmissionPolicy)
def _check_chunk(element: am.TransmissionPolicy, context: Context) -> Iterator[str]:
    chunk, whole = element.chunk_size, _transmitted(element.container)
    chunk_bits, whole_bits = bits(chunk), bits(whole)
    if chunk is None or whole is None or chunk_bits is None or whole_bits is None:
        return
    if chunk_bits > whole_bits:
        yield f"the chunk size of {chunk.value} {chunk.unit} is larger than the transmitted {whole.value} {whole.unit}"


def _transmitted(access: Element | None) -> am.DataSize | None:
    """The size of the label, or of an element of the channel, if it is known."""
    match access:
        case am.LabelAccess(data=data) if data is not None:
            return data.size
        case am.ChannelAccess(data=am.Channel(element_type=am.TypeDefinition(size=size))):
            return size
        case am.ChannelAccess(data=am.Channel(element_type=am.TypeRef(type_def=am.TypeDefinition(size=size)))):
            return size
    return None


@model_rule("DOC-Transmission-Ratio", am.TransmissionPolicy)
def _check_ratio(element: am.TransmissionPolicy, context: Context) -> Iterator[str]:
    if element.transmit_ratio is not None and not 0 <= element.transmit_ratio <= 1:
        yield f"the transmit ratio is {element.transmit_ratio}, but must be from 0 to 1"
