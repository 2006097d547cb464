"""The explanation of a response time or of the latency of a chain for people."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import NamedTuple

from amalthea_uros._internal.plural import counted
from amalthea_uros.analyze.results.analysis import Judged
from amalthea_uros.analyze.results.chains import LatencyValue
from amalthea_uros.analyze.results.explanations import (
    CallbackExplanation,
    ChainExplanation,
    ExecutionShare,
    OriginKind,
    ProcessExplanation,
)
from amalthea_uros.analyze.results.processes import CallbackResult, ProcessResult
from amalthea_uros.design.improvements import Improvements
from amalthea_uros.executors.results import HandleResult
from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.perf.executors import HandleKind
from amalthea_uros.perf.stimuli import Counter
from amalthea_uros.report.hops import write_hops
from amalthea_uros.report.text import improvements
from amalthea_uros.report.wording.chains import cause_text, write_hops_of_chain
from amalthea_uros.report.writers.terminal import Terminal
from amalthea_uros.services.analyze import Explanation
from amalthea_uros.timing.response import Response
from amalthea_uros.units import Time, percent_text, time_text

#: More executions of the worst case are only counted.
_MOST_EXECUTIONS = 20
#: Of the shares in an execution time, the smaller ones are only added up.
_MOST_SHARES = 20


def write(explanation: Explanation, terminal: Terminal) -> None:
    """Write what a value consists of; if a process and a chain have the name, both are written."""
    if explanation.process is not None:
        _process(explanation.process, terminal)
    if explanation.process is not None and explanation.chain is not None:
        terminal.line()
        terminal.line(f"{explanation.name!r} is also the name of an event chain:")
    for callback in explanation.callbacks:
        _callback(callback, terminal)
    if explanation.chain is not None:
        _chain(explanation.chain, explanation.improvements, terminal)


def _process(explanation: ProcessExplanation, terminal: Terminal) -> None:
    """Write the terms of a response time, whose jobs interfere, and what the execution time consists of."""
    process = explanation.process
    response, name = process.response, terminal.style(process.name, "1")
    if response is None:
        terminal.line(f"{name}: response time unknown: {process.reason}")
    elif response.worst is None:
        terminal.line(f"{name}: response time unbounded: {response.reason}")
    else:
        terminal.line(f"{name}: worst-case response time {time_text(response.worst)} ({response.claim})")
        _deadline(process, terminal)
        _largest_term(explanation, response, response.worst, terminal)
        _terms(response, response.worst, explanation, terminal)
    _origins(explanation, terminal)
    _loads(explanation, terminal)
    _execution(explanation, terminal)
    _callbacks(explanation, terminal)


def _deadline(process: ProcessResult, terminal: Terminal) -> None:
    """Write how far the response time is from the deadline, or what else is wrong."""
    if process.deadline is None or process.margin is None or process.verdict is None:
        return
    kind = "period" if process.is_implicit else "deadline"
    is_about_time = process.margin < 0 or process.verdict is Verdict.MET
    why = _margin(process, process.margin) if is_about_time else process.reason
    terminal.line(f"  {kind} {time_text(process.deadline)}: {process.failure or process.verdict}, {why}")


def _margin(judged: Judged, margin: Time) -> str:
    """How far a value is from its limit; of a bound beyond the limit it is unknown how far the value itself is."""
    if margin >= 0:
        return f"{time_text(margin)} left"
    distance = f"{time_text(-margin)} {'beyond' if judged.is_upper else 'short of'} the limit"
    return f"the bound is {distance}" if judged.verdict is Verdict.UNKNOWN else distance


def _largest_term(explanation: ProcessExplanation, response: Response, worst: Time, terminal: Terminal) -> None:
    """Write what takes the largest part of a response time, if it has several parts."""
    shares = {f"interference by {share.name}": share.time for share in explanation.shares}
    terms = {term: time for term, time in response.terms.items() if time and not (term == "interference" and shares)}
    parts = {**terms, **shares}
    if len(parts) > 1:
        name = max(parts, key=lambda part: parts[part])
        terminal.line(f"  largest part: {time_text(parts[name])} ({parts[name] / worst:.1%}), {name}")


def _callbacks(explanation: ProcessExplanation, terminal: Terminal) -> None:
    """Write when the callbacks of an executor end, in the order of their calls, unless nothing is known of them."""
    callbacks = explanation.callbacks
    if not callbacks or explanation.origins:
        return
    rows = [
        (each.name, _response_text(each), "-" if each.deadline is None else time_text(each.deadline), _claim(each))
        for each in callbacks
    ]
    terminal.table(("callback", "ends at most after", "deadline", ""), rows, right=(1, 2))


def _callback(explanation: CallbackExplanation, terminal: Terminal) -> None:
    """Write when a callback ends, and what the jobs of its process execute up to it."""
    callback, process = explanation.callback, explanation.process
    name = terminal.style(callback.name, "1")
    terminal.line(f"{name}: worst-case response time {_response_text(callback)} ({_claim(callback)}), in {process.name}")
    if callback.deadline is not None and not explanation.handles:
        terminal.line(f"  from the activation of {process.name}; deadline {time_text(callback.deadline)}")
    for handle in explanation.handles:
        _handle(handle, terminal)
    if explanation.execution:
        rows = [(share.name, _calls(share), _jobs(share.counter), _time(share.time)) for share in explanation.execution]
        terminal.table(("executed up to its end", "calls", "in jobs", "time"), rows, right=(1, 3))
    if callback.response is not None:
        terminal.line(f"  {callback.response.method}")
        terminal.line(f"  {callback.response.source}")


def _handle(handle: HandleResult, terminal: Terminal) -> None:
    """Write what a handle of an executor that spins in a loop waits for, and how something is lost."""
    release = "when it is due" if handle.kind is HandleKind.TIMER else "when it has arrived at the controller"
    interval = "" if handle.interval is None else f"; every {time_text(handle.interval)} at most"
    terminal.line(f"  {handle.kind.value} {handle.name}, from {release}{interval}")
    if handle.terms:
        rows = [(term.name, _time(term.most), _share_of(term.most, handle), term.why) for term in handle.terms]
        terminal.table(("in the worst case", "time", "", ""), rows, right=(1, 2))
    if handle.lost is not None:
        terminal.line(f"  {handle.lost.what} {'are' if handle.lost.is_certain else 'can be'} lost: {handle.lost.sequence}")


def _share_of(part: Time | None, handle: HandleResult) -> str:
    return f"{part / handle.response.worst:.1%}" if handle.response.worst and part is not None else ""


def _response_text(callback: CallbackResult) -> str:
    return "unknown" if callback.response is None else _time(callback.response.worst)


def _claim(callback: CallbackResult) -> str:
    return callback.reason or ("" if callback.response is None else str(callback.response.claim))


def _origins(explanation: ProcessExplanation, terminal: Terminal) -> None:
    """Write why there is no bound, and what would give one."""
    if not explanation.origins:
        return
    terminal.line("  what would give it a bound")
    for origin in explanation.origins:
        if origin.process != explanation.process.name:
            terminal.line(f"    {origin.process}: {origin.reason}")
        elif origin.kind is OriginKind.OVERLOAD and (excess := _excess(explanation)):
            terminal.line(f"    Reduce the load by {excess} of the core.")
        if origin.remedy:
            terminal.line(f"    {origin.remedy}")


def _excess(explanation: ProcessExplanation) -> str:
    load = explanation.load
    return "" if load is None or load <= explanation.supply else f"at least {float(load - explanation.supply):.1%}"


def _terms(response: Response, worst: Time, explanation: ProcessExplanation, terminal: Terminal) -> None:
    terms = [(term, time_text(value)) for term, value in response.terms.items() if value]
    terminal.table(("made of", ""), [*terms, ("sum", time_text(worst))], right=(1,))
    if explanation.shares:
        rows = [(share.name, share.jobs, time_text(share.time)) for share in explanation.shares]
        terminal.table(("interference by", "jobs", "time"), rows, right=(1, 2))
    terminal.line(f"  {response.method}")
    terminal.line(f"  {response.source}; {counted(response.jobs, 'job')} examined")


def _execution(explanation: ProcessExplanation, terminal: Terminal) -> None:
    if not explanation.execution:
        return
    wcet = explanation.process.wcet
    rows = [
        (share.name, _calls(share), _jobs(share.counter), _time(share.time), _part(share, wcet), worst)
        for share, worst in zip(explanation.execution, _in_worst_job(explanation), strict=True)
    ]
    shown = _largest(rows, explanation.execution)
    headings = (
        "WCET made of",
        "calls",
        "in jobs",
        "time",
        "share",
        "in the worst job" if any(worst for *_, worst in rows) else "",
    )
    terminal.table(headings, [*shown, ("sum", "", "", _time(wcet), "", "")], right=(1, 3, 4))


def _largest(rows: Sequence[tuple[object, ...]], shares: Sequence[ExecutionShare]) -> list[tuple[object, ...]]:
    """The rows of the largest shares in their order, and one for all others; unknown shares count as the largest."""
    order = sorted(range(len(rows)), key=lambda index: (shares[index].time is not None, -(shares[index].time or 0)))
    shown, others = sorted(order[:_MOST_SHARES]), order[_MOST_SHARES:]
    if not others:
        return list(rows)
    rest = sum(shares[index].time or 0 for index in others)
    return [*(rows[index] for index in shown), (f"{len(others):,} others", "", "", _time(rest), "", "")]


def _in_worst_job(explanation: ProcessExplanation) -> Sequence[str]:
    """Whether the worst job executes each share, if other jobs execute something else."""
    if not explanation.in_worst_job or all(share.counter is None for share in explanation.execution):
        return [""] * len(explanation.execution)
    return ["yes" if is_executed else "no" for is_executed in explanation.in_worst_job]


def _calls(share: ExecutionShare) -> int | str:
    return share.calls if share.is_runnable else ""


def _jobs(counter: Counter | None) -> str:
    return "all" if counter is None or counter.prescaler == 1 else f"1 in {counter.prescaler}"


def _part(share: ExecutionShare, wcet: Time | None) -> str:
    return share.reason if share.time is None or not wcet else f"{share.time / wcet:.1%}"


def _time(value: Time | None) -> str:
    return "?" if value is None else time_text(value)


def _loads(explanation: ProcessExplanation, terminal: Terminal) -> None:
    """Write who needs how much of the core, for a process that does not meet its deadline."""
    if not explanation.loads:
        return
    rows = [
        (load.name, "" if load.priority is None else load.priority, _percent(load.utilisation)) for load in explanation.loads
    ]
    total = [("sum", "", _percent(explanation.load)), ("supply", "", _percent(explanation.supply))]
    terminal.table(("load at this priority or higher", "priority", "load"), [*rows, *total], right=(1, 2))


def _percent(load: Fraction | None) -> str:
    return "?" if load is None else f"{percent_text(load, 3)}%"


def _chain(explanation: ChainExplanation, found: Improvements | None, terminal: Terminal) -> None:
    """Write the largest part of a latency and what shortens it, then the hops, which add up to it, and all causes and changes."""
    name, quantity = terminal.style(explanation.chain.name, "1"), explanation.quantity.replace("_", " ")
    value = explanation.value
    if value is None or value.value is None:
        terminal.line(f"{name}: {quantity} unknown: {explanation.reason}")
        _requirements(explanation, terminal)
    else:
        terminal.line(f"{name}: {quantity} {time_text(value.value)} ({value.claim})")
        _requirements(explanation, terminal)
        _largest_cause(explanation, terminal)
    if found is not None:
        improvements.write_best(found, terminal)
    if explanation.chain.crosses_messages:
        write_hops_of_chain(explanation.chain, terminal)
    elif value is not None and value.value is not None:
        _worst_case(explanation, value, value.value, terminal)
    if found is not None:
        improvements.write(found, terminal)


def _worst_case(explanation: ChainExplanation, value: LatencyValue, total: Time, terminal: Terminal) -> None:
    """Write the way, the hops with their causes, and the executions."""
    if explanation.route:
        terminal.line(f"  {explanation.route}")
    if explanation.hops:
        write_hops(explanation, total, value.claim, terminal)
        _causes(explanation, terminal)
        _executions(explanation, terminal)
    else:
        terminal.line(f"  no single hops: {explanation.reason}")
    terminal.line(f"  {value.method} ({value.source})")


def _requirements(explanation: ChainExplanation, terminal: Terminal) -> None:
    """Write the limits of the chain, with how far the values are from them."""
    for each in explanation.requirements:
        if each.limit is None or each.value is None:
            rest = f": {each.reason}" if each.reason else ""
        else:
            rest = f", {_margin(each, each.margin or 0)}"
        limit = "" if each.limit is None else f" {'at most' if each.is_upper else 'at least'} {time_text(each.limit)}"
        terminal.line(f"  {each.name}, {each.quantity}{limit}: {each.verdict}{rest}")


class _Part(NamedTuple):
    """A wait or a run in a latency."""

    process: str
    kind: str
    time: Time
    reason: str


def _parts(explanation: ChainExplanation) -> list[_Part]:
    """All waits and runs with their causes, in their order."""
    parts = [
        _Part(hop.process, kind, cause.time, cause_text(cause, hop))
        for hop in explanation.hops
        for kind, causes in (("wait", hop.wait_causes), ("run", hop.run_causes))
        for cause in causes
    ]
    if explanation.overwritten:
        parts.append(_Part(explanation.hops[-1].process, "wait", explanation.overwritten, "until it writes again"))
    return parts


def _largest_cause(explanation: ChainExplanation, terminal: Terminal) -> None:
    """Write which wait or run takes the largest part of a latency."""
    largest = max(_parts(explanation), key=lambda part: part.time, default=None)
    if largest is not None:
        share = f"{float(explanation.share(largest.time)):.1%}"
        terminal.line(f"  largest part: {time_text(largest.time)} ({share}), {largest.process}: {largest.reason}")


def _causes(explanation: ChainExplanation, terminal: Terminal) -> None:
    """Write why each wait and each run takes its time, with its share of the latency."""
    rows = [
        (part.process, part.kind, time_text(part.time), f"{float(explanation.share(part.time)):.1%}", part.reason)
        for part in _parts(explanation)
    ]
    terminal.table(("why so long", "", "time", "share", "reason"), _once(rows), right=(2, 3))


def _once(rows: Sequence[tuple[str, ...]]) -> list[tuple[str, ...]]:
    """Rows in which the first cell is empty if it is that of the row before."""
    previous = [("",), *rows]
    return [("" if row[0] == before[0] else row[0], *row[1:]) for before, row in zip(previous, rows, strict=False)]


def _executions(explanation: ChainExplanation, terminal: Terminal) -> None:
    """Write which jobs execute when, as far as they contribute to the latency."""
    found = [(hop, each) for hop in explanation.hops for each in hop.executions]
    if not found:
        return
    rows = [
        (
            each.core,
            f"{each.process}#{each.job}",
            time_text(each.begin),
            time_text(each.end),
            "of the chain" if (each.process, each.job) == (hop.process, hop.job) else f"before {hop.process}",
        )
        for hop, each in found[:_MOST_EXECUTIONS]
    ]
    terminal.table(("core", "process#job", "from", "to", ""), rows, right=(2, 3))
    if len(found) > len(rows):
        terminal.line(f"  ... {len(found) - len(rows):,} more")
