"""Cells of tables: times, loads, verdicts, claims and activations, rounded so that bounds remain bounds; and the order of rows."""

from __future__ import annotations

from fractions import Fraction
from math import ceil, inf
from typing import TYPE_CHECKING

from amalthea_uros.analyze.results.processes import ProcessorResult, ProcessResult, RequirementResult
from amalthea_uros.diagnostics import Severity
from amalthea_uros.judge.summary import Schedulable
from amalthea_uros.judge.verdict import ObservedVerdict, Verdict
from amalthea_uros.perf.network import Network, WireKind
from amalthea_uros.perf.stimuli import (
    ArrivalCurve,
    Burst,
    EventTriggered,
    InterProcess,
    Periodic,
    RelativePeriodic,
    Single,
    Stimulus,
    Synthetic,
    VariableRate,
)
from amalthea_uros.report.basics.document import Badge, Tone
from amalthea_uros.timing.response import Response
from amalthea_uros.units import (
    Frequency,
    Rounding,
    Time,
    bit_rate_text,
    frequency_text,
    number_text,
    rounded,
    rounded_time_text,
    time_text,
)

if TYPE_CHECKING:
    from amalthea_uros.simulate.observations import MetricObservation

UNKNOWN = "unknown"

_TONES = {
    Verdict.MET: Tone.GOOD,
    Verdict.MISSED: Tone.BAD,
    Verdict.UNBOUNDED: Tone.BAD,
    Verdict.UNKNOWN: Tone.UNKNOWN,
    ObservedVerdict.OK: Tone.GOOD,
    ObservedVerdict.MISSED: Tone.BAD,
    ObservedVerdict.NOT_OBSERVED: Tone.UNKNOWN,
    Schedulable.YES: Tone.GOOD,
    Schedulable.NO: Tone.BAD,
    Schedulable.UNKNOWN: Tone.UNKNOWN,
    Severity.ERROR: Tone.BAD,
    Severity.WARNING: Tone.UNKNOWN,
    Severity.INFO: Tone.NEUTRAL,
}


def at_most(value: Time | Fraction | None, limit: Time | None = None) -> str:
    """A maximum, rounded up, but not beyond the limit."""
    return UNKNOWN if value is None else rounded_time_text(value, Rounding.UP, limit)


def at_least(value: Time | Fraction | None, limit: Time | None = None) -> str:
    """A minimum, rounded down."""
    return UNKNOWN if value is None else rounded_time_text(value, Rounding.DOWN, limit)


def about(value: Time | Fraction | None, limit: Time | None = None) -> str:
    """A mean."""
    return UNKNOWN if value is None else rounded_time_text(value, Rounding.NEAREST, limit)


def exactly(value: Time | None, nothing: str = "-") -> str:
    """A time with all its digits."""
    return nothing if value is None else time_text(value)


def response_ends(response: Response | None, limit: Time | None) -> tuple[str, str]:
    """The best-case and the worst-case response time."""
    if response is None:
        return UNKNOWN, UNKNOWN
    return at_least(response.best), at_most(response.worst, limit)


def observed(found: MetricObservation | None, limit: Time | None = None) -> tuple[str, str, str]:
    """Minimum, mean and maximum of what was observed."""
    if found is None:
        return "-", "-", "-"
    return at_least(found.min, limit), about(found.mean, limit), at_most(found.max, limit)


def deadline_text(deadline: Time | None, is_implicit: bool = False) -> str:
    """A deadline, and whether it is the period."""
    return "-" if deadline is None else f"{'period ' if is_implicit else ''}{time_text(deadline)}"


def priority_text(priority: int | None, is_isr: bool) -> str:
    """A priority, and whether it is that of an interrupt."""
    return UNKNOWN if priority is None else f"{'ISR ' if is_isr else ''}{priority}"


def load_text(load: Fraction | None, rounding: Rounding = Rounding.NEAREST) -> str:
    """A load in percent with four significant digits; bounds are rounded so that they remain bounds."""
    return UNKNOWN if load is None else f"{number_text(rounded(load * 100, rounding, 100))} %"


