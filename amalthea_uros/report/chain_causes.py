"""In words, why the parts of a latency take their time."""

from __future__ import annotations

from amalthea_uros._internal.plural import counted
from amalthea_uros.analyze.explanations.chain_results import ProcessHop
from amalthea_uros.analyze.explanations.hop_causes import CauseKind, LatencyCause
from amalthea_uros.units import time_text


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
