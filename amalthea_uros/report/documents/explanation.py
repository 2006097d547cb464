"""The explanation of a response time or of the latency of a chain as a document: what it consists of, and what would shorten it."""

from __future__ import annotations

import shlex
from collections.abc import Iterable, Iterator
from fractions import Fraction
from typing import TYPE_CHECKING

from amalthea_uros._internal.plural import counted
from amalthea_uros.analyze.results.chains import LatencyQuantity
from amalthea_uros.analyze.results.explanations import OriginKind
from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.perf.executors import HandleKind
from amalthea_uros.report.basics.document import Block, Lead, ResultDocument, Sentences, Table, document, lines, section, table
from amalthea_uros.report.documents.analysis import callbacks
from amalthea_uros.report.wording.cells import UNKNOWN, about, at_least, at_most, directed_limit, load_text, share_text, words
from amalthea_uros.report.wording.chains import latency_cells, quantity_text, value_text
from amalthea_uros.report.wording.largest_part import largest_cause, largest_term, latency_parts
from amalthea_uros.timing.response import Claim
from amalthea_uros.units import Time, time_text

if TYPE_CHECKING:
    from amalthea_uros.analyze.results.analysis import Judged
    from amalthea_uros.analyze.results.chains import ChainResult, LatencyValue
    from amalthea_uros.analyze.results.explanations import (
        CallbackExplanation,
        ChainExplanation,
        ExecutionShare,
        ProcessExplanation,
    )
    from amalthea_uros.analyze.results.processes import ProcessResult
    from amalthea_uros.design.improvements import Improvements
    from amalthea_uros.executors.results import HandleResult
    from amalthea_uros.services.analyze import ChainDetail, Explanation
    from amalthea_uros.services.chains import PathsResult

#: More executions of the worst case are only counted.
_MOST_EXECUTIONS = 20
#: Of the shares in an execution time, the smaller ones are only added up.
_MOST_SHARES = 20
#: Further changes shorten a latency less, and further drawbacks of a change are only counted.
_MOST_CHANGES, _MOST_DRAWBACKS = 8, 3
#: The instants from which the response time of a handle counts, by its kind; that of a message from its arrival.
_RELEASES = {HandleKind.TIMER: "when it is due", HandleKind.LOOP_ITEM: "the beginning of its iteration"}
_ARRIVAL = "when it has arrived at the controller"


def explanation_document(explanation: Explanation) -> ResultDocument:
    """What a value consists of; if a process and a chain have the name, both are shown."""
    process, chain = explanation.process, explanation.chain
    return document(
        (
            section("", *(() if process is None else _process(process))),
            section(
                "",
                lines(f"{explanation.name!r} is also the name of an event chain:" if process and chain else ""),
                *(block for callback in explanation.callbacks for block in _callback(callback)),
                *(() if chain is None else _chain(chain, explanation.improvements)),
            ),
        )
    )


def _process(explanation: ProcessExplanation) -> Iterator[Block]:
    """The terms of a response time, whose jobs interfere, and what the execution time consists of."""
    process = explanation.process
    response, name = process.response, process.name
    if response is None:
        yield lines(Lead(name, f": response time unknown: {process.reason}"))
    elif response.worst is None:
        yield lines(Lead(name, f": response time unbounded: {response.reason}"))
    else:
        yield lines(Lead(name, f": worst-case response time {at_most(response.worst, process.deadline)} ({response.claim})"))
        largest = largest_term(explanation)
        yield Sentences([*_deadline(process), *([f"largest part: {largest}"] if largest else [])])
        terms = [(term, at_most(value)) for term, value in response.terms.items() if value]
        yield table("", ("made of", ">"), [*terms, ("sum", at_most(response.worst, process.deadline))])
        yield interference(explanation)
        yield Sentences([response.method, f"{response.source}; {counted(response.jobs, 'job')} examined"])
    if explanation.origins:
        yield Sentences(["what would give it a bound"])
        yield Sentences(list(_remedies(explanation)), indent=4)
    if explanation.loads:
        yield _loads(explanation)
    if explanation.execution:
        yield _execution(explanation)
    if not explanation.origins:
        yield callbacks(explanation.callbacks)


def _deadline(process: ProcessResult) -> Iterator[str]:
    """How far the response time is from the deadline, or what else is wrong."""
    if process.deadline is not None and process.margin is not None and process.verdict is not None:
        kind = "period" if process.is_implicit else "deadline"
        is_about_time = process.margin < 0 or process.verdict is Verdict.MET
        why = _margin(process, process.margin) if is_about_time else process.reason
        yield f"{kind} {time_text(process.deadline)}: {process.failure or process.verdict}, {why}"


