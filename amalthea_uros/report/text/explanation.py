"""The explanation of a response time or of the latency of a chain for people."""

from __future__ import annotations

from fractions import Fraction

from amalthea_uros.analyze.chains.explanation import ChainExplanation
from amalthea_uros.analyze.execution_shares import ExecutionShare
from amalthea_uros.analyze.explanation import ProcessExplanation
from amalthea_uros.analyze.results import Response
from amalthea_uros.perf.stimuli import Counter
from amalthea_uros.report.hops import write_hops
from amalthea_uros.report.terminal import Terminal
from amalthea_uros.services.analyze import Explanation
from amalthea_uros.units import Time, time_text


def write(explanation: Explanation, terminal: Terminal) -> None:
    """Write what a value consists of; if a process and a chain have the name, both are written."""
    if explanation.process is not None:
        _process(explanation.process, terminal)
    if explanation.process is not None and explanation.chain is not None:
        terminal.line()
        terminal.line(f"{explanation.name!r} is also the name of an event chain:")
    if explanation.chain is not None:
        _chain(explanation.chain, terminal)


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
        _terms(response, response.worst, explanation, terminal)
    _execution(explanation, terminal)
    _loads(explanation, terminal)


def _terms(response: Response, worst: Time, explanation: ProcessExplanation, terminal: Terminal) -> None:
    terms = [(term, time_text(value)) for term, value in response.terms.items() if value]
    terminal.table(("made of", ""), [*terms, ("sum", time_text(worst))], right=(1,))
    if explanation.shares:
        rows = [(share.name, share.jobs, time_text(share.time)) for share in explanation.shares]
        terminal.table(("interference by", "jobs", "time"), rows, right=(1, 2))
    terminal.line(f"  {response.method} ({response.source}), {response.jobs} jobs examined")


def _execution(explanation: ProcessExplanation, terminal: Terminal) -> None:
    if not explanation.execution:
        return
    wcet = explanation.process.wcet
    rows = [
        (share.name, share.calls if share.is_runnable else "", _jobs(share.counter), _time(share.time), _part(share, wcet))
        for share in explanation.execution
    ]
    terminal.table(
        ("WCET made of", "calls", "in jobs", "time", "share"), [*rows, ("sum", "", "", _time(wcet), "")], right=(1, 3, 4)
    )


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
    return "?" if load is None else f"{float(load):.3%}"


def _chain(explanation: ChainExplanation, terminal: Terminal) -> None:
    """Write the hops of a chain, which add up to its latency."""
    name, quantity = terminal.style(explanation.chain.name, "1"), explanation.quantity.replace("_", " ")
    value = explanation.value
    if value is None or value.value is None:
        terminal.line(f"{name}: {quantity} unknown: {explanation.reason}")
        return
    terminal.line(f"{name}: {quantity} {time_text(value.value)} ({value.claim})")
    if explanation.route:
        terminal.line(f"  {explanation.route}")
    if explanation.hops:
        write_hops(explanation, value.value, value.claim, terminal)
    else:
        terminal.line(f"  no single hops: {explanation.reason}")
    terminal.line(f"  {value.method} ({value.source})")
