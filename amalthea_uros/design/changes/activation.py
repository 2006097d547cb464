"""Activations: period, offset and jitter of stimuli and of their processes; when messages are due, and how they arrive."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from amalthea_uros.design.changes.key import (
    STIMULI,
    UNSET,
    Configuration,
    Key,
    duration,
    positive_duration,
    process_place,
    unused,
)
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.names import require
from amalthea_uros.perf.distributions import Constant, Distribution, Uniform, highest
from amalthea_uros.perf.events import StimulusEvent
from amalthea_uros.perf.software import Process
from amalthea_uros.perf.stimuli import Arrivals, Burst, Counter, Periodic, RelativePeriodic, Stimulus, Synthetic
from amalthea_uros.perf.system import System
from amalthea_uros.timing.activation.releases import counters, first_time, known_releases, nominal_period, with_counters
from amalthea_uros.timing.basics.stated_times import KeptTime
from amalthea_uros.units import Time, time_text

#: The classes of stimuli that have each key.
_HOLDERS: dict[str, tuple[type[Stimulus], ...]] = {
    "period": (Periodic, Synthetic, Burst),
    "offset": (Periodic, RelativePeriodic, Synthetic, Burst),
    "jitter": (Periodic,),
}


def _jitter(text: str) -> Distribution[int] | None:
    """A delay from 0 to a maximum, as the jitter in an app.yaml; no jitter has no distribution."""
    upper = duration(text)
    return Uniform(lower=0, upper=upper) if upper else None


def _jitter_text(jitter: Distribution[int] | None) -> str:
    upper = 0 if jitter is None else highest(jitter)
    return "unbounded" if upper is None else time_text(upper)


_FIELDS: dict[str, tuple[Callable[[str], Any], Callable[[Any], str]]] = {
    "period": (positive_duration, time_text),
    "offset": (duration, time_text),
    "jitter": (_jitter, _jitter_text),
}


def _stimulus_key(field: str, parse: Callable[[str], Any], text: Callable[[Any], str]) -> Key[Any]:
    def show(configuration: Configuration, name: str) -> str:
        return _shown(configuration.system.stimuli_by_name[name], field, text)

    def with_value(configuration: Configuration, name: str, value: object) -> Configuration:
        stimulus = configuration.system.stimuli_by_name[name]
        _check_holder(stimulus, field, f"the stimulus {name!r}")
        fields = _fields(stimulus, field, value)
        return configuration._replace(system=STIMULI.with_fields(configuration.system, name, **fields))

    return Key(parse, show, with_value)


def _process_key(field: str, parse: Callable[[str], Any], text: Callable[[Any], str]) -> Key[Any]:
    def show(configuration: Configuration, name: str) -> str:
        found = _stimuli(configuration.system.processes[name], configuration.system)
        return _shown(found[0], field, text) if len(found) == 1 else UNSET

    def with_value(configuration: Configuration, name: str, value: object) -> Configuration:
        return configuration._replace(system=_with_process_value(configuration.system, name, field, value))

    return Key(parse, show, with_value)


def _shown(stimulus: Stimulus, field: str, text: Callable[[Any], str]) -> str:
    if field == "period" and isinstance(stimulus, RelativePeriodic) and isinstance(stimulus.distance, Constant):
        return text(stimulus.distance.value) if stimulus.has_maximum else UNSET
    return text(getattr(stimulus, field)) if isinstance(stimulus, _HOLDERS[field]) else UNSET


def _is_period_of_any_phase(stimulus: Stimulus) -> bool:
    """Whether all distances are the same, so that they are the period, but nothing is known of the phase."""
    return isinstance(stimulus, RelativePeriodic) and isinstance(stimulus.distance, Constant) and stimulus.has_maximum


def _fields(stimulus: Stimulus, field: str, value: object) -> dict[str, Any]:
    """The fields that a value replaces."""
    if field == "period" and _is_period_of_any_phase(stimulus):
        return {"distance": Constant(value)}
    return {field: value}


def _stimuli(process: Process, system: System) -> list[Stimulus]:
    return [system.stimuli_by_name[name] for name in process.stimuli if name in system.stimuli_by_name]


def _check_holder(stimulus: Stimulus, field: str, what: str) -> None:
    if not isinstance(stimulus, _HOLDERS[field]) and not (field == "period" and _is_period_of_any_phase(stimulus)):
        classes = ", ".join(holder.__name__ for holder in _HOLDERS[field])
        raise InvalidArgumentError(f"{what} is {type(stimulus).__name__}, which has no {field}; these have one: {classes}")


def _with_process_value(system: System, name: str, field: str, value: Any) -> System:
    """The system in which the only stimulus of a process has another value; other processes keep theirs."""
    process = system.processes[name]
    found = _stimuli(process, system)
    if field == "period" and not process.stimuli:
        # Nothing activates it yet. Only the distance of its activations is stated, so nothing is known of the phase.
        added = RelativePeriodic(
            name=unused(f"period of {name}", system.stimuli_by_name), distance=Constant(value), has_maximum=True
        )
        return process_place(process).with_fields(STIMULI.with_item(system, added), name, stimuli=(added.name,))
    if len(found) != 1:
        names = ", ".join(stimulus.name for stimulus in found)
        reason = f"has several stimuli ({names}); change one of these" if found else f"has no stimulus; state {name}.period"
        raise InvalidArgumentError(f"{name!r} {reason}")
    stimulus = found[0]
    _check_holder(stimulus, field, f"the stimulus {stimulus.name!r} of {name!r}")
    fields = _fields(stimulus, field, value)
    if sum(stimulus.name in other.stimuli for other in system.processes.values()) == 1:
        return STIMULI.with_fields(system, stimulus.name, **fields)
    if any(isinstance(event, StimulusEvent) and event.stimulus == stimulus.name for event in system.events.events):
        message = f"{stimulus.name!r} activates other processes, too, and an event refers to it; change {stimulus.name}.{field}"
        raise InvalidArgumentError(f"the stimulus {message} for all of them")
    own = replace(stimulus, name=unused(f"{stimulus.name} of {name}", system.stimuli_by_name), **fields)
    renamed = tuple(own.name if each == stimulus.name else each for each in process.stimuli)
    return process_place(process).with_fields(STIMULI.with_item(system, own), name, stimuli=renamed)


def _show_stimulus(configuration: Configuration, name: str) -> str:
    return ", ".join(configuration.system.processes[name].stimuli) or UNSET


def _set_stimulus(configuration: Configuration, name: str, stimulus: str) -> Configuration:
    """Let a stimulus of the system activate a process, in place of those that do."""
    system = configuration.system
    require("stimulus", [stimulus], system.stimuli_by_name)
    return configuration._replace(system=process_place(system.processes[name]).with_fields(system, name, stimuli=(stimulus,)))


#: The keys of stimuli, and of processes.
STIMULUS_KEYS = {field: _stimulus_key(field, *functions) for field, functions in _FIELDS.items()}
PROCESS_KEYS: dict[str, Key[Any]] = {
    **{field: _process_key(field, *functions) for field, functions in _FIELDS.items()},
    "stimulus": Key(str, _show_stimulus, _set_stimulus),
}


def _show_phase(configuration: Configuration, source: str) -> str:
    process, counter = _first(configuration.system, source)
    phase = configuration.settings.phases.get(source)
    if phase is None and counter.is_phase_known and counter.arrivals is None:
        phase = first_time(process, counter, configuration.system)
    return UNSET if phase is None else time_text(phase)


def _set_phase(configuration: Configuration, source: str, phase: Time) -> Configuration:
    settings = configuration.settings
    return configuration._replace(settings=replace(settings, phases={**settings.phases, source: KeptTime(phase)}))


def _show_period(configuration: Configuration, source: str) -> str:
    system = configuration.system
    process, counter = _first(system, source)
    period = nominal_period(system.processes[process], counter, system)
    return UNSET if period is None else time_text(period)


def _show_jitter(configuration: Configuration, source: str) -> str:
    _, counter = _first(configuration.system, source)
    return time_text((counter.arrivals or Arrivals()).jitter)


def _first(system: System, source: str) -> tuple[str, Counter]:
    return next((process, counter) for process, counter in counters(system) if counter.source == source)


def _set_period(configuration: Configuration, source: str, period: Time) -> Configuration:
    """Change how often messages arrive; if all that take them have periods that divide it, they stay regular."""
    system = configuration.system

    def changed(process: Process, counter: Counter) -> Counter:
        if counter.source != source:
            return counter
        releases = known_releases(process, system)
        if counter.arrivals is None and releases is not None and period % releases.period == 0:
            return replace(counter, prescaler=period // releases.period)
        return replace(counter, arrivals=replace(counter.arrivals or Arrivals(), period=period))

    return configuration._replace(system=with_counters(system, changed))


def _arrivals_key(field: str, parse: Callable[[str], Time], show: Callable[[Configuration, str], str]) -> Key[Time]:
    """The key for a field of the arrivals of all that take a message."""

    def with_value(configuration: Configuration, source: str, value: Time) -> Configuration:
        fields: dict[str, Any] = {field: value}

        def changed(process: Process, counter: Counter) -> Counter:
            if counter.source != source:
                return counter
            return replace(counter, arrivals=replace(counter.arrivals or Arrivals(), **fields))

        return configuration._replace(system=with_counters(configuration.system, changed))

    return Key(parse, show, with_value)


#: Most callbacks have a task of the same name with a period and a jitter of its own, so those of arrivals have other names.
MESSAGE_KEYS: dict[str, Key[Any]] = {
    "phase": Key(duration, _show_phase, _set_phase),
    "arrival_period": Key(positive_duration, _show_period, _set_period),
    "arrival_jitter": _arrivals_key("jitter", duration, _show_jitter),
}
