"""Ranges and units of values, sizes and shares of transmitted data."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.metamodel.classes import (
    AbstractMemoryElement,
    ArrivalCurveEntry,
    Channel,
    ChannelAccess,
    ClockFunction,
    ClockStep,
    ClockStepList,
    Counter,
    DataAgeTime,
    DataSize,
    DelayConstraint,
    EventChainLatencyConstraint,
    FixedPeriodic,
    Frequency,
    FrequencyDomain,
    LabelAccess,
    PeriodicActivation,
    PeriodicSyntheticStimulus,
    Quantity,
    RepetitionConstraint,
    SingleActivation,
    SingleStimulus,
    SynchronizationConstraint,
    Time,
    TransmissionPolicy,
    TypeDefinition,
    TypeRef,
)
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.magnitudes import bits
from amalthea_uros.metamodel.naming import name_of
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import model_rule


@model_rule("AM-Basic-Counter", Counter)
def _check_counter(element: Counter, context: Context) -> Iterator[str]:
    if (element.offset or 0) < 0:
        yield f"the counter offset is {element.offset}, but must be 0 or more"


@model_rule("AM-Basic-Data-Size", AbstractMemoryElement)
def _check_size(element: AbstractMemoryElement, context: Context) -> Iterator[str]:
    if element.size is not None and (element.size.value or 0) <= 0:
        yield f"the size of {element.name!r} is {element.size.value or 0}, but must be greater than 0"


@model_rule("AM-Basic-Frequency", Frequency)
def _check_frequency(element: Frequency, context: Context) -> Iterator[str]:
    holder = element.container
    decides = isinstance(holder, FrequencyDomain) or (isinstance(holder, ClockFunction) and holder.y_offset is element)
    if decides and (element.value or 0) <= 0:
        yield f"the frequency of {name_of(holder)!r} is {element.value or 0}, but must be greater than 0"


@model_rule("AM-Basic-Quantity", Quantity)
def _check_unit(element: Quantity, context: Context) -> Iterator[str]:
    if getattr(element, "unit", None) in (None, "_undefined_"):
        yield f"the {type(element).__name__} has no unit"


_POSITIVE, _NOT_NEGATIVE = "greater than 0", "0 or more"


#: The smallest allowed value in any unit: times are whole numbers.
_MINIMUM = {_POSITIVE: 1, _NOT_NEGATIVE: 0}


#: The required range of times, by class and feature; all other times are unrestricted.
_ROLES: tuple[tuple[type[Element], str, str], ...] = (
    (FixedPeriodic, "recurrence", _POSITIVE),
    (FixedPeriodic, "offset", _NOT_NEGATIVE),
    (SingleStimulus, "occurrence", _NOT_NEGATIVE),
    (PeriodicSyntheticStimulus, "occurrence_times", _NOT_NEGATIVE),
    (ArrivalCurveEntry, "lower_time_border", _NOT_NEGATIVE),
    (ArrivalCurveEntry, "upper_time_border", _NOT_NEGATIVE),
    (PeriodicActivation, "recurrence", _POSITIVE),
    (PeriodicActivation, "offset", _NOT_NEGATIVE),
    (PeriodicActivation, "min", _NOT_NEGATIVE),
    (PeriodicActivation, "max", _NOT_NEGATIVE),
    (SingleActivation, "min", _NOT_NEGATIVE),
    (SingleActivation, "max", _NOT_NEGATIVE),
    (ClockFunction, "period", _POSITIVE),
    (ClockFunction, "x_offset", _NOT_NEGATIVE),
    (ClockStepList, "period", _POSITIVE),
    (ClockStep, "time", _NOT_NEGATIVE),
    (DataAgeTime, "minimum_time", _NOT_NEGATIVE),
    (DataAgeTime, "maximum_time", _NOT_NEGATIVE),
    (DelayConstraint, "lower", _NOT_NEGATIVE),
    (DelayConstraint, "upper", _NOT_NEGATIVE),
    (EventChainLatencyConstraint, "minimum", _NOT_NEGATIVE),
    (EventChainLatencyConstraint, "maximum", _NOT_NEGATIVE),
    (RepetitionConstraint, "lower", _NOT_NEGATIVE),
    (RepetitionConstraint, "upper", _NOT_NEGATIVE),
    (RepetitionConstraint, "jitter", _NOT_NEGATIVE),
    (RepetitionConstraint, "period", _NOT_NEGATIVE),
    (SynchronizationConstraint, "tolerance", _NOT_NEGATIVE),
)


@model_rule("AM-Basic-Time-Range", Time)
def _check_time_range(element: Time, context: Context) -> Iterator[str]:
    feature, required = context.once(_required_ranges).get(element, ("", ""))
    value = element.value or 0
    if required and value < _MINIMUM[required]:
        yield f"the {feature.replace('_', ' ')} is {value} {element.unit or ''}".rstrip() + f", but must be {required}"


def _required_ranges(context: Context) -> dict[Time, tuple[str, str]]:
    found: dict[Time, tuple[str, str]] = {}
    for cls, feature, required in _ROLES:
        for holder in context.all(cls):
            held = getattr(holder, feature)
            found.update((time, (feature, required)) for time in (held if isinstance(held, list) else [held]))
    return found


@model_rule("DOC-Transmission-Chunk", TransmissionPolicy)
def _check_chunk(element: TransmissionPolicy, context: Context) -> Iterator[str]:
    chunk, whole = element.chunk_size, _transmitted(element.container)
    chunk_bits, whole_bits = bits(chunk), bits(whole)
    if chunk is None or whole is None or chunk_bits is None or whole_bits is None:
        return
    if chunk_bits > whole_bits:
        yield f"the chunk size of {chunk.value} {chunk.unit} is larger than the transmitted {whole.value} {whole.unit}"


def _transmitted(access: Element | None) -> DataSize | None:
    """The size of the label, or of an element of the channel, if it is known."""
    match access:
        case LabelAccess(data=data) if data is not None:
            return data.size
        case ChannelAccess(data=Channel(element_type=TypeDefinition(size=size))):
            return size
        case ChannelAccess(data=Channel(element_type=TypeRef(type_def=TypeDefinition(size=size)))):
            return size
    return None


@model_rule("DOC-Transmission-Ratio", TransmissionPolicy)
def _check_ratio(element: TransmissionPolicy, context: Context) -> Iterator[str]:
    if element.transmit_ratio is not None and not 0 <= element.transmit_ratio <= 1:
        yield f"the transmit ratio is {element.transmit_ratio}, but must be from 0 to 1"
