"""Which quantity of the model a measured series is: by equal names, or as the user says."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

from amalthea_uros._internal.records import dataclass, field, replace
from amalthea_uros._internal.similar import did_you_mean
from amalthea_uros.compare.measured.receptions import ARROW, receptions
from amalthea_uros.compare.results import Statistic
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.measure.baselines import subtracted_objects, with_baseline
from amalthea_uros.measure.begins import ACTIVATION, END_OF_WAIT, FROM_ACTIVATION, ChainBegin, ModelBegins, begin_name
from amalthea_uros.measure.series import WHOLE_TIME, MeasuredKind, Measurement, Series, TimeStatistics
from amalthea_uros.names import require
from amalthea_uros.perf.system import System
from amalthea_uros.timing.basics.quantities import ChainQuantity, JobMetric
from amalthea_uros.trace.table import EventKind

#: How a meaning is written.
FORM = "MEASURED=OBJECT.QUANTITY"
EXAMPLE = "'executor + control=Control_Function.response_time'"
_SUM = " + "
#: The quantity of an interval between two markers, of which nothing else is known.
_DURATION = "duration"
_WITHOUT_PREEMPTION = (JobMetric.NET_EXECUTION_TIME, JobMetric.RUNNING_TIME)


@dataclass(frozen=True, slots=True)
class Meaning:
    """What a measured series, or a sum of several, is in the model.

    Attributes
    ----------
    measured : the name of a series, of an object and its quantity such as `Task.duration`, or several of them with ` + ` between them
    """

    measured: str
    object: str
    quantity: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Names:
    """How names of the trace become those of the model.

    Attributes
    ----------
    renamed : name in the trace -> name in the model
    """

    renamed: Mapping[str, str] = field(default_factory=dict)
    meanings: tuple[Meaning, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Target:
    """What a measured series is compared with.

    Attributes
    ----------
    kind, name, quantity : of what is predicted
    statistics : those that can be compared
    reason : why nothing can be compared, "" if something can
    is_unknown : whether the model has nothing of the name
    is_with_baseline : whether a baseline was subtracted and added again
    """

    series: Series
    kind: MeasuredKind
    name: str
    quantity: str
    statistics: tuple[Statistic, ...] = tuple(Statistic)
    reason: str = ""
    is_unknown: bool = False
    is_with_baseline: bool = False


def parse_meaning(text: str) -> Meaning:
    """A meaning as it is written.

    >>> parse_meaning("executor + control=Control_Function.response_time")
    Meaning(measured='executor + control', object='Control_Function', quantity='response_time')

    Raises
    ------
    ValueError : the text has another form.
    """
    measured, equals, meant = text.partition("=")
    name, point, quantity = meant.strip().rpartition(".")
    if not (measured.strip() and equals and name and point and quantity):
        raise ValueError(f"{text!r} is not of the form {FORM}; an example: {EXAMPLE}")
    return Meaning(measured.strip(), name, quantity)


def targets(
    measurement: Measurement,
    names: Names,
    system: System,
    with_overhead: Collection[str],
    begins: ModelBegins,
) -> tuple[Target, ...]:
    """What each measured series is compared with, first those of which the user says it.

    Parameters
    ----------
    with_overhead : the processes whose predicted times include an overhead, "" for all: what was subtracted as such is added again
    begins : with what jobs and chains begin in the model

    Raises
    ------
    InvalidArgumentError : the user names what the trace or the model does not have, a sum or quantity that cannot be, or two series of
        the same quantity.
    """
    _check(measurement, names, system)
    found = []
    is_scheduled = any(series.kind is MeasuredKind.PROCESS for series in measurement.series)
    for target in _targets(measurement, names, system):
        if not is_scheduled and target.name in system.host.callback_names and target.quantity in _WITHOUT_PREEMPTION:
            target = replace(target, reason="the scheduler was not recorded, so that preemption is part of it")
        is_included = bool({"", target.name} & set(with_overhead))
        if is_included and target.kind is MeasuredKind.PROCESS and target.series.baseline is not None:
            target = replace(target, series=with_baseline(target.series), is_with_baseline=True)
        found.append(_of_same_begin(target, begins))
    _refuse_twice(found)
    return tuple(found)


def _of_same_begin(target: Target, begins: ModelBegins) -> Target:
    """The target; what was measured from another event on than in the model has no counterpart."""
    reason = _other_begin(target, begins)
    return replace(target, reason=reason) if reason and not target.reason else target


def _other_begin(target: Target, begins: ModelBegins) -> str:
    """Why a measured time is not the modelled one, because it begins with another event; "" if it does not."""
    measured = target.series.begin
    if not measured:
        return ""
    if target.kind is MeasuredKind.RUNNABLE:
        is_other = target.name in begins.callbacks and target.quantity in FROM_ACTIVATION
        return _CALLBACK if is_other else ""
    modelled: ChainBegin = begins.chains.get(target.name, EventKind.ACTIVATE)
    if target.kind is MeasuredKind.CHAIN and isinstance(modelled, str):
        return modelled
    expected = ACTIVATION
    if target.kind is MeasuredKind.CHAIN and not isinstance(modelled, str):
        expected = begin_name(modelled)
    elif target.name in begins.iterations:
        expected = END_OF_WAIT
    if measured == expected:
        return ""
    what = "its first job" if target.kind is MeasuredKind.CHAIN else "the job"
    return f"it was measured from the {measured} of {what} on, and begins in the model with its {expected}; measure it with the model"


_CALLBACK = (
    "it begins when a message has arrived or a timer is due, which is not in traces; measure it between markers, or give the values "
    "as a table"
)


def _refuse_twice(found: Iterable[Target]) -> None:
    """Refuse that two series are the same quantity: which of them is meant is not known."""
    series: dict[tuple[MeasuredKind, str, str], list[str]] = {}
    for target in found:
        if not target.reason:
            series.setdefault((target.kind, target.name, target.quantity), []).append(target.series.name)
    for (_, name, quantity), names in series.items():
        if len(names) > 1:
            listed = " and ".join(map(repr, names))
            raise InvalidArgumentError(f"{listed} of the trace are both {name}.{quantity}; leave one of them out")


def _targets(measurement: Measurement, names: Names, system: System) -> Iterator[Target]:
    used: set[tuple[MeasuredKind, str, str]] = set()
    for meaning in names.meanings:
        parts = _measured(meaning.measured, measurement)
        used |= {(each.kind, each.name, each.quantity) for each in parts}
        yield _meant(meaning, parts, system)
    reasons = dict.fromkeys((name for _, name, _ in used), "another quantity of it is what --as says")
    reasons |= dict.fromkeys(subtracted_objects(measurement.series), "it is a baseline, which was subtracted from others")
    for series in measurement.series:
        if (series.kind, series.name, series.quantity) in used:
            continue
        target = _named(series, names.renamed.get(series.name, series.name), system)
        if target.is_unknown and series.name in reasons:
            target = replace(target, reason=reasons[series.name], is_unknown=False)
        yield target


def _check(measurement: Measurement, names: Names, system: System) -> None:
    require("object of the trace", names.renamed, dict.fromkeys(series.name for series in measurement.series))
    handles = (handle.name for executor in system.executors for handle in executor.handles)
    known = dict.fromkeys((*_all_names(system), *handles))
    require("process, chain or runnable", (*names.renamed.values(), *(each.object for each in names.meanings)), known)


def _kinds(name: str, system: System) -> list[MeasuredKind]:
    """What the model has of a name."""
    found = {MeasuredKind.PROCESS: system.processes, MeasuredKind.CHAIN: system.chains, MeasuredKind.RUNNABLE: system.runnables}
    of_host = {MeasuredKind.RUNNABLE} if name in system.host.callback_names else set()
    if ARROW in name and name in receptions(system.host):
        of_host.add(MeasuredKind.CHAIN)
    return [kind for kind, items in found.items() if name in items or kind in of_host]


def _all_names(system: System) -> dict[str, None]:
    """The names of everything that can be compared."""
    of_host = (*receptions(system.host), *system.host.callback_names)
    return dict.fromkeys((*system.processes, *system.chains, *system.runnables, *of_host))


def _in_model(name: str, system: System) -> str:
    """The name of a process, chain or runnable; that of a handle of an executor that loops stands for its callback."""
    if _kinds(name, system):
        return name
    callbacks = {handle.runnable for executor in system.executors for handle in executor.handles if handle.name == name}
    return callbacks.pop() if len(callbacks) == 1 else name


def _named(series: Series, name: str, system: System) -> Target:
    name = _in_model(name, system)
    kinds = _kinds(name, system)
    target = Target(series=series, kind=series.kind, name=name, quantity=series.quantity)
    if not kinds and any(name == executor.name for executor in system.host.executors):
        return replace(target, reason="it is an executor of the host, of which the callbacks are compared")
    if not kinds:
        known = _all_names(system)
        return replace(target, reason=f"the model has no {name!r}; {_advice(series, name, known)}", is_unknown=True)
    if series.kind is MeasuredKind.INTERVAL:
        if series.quantity == _DURATION:
            example = f"--as '{series.name}={name}.{JobMetric.RESPONSE_TIME}'"
            return replace(target, reason=f"a time between two markers can be several quantities; say which, e.g. {example}")
        return replace(
            target, kind=kinds[0], quantity=_whole_time(kinds[0]) if series.quantity == WHOLE_TIME else series.quantity
        )
    if series.kind not in kinds:
        return replace(target, reason=f"{name!r} is a {series.kind} in the trace, and a {kinds[0]} in the model")
    return target


def _whole_time(kind: MeasuredKind) -> str:
    """The time of an object as a whole: of a round trip, each value is that of a request up to its own reply.

    Replies do not overtake each other, so that this is the first reply based on the request: the reduced reaction time.
    """
    return ChainQuantity.REDUCED_REACTION_TIME if kind is MeasuredKind.CHAIN else JobMetric.RESPONSE_TIME


def _advice(series: Series, name: str, known: Mapping[str, None]) -> str:
    near = did_you_mean(name, known)
    if near:
        return near
    return f"say what it is with --map '{series.name}=NAME'"


def _measured(text: str, measurement: Measurement) -> list[Series]:
    """The series that a text names: one, or those of a sum."""
    whole = _series(text, measurement)
    if whole is not None:
        return [whole]
    parts = [(part.strip(), _series(part.strip(), measurement)) for part in text.split(_SUM)]
    known = dict.fromkeys(name for series in measurement.series for name in (series.name, f"{series.name}.{series.quantity}"))
    require("measured series", (part for part, series in parts if series is None), known)
    return [series for _, series in parts if series is not None]


def _series(text: str, measurement: Measurement) -> Series | None:
    """The series of a name, with or without its quantity."""
    exact = [each for each in measurement.series if f"{each.name}.{each.quantity}" == text]
    named = exact or [each for each in measurement.series if each.name == text]
    durations = [each for each in named if each.quantity == _DURATION] or named
    if len(durations) > 1:
        quantities = ", ".join(f"{each.name}.{each.quantity}" for each in durations)
        raise InvalidArgumentError(f"{text!r} has several quantities; name one of them: {quantities}")
    return durations[0] if durations else None


def _meant(meaning: Meaning, parts: Sequence[Series], system: System) -> Target:
    name = _in_model(meaning.object, system)
    kind = _kinds(name, system)[0]
    require("quantity", [meaning.quantity], tuple(ChainQuantity) if kind is MeasuredKind.CHAIN else tuple(JobMetric))
    series = replace(parts[0], kind=kind)
    target = Target(series=series, kind=kind, name=name, quantity=meaning.quantity)
    if len(parts) == 1:
        return target
    # The extremes of a sum are not the sums of the extremes, which need not occur together.
    return replace(target, series=replace(_sum(parts), kind=kind), statistics=(Statistic.MEAN,))


def _sum(parts: Sequence[Series]) -> Series:
    """The mean of a sum."""
    found = [each.statistics for each in parts if each.statistics is not None]
    total = TimeStatistics(
        count=min((each.count for each in found), default=0),
        min=sum(each.min for each in found),
        mean=sum((each.mean for each in found), start=found[0].mean * 0) if found else 0,  # type: ignore[arg-type]
        max=sum(each.max for each in found),
        variance=None,
    )
    name = _SUM.join(each.name for each in parts)
    statistics = total if len(found) == len(parts) else None
    return Series(kind=parts[0].kind, name=name, quantity=parts[0].quantity, statistics=statistics, method="sum of means")
