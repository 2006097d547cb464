"""Event chains in words: latencies in tables, the headline of a message chain, and why the parts of a latency take their time."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from amalthea_uros._internal.plural import counted
from amalthea_uros.analyze.results.chains import ChainResult, LatencyQuantity, LatencyValue
from amalthea_uros.analyze.results.explanations import CauseKind, LatencyCause, ProcessHop
from amalthea_uros.report.wording.cells import at_least, at_most
from amalthea_uros.units import Rounding, Time, rounded_time_text, time_text

#: The headline quantities: `reaction` and `data age` are what the limits of these names are compared with.
LATENCY_COLUMNS = {
    "min": LatencyQuantity.MIN_FIRST_TO_FIRST,
    "mean": LatencyQuantity.MEAN_FIRST_TO_FIRST,
    "reaction": LatencyQuantity.MAX_REDUCED_REACTION_TIME,
    "data age": LatencyQuantity.MAX_REDUCED_DATA_AGE,
}
_SHORT_NAMES = {quantity: column for column, quantity in LATENCY_COLUMNS.items() if quantity.is_upper}
CHAINS_HEADING = (
    "Event chains (from the stimulus to the first response based on it; data age: from the latest stimulus to each response)"
)


def latency_cells(chain: ChainResult, columns: Iterable[str]) -> tuple[str, ...]:
    """The cells of a chain: its values, and their claims or why they are missing."""
    values = [chain.value(LATENCY_COLUMNS[column]) for column in columns]
    claims = dict.fromkeys(str(value.claim) for value in values if value is not None)
    return (*map(value_text, values), chain.reason or ", ".join(claims))


def value_text(value: LatencyValue | None) -> str:
    """A latency that is still a bound when it has lost digits, or a dash."""
    if value is None or value.value is None:
        return "-"
    return rounded_time_text(value.value, _rounding(value.quantity))


def _rounding(quantity: LatencyQuantity) -> Rounding:
    if quantity.is_mean:
        return Rounding.NEAREST
    return Rounding.UP if quantity.is_upper else Rounding.DOWN


def quantity_text(quantity: LatencyQuantity) -> str:
    """The full name of a quantity, with the short one of the tables and limits if it has one."""
    name = quantity.replace("_", " ")
    return f"{name} ({_SHORT_NAMES[quantity]})" if quantity in _SHORT_NAMES else name


#: Of a table with a row for each chain; the last column has none.
MESSAGE_COLUMNS = ("chain", "from", "to", "~>best", ">worst")
#: Parts of a latency that its line names.
_LARGEST = 2


def message_chain_row(chain: ChainResult) -> tuple[str, ...]:
    """The latency of a chain with a remark, in a row of a table."""
    best, worst = at_least(chain.best), at_most(chain.worst)
    return (chain.name, chain.start, chain.end, best, worst, remark(chain))


def headline(chain: ChainResult) -> str:
    """The latency of a chain in a sentence."""
    latency, best = f"Worst latency from {chain.start} to {chain.end}", at_least(chain.best)
    if chain.worst is None:
        least = "" if chain.best is None else f", at least {best}"
        return f"{latency}: unknown{least}; {remark(chain)}"
    return f"{latency}: {at_most(chain.worst)} (bound), best {best}; {remark(chain)}"


def remark(chain: ChainResult) -> str:
    """What takes most of the latency of a chain, or why it is unknown."""
    if chain.worst_if_not_lost is None:
        return f"{chain.reason}. {chain.remedy}" if chain.remedy else chain.reason
    if chain.loss:
        return f"at most {at_most(chain.worst_if_not_lost)} for messages that are not lost; {chain.loss}"
    largest = sorted(_largest_parts(chain), key=lambda part: -part[1])[:_LARGEST]
    return f"most of it: {', '.join(f'{name} {at_most(time)}' for name, time in largest)}"


def _largest_parts(chain: ChainResult) -> Iterator[tuple[str, Time]]:
    for hop in chain.hops:
        owner = f"{hop.kind} {hop.name}"
        named = [(f"{part.name} ({owner})", part.most) for part in hop.parts if part.most is not None and part.most > 0]
        yield from named or [(owner, hop.worst or 0)]


def cause_text(cause: LatencyCause, hop: ProcessHop) -> str:
    """Why a part of a hop takes its time, said of its process: "waits for its next job, which runs every 20 ms"."""
    match cause.kind:
        case CauseKind.JUST_MISSED:
            return f"just missed: it has read, and reads again {_period(hop)} later"
        case CauseKind.NEXT_JOB if hop.period is not None and cause.time > hop.one_in * hop.period:
            return f"still reads this value, every {_period(hop)}, until a new one comes"
        case CauseKind.NEXT_JOB:
            return f"waits for its next job{_that_takes_part(hop)}, {_every(hop)}"
        case CauseKind.INTERFERENCE:
            return f"{cause.process} executes first ({counted(cause.jobs, 'job')})"
        case CauseKind.PREEMPTION:
            return f"preempted by {cause.process} ({counted(cause.jobs, 'job')})"
        case CauseKind.EXECUTION:
            return "executes"
        case CauseKind.LOGICAL:
            return "LET: published at the end of the period"
        case CauseKind.FULL_PERIOD:
            return f"waits for its next job a whole period, {_period(hop)}"
        case CauseKind.READ_DELAY:
            return "from its release to its read"
        case CauseKind.RESPONSE:
            terms = ", ".join(f"{name} {time_text(time)}" for name, time in cause.terms)
            return "ends at the latest" + (f": {terms}" if terms else "")
        case CauseKind.TRIGGERED:
            return "triggered: its response time"


def _that_takes_part(hop: ProcessHop) -> str:
    return f" that takes part: 1 in {hop.one_in:,}" if hop.one_in > 1 else ""


def _every(hop: ProcessHop) -> str:
    if hop.period is None:
        return "at unknown intervals"
    return f"{'' if hop.one_in > 1 else 'which runs '}every {time_text(hop.period)}"


def _period(hop: ProcessHop) -> str:
    return "some time" if hop.period is None else time_text(hop.period)