def load_cells(core: ProcessorResult, network: Network) -> tuple[str, ...]:
    """The name of a core or wire, its clock or bit rate, and its best, mean and worst load as far as they are known."""
    is_partly_known = core.worst is None and core.at_least
    return (
        core.name,
        _clock_or_bit_rate(core, network),
        load_text(core.best, Rounding.DOWN),
        load_text(core.mean),
        f"at least {load_text(core.at_least, Rounding.DOWN)}" if is_partly_known else load_text(core.worst, Rounding.UP),
    )


def _clock_or_bit_rate(core: ProcessorResult, network: Network) -> str:
    """A wire with a table of times has no bit rate: its clock only counts nanoseconds."""
    kind = next((wire.kind for wire in network.wires if core.name in wire.cores), None)
    if kind is WireKind.CUSTOM:
        return "-"
    if not core.frequency:
        return UNKNOWN
    return frequency_text(core.frequency) if kind is None else bit_rate_text(int(core.frequency))


def limited_text(quantity: str, of: str) -> str:
    """What is limited: a quantity, and of which object if it is of one."""
    return f"{quantity} of {of}" if of else quantity


def directed_limit(limit: str, *, is_upper: bool) -> str:
    """A limit with its direction, such as "at most 1 ms"."""
    return f"at {'most' if is_upper else 'least'} {limit}"


def clock_text(least: Frequency) -> str:
    """The clock that something needs at least, rounded up to four significant digits."""
    return frequency_text(_rounded_up(least))


def _rounded_up(least: Frequency) -> Frequency:
    size = 10 ** max(0, len(str(int(least))) - 4)
    return Fraction(rounded(least / size, Rounding.UP) * size)


def relief(core: ProcessorResult, *, is_wire: bool = False) -> str:
    """The least demand of an overloaded core or wire: shorter times, or a faster clock; to meet limits it can take more."""
    load = core.at_least
    if is_wire:
        least = None if core.frequency is None else bit_rate_text(ceil(_rounded_up(core.frequency * load)))
        rate = "a higher bit rate" if least is None else f"at least {least} as bit rate"
        return f"{rate}, or fewer or smaller messages"
    clock = "a faster clock" if core.frequency is None else f"a clock of at least {clock_text(core.frequency * load)}"
    return f"execution times of at most {load_text(1 / load, Rounding.UP)} of these, {clock}, or processes on another core"


def share_text(share: Fraction | float | None) -> str:
    """A part of a whole in percent."""
    return "" if share is None else f"{float(share):.1%}"


def words(name: str) -> str:
    """A name of JSON as words."""
    return name.replace("_", " ")


def shortened(text: str | None, most: int) -> str:
    """A text on one line that is not too long."""
    line = " ".join((text or "").split())
    return line if len(line) <= most else f"{line[: most - 3]}..."


def badge(value: Verdict | ObservedVerdict | Severity | None, word: str = "") -> Badge:
    """A verdict or a severity; without one, there was nothing to judge."""
    if value is None:
        return Badge("no limit", Tone.NEUTRAL)
    return Badge(word or words(value), _TONES[value])


def verdict_badge(item: ProcessResult | RequirementResult) -> Badge:
    """The verdict on a process or a requirement, with what is wrong."""
    return badge(item.verdict, str(item.failure or "") if isinstance(item, ProcessResult) else "")


def tone_of(schedulable: Schedulable) -> Tone:
    """That of the verdict on a system."""
    return _TONES[schedulable]


def by_core_and_priority(core: str | None, is_isr: bool, priority: int | None) -> tuple[bool, str, bool, float]:
    """Sorts by core, and there by priority: what preempts others comes before them; unknown cores and priorities come last."""
    return (core is None, core or "", not is_isr, inf if priority is None else -priority)


_ACTIVATIONS: dict[type, str] = {
    RelativePeriodic: "sporadic",
    InterProcess: "triggered",
    EventTriggered: "by events",
    Synthetic: "at listed times",
    VariableRate: "at a variable rate",
    ArrivalCurve: "by an arrival curve",
}


def activation_text(stimulus: Stimulus) -> str:
    """When a stimulus activates, in a few words."""
    match stimulus:
        case Periodic(period=period, offset=offset):
            return f"every {time_text(period)}" + (f" from {time_text(offset)}" if offset else "")
        case Burst(period=period, count=count):
            return f"{count} times every {time_text(period)}"
        case Single(time=time):
            return f"once at {time_text(time)}"
    return _ACTIVATIONS.get(type(stimulus), "by a custom stimulus")
