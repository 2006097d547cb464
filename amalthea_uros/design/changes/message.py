"""Messages and timers of the executor: when they are due for the first time, and how they arrive."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from amalthea_uros.design.changes.key import UNSET, Configuration, Key
from amalthea_uros.design.changes.values import duration, positive_duration
from amalthea_uros.perf.software import Process
from amalthea_uros.perf.stimuli import Arrivals, Counter
from amalthea_uros.perf.system import System
from amalthea_uros.timing.activation.phases import counters, first_time, nominal_period, with_counters
from amalthea_uros.timing.activation.releases import known_releases
from amalthea_uros.units import Time, time_text


def _show_phase(configuration: Configuration, source: str) -> str:
    process, counter = _first(configuration.system, source)
    phase = configuration.settings.phases.get(source)
    if phase is None and counter.is_phase_known and counter.arrivals is None:
        phase = first_time(process, counter, configuration.system)
    return UNSET if phase is None else time_text(phase)


def _set_phase(configuration: Configuration, source: str, phase: Time) -> Configuration:
    settings = configuration.settings
    return configuration._replace(settings=replace(settings, phases={**settings.phases, source: phase}))


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