def _margin(judged: Judged, margin: Time) -> str:
    """How far a value is from its limit; of a bound beyond the limit it is unknown how far the value itself is."""
    if margin >= 0:
        return f"{at_least(margin)} left"
    distance = f"{at_most(-margin)} {'beyond' if judged.is_upper else 'short of'} the limit"
    return f"the bound is {distance}" if judged.verdict is Verdict.UNKNOWN else distance


def interference(explanation: ProcessExplanation) -> Table:
    """The processes that delay one in its worst case."""
    rows = [(share.name, f"{share.jobs:,}", at_most(share.time)) for share in explanation.shares]
    caption = f"Interference in the worst case of {explanation.process.name}"
    return table(caption, ("interference by", ">jobs", ">time"), rows)


def _remedies(explanation: ProcessExplanation) -> Iterator[str]:
    """Why there is no bound, and what would give one."""
    for origin in explanation.origins:
        if origin.process != explanation.process.name:
            yield f"{origin.process}: {origin.reason}"
        elif origin.kind is OriginKind.OVERLOAD and explanation.load is not None and explanation.load > explanation.supply:
            yield f"Reduce the load by at least {float(explanation.load - explanation.supply):.1%} of the core."
        if origin.remedy:
            yield origin.remedy


def _loads(explanation: ProcessExplanation) -> Table:
    """Who needs how much of the core, for a process that does not meet its deadline."""
    rows = [
        (load.name, "" if load.priority is None else str(load.priority), _percent(load.utilisation))
        for load in explanation.loads
    ]
    rows += [("sum", "", _percent(explanation.load)), ("supply", "", _percent(explanation.supply))]
    return table("", ("load at this priority or higher", ">priority", ">load"), rows)


def _percent(load: Fraction | None) -> str:
    return "?" if load is None else load_text(load)


def _execution(explanation: ProcessExplanation) -> Table:
    """The runnables and other parts of an execution time: the largest ones in their order, and the sum of the others."""
    shares, wcet = explanation.execution, explanation.process.wcet
    is_worst: Iterable[str] = [""] * len(shares)
    if explanation.in_worst_job and any(share.counter is not None for share in shares):
        is_worst = ["yes" if is_executed else "no" for is_executed in explanation.in_worst_job]
    rows = [
        (*_calls(share), _worst(share.time), _part(share, wcet), worst) for share, worst in zip(shares, is_worst, strict=True)
    ]
    # Unknown shares count as the largest.
    order = sorted(range(len(rows)), key=lambda index: (shares[index].time is not None, -(shares[index].time or 0)))
    others = order[_MOST_SHARES:]
    shown = [rows[index] for index in sorted(order[:_MOST_SHARES])]
    if others:
        rest = sum(shares[index].time or 0 for index in others)
        shown.append((f"{len(others):,} others", "", "", at_most(rest), "", ""))
    titles = ("WCET made of", ">calls", "in jobs", ">time", ">share", "in the worst job" if any(is_worst) else "")
    return table("", titles, [*shown, ("sum", "", "", _worst(wcet), "", "")])


def _worst(time: Time | None) -> str:
    """A maximum with four digits."""
    return "?" if time is None else at_most(time)


def _relative(time: Time | None) -> str:
    """A point in time with four digits."""
    return "-" if time is None else about(time)


def _calls(share: ExecutionShare) -> tuple[str, str, str]:
    """What is executed, how often, and in which jobs."""
    prescaler = 1 if share.counter is None else share.counter.prescaler
    jobs = "all" if prescaler == 1 else f"1 in {prescaler}"
    return share.name, str(share.calls) if share.is_runnable else "", jobs


def _part(share: ExecutionShare, wcet: Time | None) -> str:
    return share.reason if share.time is None or not wcet else f"{share.time / wcet:.1%}"


def _callback(explanation: CallbackExplanation) -> Iterator[Block]:
    """When a callback ends, and what the jobs of its process execute up to it."""
    callback, process = explanation.callback, explanation.process
    worst = UNKNOWN if callback.response is None else _worst(callback.response.worst)
    claim = callback.reason or ("" if callback.response is None else str(callback.response.claim))
    yield lines(Lead(callback.name, f": worst-case response time {worst} ({claim}), in {process.name}"))
    if callback.deadline is not None and not explanation.handles:
        yield Sentences([f"from the activation of {process.name}; deadline {time_text(callback.deadline)}"])
    for handle in explanation.handles:
        interval = "" if handle.interval is None else f"; every {time_text(handle.interval)} at most"
        yield Sentences([f"{handle.kind.value} {handle.name}, from {_RELEASES.get(handle.kind, _ARRIVAL)}{interval}"])
        yield terms_of(handle)
        if handle.lost is not None:
            lost = f"{handle.lost.what} {'are' if handle.lost.is_certain else 'can be'} lost: {handle.lost.sequence}"
            yield Sentences([lost])
    rows = [(*_calls(share), _worst(share.time)) for share in explanation.execution]
    yield table("", ("executed up to its end", ">calls", "in jobs", ">time"), rows)
    if callback.response is not None:
        yield Sentences([callback.response.method, callback.response.source])


