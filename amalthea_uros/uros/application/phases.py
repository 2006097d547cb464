"""When callbacks are due: every n-th activation of a task, from a phase on that the description states or that is unknown.

A message comes from outside, and a timer starts when it is initialised, so that nobody knows in which activation of the executor they
are due for the first time.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from amalthea_uros._internal.records import dataclass
from amalthea_uros.perf.stimuli import Arrivals, Counter
from amalthea_uros.spec.executors import ExecutorSection
from amalthea_uros.units import Time, time_text
from amalthea_uros.uros.application.callbacks import Callback
from amalthea_uros.uros.application.notes import Notes


@dataclass(frozen=True, slots=True)
class ExecutorPhases:
    """The activations of the executor in which callbacks are due.

    Attributes
    ----------
    stated : the phases that the description states, by callback
    jitters : the jitters of messages, by callback; 0 for timers
    """

    executor: ExecutorSection
    period: Time
    stated: Mapping[str, Time]
    jitters: Mapping[str, Time]

    @classmethod
    def of(cls, executor: ExecutorSection, period: Time, callbacks: Iterable[Callback]) -> ExecutorPhases:
        """The phases that callbacks state."""
        of_all = tuple(callbacks)
        stated = {c.name: c.section.phase for c in of_all if c.section.phase is not None}
        return cls(executor, period, stated, {c.name: c.jitter for c in of_all})

    def counter(self, callback: Callback, interval: Time, waits_for: str | None = None) -> Counter | None:
        """The counter of the calls of the executor for a callback; None if it is due in every activation.

        Parameters
        ----------
        interval : minimum time between two calls
        waits_for : the callback or executor with which it is due, if not on its own
        """
        source = waits_for or callback.name
        phase = self.stated.get(source)
        first = None if phase is None else (phase - self.executor.offset) // self.period + 1
        # Who waits for all waits for the latest one.
        jitter = self.jitters[source] if source in self.jitters else max(self.jitters.values(), default=0)
        return call_counter(interval, self.period, source, first, jitter)

    def check(self, callback: Callback, counted: bool, notes: Notes) -> None:
        """Report a phase that is not an activation of the executor, or that has no effect.

        Parameters
        ----------
        counted : whether a counter has the phase
        """
        phase = self.stated.get(callback.name)
        if phase is None:
            return
        subject, location = f"the phase {time_text(phase)} of {callback.name!r}", callback.section.location("phase")
        offset, period = self.executor.offset, self.period
        if phase < offset or (phase - offset) % period:
            grid = f"{time_text(offset)} + n * {time_text(period)}"
            message = f"{subject} is not an activation of the executor, which are at {grid}"
            notes.error("APP003", message, location, "Set the time of an activation, or remove 'phase' to analyse all phases.")
        elif not counted:
            notes.error(
                "APP003",
                f"{subject} has no effect: it is not due on its own in every n-th activation",
                location,
                "Remove 'phase'.",
            )


def call_counter(interval: Time, period: Time, source: str, first: int | None, jitter: Time) -> Counter | None:
    """The counter of a call that is due once per interval in a task of a period; None if it is due in every activation.

    If the interval is no multiple of the period, the number of activations in between varies by one. The smaller one is the prescaler,
    and there is no single phase.

    Parameters
    ----------
    first : number of the first activation in which it is due; None if unknown
    """
    prescaler = max(1, interval // period)
    if jitter:
        arrivals = Arrivals(period=interval if interval % period else None, jitter=jitter)
        return Counter(
            prescaler=prescaler, offset=first or 0, source=source, is_phase_known=first is not None, arrivals=arrivals
        )
    if interval > period and interval % period:
        return Counter(prescaler=prescaler, is_phase_known=False)
    if prescaler == 1:
        return None
    return Counter(prescaler=prescaler, offset=first or 0, source=source, is_phase_known=first is not None)


def own_task_counter(callback: Callback, period: Time) -> Counter | None:
    """The counter of a callback in its own task: a phase that is stated is followed by the next activation of the task."""
    phase = callback.section.phase
    first = None if phase is None else max(0, -(-(phase - callback.section.offset) // period)) + 1
    return call_counter(callback.nominal_interval, period, callback.name, first, callback.jitter)
