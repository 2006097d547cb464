"""Messages that do not arrive regularly, as analyses see them.

A job takes a message that arrived before its activation. Messages with period T and jitter J are taken by jobs with period P: in the
long run by every floor(T / P)-th job or fewer, and up to ceil(J / P) jobs later than regular ones. So the number of jobs in a sequence
that take one is bounded as events of an event model with jitter are (K. Richter, "Compositional Scheduling Analysis Using Standard
Event Models", TU Braunschweig 2005). Which jobs these are is unknown.
"""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.perf.software import Process
from amalthea_uros.perf.stimuli import Arrivals, Counter
from amalthea_uros.perf.system import System
from amalthea_uros.timing.phases import counters, with_counters
from amalthea_uros.timing.releases import activation_period, known_releases
from amalthea_uros.units import Time, time_text


def arriving(system: System) -> list[str]:
    """The names of the messages that arrive irregularly."""
    return list(dict.fromkeys(counter.source for _, counter in counters(system) if counter.arrivals is not None))


def nominal_period(process: Process, counter: Counter, system: System) -> Time | None:
    """The nominal time from one message that a counter represents to the next; None if it is unknown."""
    arrivals = counter.arrivals or Arrivals()
    if arrivals.period is not None:
        return arrivals.period
    period = activation_period(process, system)
    return None if period is None else counter.prescaler * period


def with_bounded_arrivals(system: System) -> System:
    """The system in which irregular arrivals are counters that can be late; itself if there are none."""
    if not any(counter.arrivals for _, counter in counters(system)):
        return system
    return with_counters(system, lambda process, counter: _bounded(process, counter, system))


def _bounded(process: Process, counter: Counter, system: System) -> Counter:
    if counter.arrivals is None:
        return counter
    releases, interval = known_releases(process, system), nominal_period(process, counter, system)
    if releases is None or interval is None:
        return Counter(is_phase_known=False, jitter=counter.prescaler)
    late = -(-counter.arrivals.jitter // releases.period)
    return Counter(prescaler=max(1, interval // releases.period), is_phase_known=False, jitter=late)


def arrival_assumptions(system: System) -> Iterator[str]:
    """What is assumed about irregular arrivals, in sentences."""
    for name, counter in counters(system):
        if counter.arrivals is not None:
            interval = nominal_period(system.processes[name], counter, system)
            every = "" if interval is None else f" every {time_text(interval)}"
            jitter = time_text(counter.arrivals.jitter)
            yield f"{counter.source} is due{every} with a jitter of {jitter}: it is unknown in which jobs of {name}"