def terms_of(handle: HandleResult) -> Table:
    """What a handle of an executor that spins in a loop waits for, in the order of time."""
    worst = handle.response.worst
    rows = [
        (term.name, _worst(term.most), f"{term.most / worst:.1%}" if worst and term.most is not None else "", term.why)
        for term in handle.terms
    ]
    return table(f"Worst response time of {handle.name}", ("in the worst case", ">time", ">share", ""), rows)


def _chain(explanation: ChainExplanation, found: Improvements | None) -> Iterator[Block]:
    """The largest part of a latency and what shortens it, then the hops, which add up to it, and all causes and changes."""
    value, quantity = explanation.value, words(explanation.quantity)
    if value is None or value.value is None:
        yield lines(Lead(explanation.chain.name, f": {quantity} unknown: {explanation.reason}"))
        yield Sentences(list(_limits(explanation)))
    else:
        yield lines(Lead(explanation.chain.name, f": {quantity} {at_most(value.value)} ({value.claim})"))
        largest = largest_cause(explanation)
        yield Sentences([*_limits(explanation), *([f"largest part: {largest}"] if largest else [])])
    if found is not None:
        yield Sentences(list(_best_change(found)))
    if explanation.chain.crosses_messages:
        yield message_hops(explanation.chain)
        yield Sentences(list(_remarks_on_messages(explanation.chain)))
    elif value is not None and value.value is not None:
        yield from _worst_case(explanation, value, value.value)
    if found is not None and found.best(_MOST_CHANGES):
        yield changes(found).compact
        yield Sentences([tried(found)])


def _limits(explanation: ChainExplanation) -> Iterator[str]:
    """The limits of the chain, with how far the values are from them."""
    for each in explanation.requirements:
        if each.limit is None or each.value is None:
            rest = f": {each.reason}" if each.reason else ""
        else:
            rest = f", {_margin(each, each.margin or 0)}"
        limit = "" if each.limit is None else f" {directed_limit(time_text(each.limit), is_upper=each.is_upper)}"
        yield f"{each.name}, {each.quantity}{limit}: {each.verdict}{rest}"


def message_hops(chain: ChainResult) -> Table:
    """The hops of a chain over wires and executors with their parts; the columns best and worst add up to the latency."""
    rows: list[tuple[str, ...]] = []
    for hop in chain.hops:
        why = hop.reason or hop.source
        rows.append((f"{hop.kind}: {hop.name}", at_least(hop.best), at_most(hop.worst), share_text(hop.share), why))
        rows += [(f"- {part.name}", "", at_most(part.most), "", part.why) for part in hop.parts]
    rows.append(("sum", at_least(chain.best or 0), at_most(chain.worst_if_not_lost), "", ""))
    return table(f"Hops of {chain.name}", ("hop", "~>best", ">worst", ">share", ""), rows)


def _remarks_on_messages(chain: ChainResult) -> Iterator[str]:
    yield "the latency is the sum of the bounds of its hops, which need not occur in one run"
    if chain.loss:
        yield f"the sum only holds for messages that are not lost: {chain.loss}"
    yield from (hop.remedy for hop in chain.hops if hop.worst is None and hop.remedy)


def _worst_case(explanation: ChainExplanation, value: LatencyValue, total: Time) -> Iterator[Block]:
    """The path, the hops with their causes, and the executions."""
    if explanation.route:
        yield Sentences([explanation.route])
    if explanation.hops:
        yield hops(explanation).compact
        yield Sentences([f"waits and runs add up to {at_most(total)}; other times are relative to the first read"])
        if value.claim is Claim.BOUND:
            yield Sentences(["each read is as early and each write as late as possible, which need not occur in one run"])
        yield _causes(explanation)
        yield from _executions(explanation)
    else:
        yield Sentences([f"no single hops: {explanation.reason}"])
    yield Sentences([f"{value.method} ({value.source})"])


def hops(explanation: ChainExplanation) -> Table:
    """The jobs of a worst case; the columns wait and run add up to the value."""
    rows = [
        (
            hop.process,
            "-" if hop.job is None else f"{hop.job:,}",
            *map(_relative, (hop.release, hop.start, hop.read, hop.write)),
            *map(at_most, (hop.wait, hop.run)),
            share_text(explanation.share(hop.wait + hop.run)),
        )
        for hop in explanation.hops
    ]
    waits, runs = (sum(hop.wait for hop in explanation.hops), sum(hop.run for hop in explanation.hops))
    empty = [""] * 5
    if last := explanation.overwritten:
        rows.append(("until overwritten", *empty, at_most(last), "", share_text(explanation.share(last))))
    rows.append(("sum", *empty, at_most(waits + last), at_most(runs), ""))
    titles = ("process", ">job", "~~>release", "~~~>start", "~>read", "~>write", ">wait", ">run", ">share")
    return table(f"Hops of {explanation.chain.name}; times are relative to the first read", titles, rows)


def _causes(explanation: ChainExplanation) -> Table:
    """Why each wait and each run takes its time; a process is named once for all of its parts."""
    rows: list[tuple[str, ...]] = []
    before = ""
    for process, kind, time, reason in latency_parts(explanation):
        rows.append(("" if process == before else process, kind, at_most(time), share_text(explanation.share(time)), reason))
        before = process
    return table("", ("why so long", "", ">time", ">share", "reason"), rows)


def _executions(explanation: ChainExplanation) -> Iterator[Block]:
    """Which jobs execute when, as far as they contribute to the latency."""
    found = [(hop, each) for hop in explanation.hops for each in hop.executions]
    rows = [
        (
            each.core,
            f"{each.process}#{each.job}",
            _relative(each.begin),
            _relative(each.end),
            "of the chain" if (each.process, each.job) == (hop.process, hop.job) else f"before {hop.process}",
        )
        for hop, each in found[:_MOST_EXECUTIONS]
    ]
    yield table("", ("core", "process#job", ">from", ">to", ""), rows)
    yield Sentences([f"... {len(found) - len(rows):,} more"] if len(found) > len(rows) else [])


def _best_change(found: Improvements) -> Iterator[str]:
    """The change with the greatest effect that breaks nothing, with the options that show all its effects."""
    recommended = found.recommended
    if recommended is not None:
        yield f"what helps: {recommended.change.text}, which gives {at_most(recommended.after)} ({recommended.claim})"
        yield f"to see all its effects: {shlex.join(recommended.change.options)}"
    elif found.found:
        yield "what helps: only changes that break something else; the last table shows them"
    else:
        yield f"what helps: no single change shortens it: {tried(found)}"


def changes(found: Improvements) -> Table:
    """The changes with the greatest effect on a latency, and what they make worse, verdicts first."""
    rows = []
    for each in found.best(_MOST_CHANGES):
        drawbacks = [f"{drawback.name}: {drawback.before} -> {drawback.after}" for drawback in each.drawbacks]
        more = [f"{len(drawbacks) - _MOST_DRAWBACKS:,} more"] if len(drawbacks) > _MOST_DRAWBACKS else []
        worse = "; ".join((*drawbacks[:_MOST_DRAWBACKS], *more))
        rows.append((each.change.text, at_most(each.before), at_most(each.after), str(each.claim), worse))
    return table("Changes that shorten it", ("what would shorten it", "~>before", ">after", "~~claim", "what gets worse"), rows)


def tried(found: Improvements) -> str:
    """How many changes were analysed."""
    is_combined = any(each.change.is_combined for each in found.found)
    how = "one at a time, and the best of them together" if is_combined else "one at a time"
    text = f"{counted(found.tried, 'change')} analysed, {how}"
    reason = ", because the analyses of the changed systems together take too long" if found.is_work_exceeded else ""
    return f"{text}; {found.untried:,} more were not tried{reason}" if found.untried else text


def chain_document(detail: ChainDetail) -> ResultDocument:
    """All values of a chain, and how its events are connected."""
    chain = detail.chain
    values = sorted(
        chain.all_values if detail.all_methods else chain.values, key=lambda value: list(LatencyQuantity).index(value.quantity)
    )
    rows = [
        (quantity_text(value.quantity), value_text(value), str(value.claim), f"{value.method} ({value.source})")
        for value in values
    ]
    about = Sentences([*chain.routes, *filter(None, (chain.why, chain.reason))])
    name = lines(Lead(chain.name, f", communication {chain.communication}"))
    return document([section("", name, about, table("", ("quantity", ">value", "claim", "method"), rows))])


_PATH_COLUMNS = ("min", "reaction", "data age")


def paths_document(result: PathsResult) -> ResultDocument:
    """Paths through processes, with their numbers and latencies."""
    if not result.paths:
        where = "" if result.are_all else " among those that were examined; there are too many for all"
        return document([section("", lines(f"there is no path from {result.start} to {result.end}{where}"))])
    rows = []
    for number, (path, chain) in enumerate(zip(result.paths, result.chains, strict=True), start=1):
        first, *others = path.processes
        text = first + "".join(f" -[{', '.join(links)}]-> {process}" for links, process in zip(path.links, others, strict=True))
        rows.append((str(number), *latency_cells(chain, _PATH_COLUMNS), text))
    some = f"the first {len(rows)} paths that were found; there may be more, and shorter ones"
    shown = table("", (">", *(f">{column}" for column in _PATH_COLUMNS), "", "path"), rows)
    return document([section("", lines("" if result.are_all else some), shown)])
