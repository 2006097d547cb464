"""An analysis as a document: loads, response times, latencies and verdicts, with what they rest on."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction
from math import ceil

from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.results.processes import CallbackResult, Metric, ProcessorResult, ProcessResult, RequirementResult
from amalthea_uros.executors.results import ExecutorResult, HandleResult
from amalthea_uros.judge.verdict import WORST_FIRST, Verdict
from amalthea_uros.report.basics.document import (
    Cell,
    ResultDocument,
    Section,
    Sentences,
    Table,
    document,
    flaws,
    section,
    table,
)
from amalthea_uros.report.documents.judged import stated_limit
from amalthea_uros.report.documents.missing_values import missing_section
from amalthea_uros.report.documents.needs import NEEDS_HEADING, needs_table
from amalthea_uros.report.documents.overloads import brief, overload_sections
from amalthea_uros.report.wording.answer import answer_lines
from amalthea_uros.report.wording.cells import (
    UNKNOWN,
    about,
    at_least,
    at_most,
    by_core_and_priority,
    deadline_text,
    directed_limit,
    exactly,
    limited_text,
    load_cells,
    priority_text,
    response_ends,
    verdict_badge,
    words,
)
from amalthea_uros.report.wording.chains import CHAINS_HEADING, LATENCY_COLUMNS, headline, latency_cells, message_chain_row
from amalthea_uros.report.wording.chains import MESSAGE_COLUMNS as MESSAGE_COLUMNS
from amalthea_uros.report.wording.closing_line import closing_line
from amalthea_uros.services.analyze import AnalysisResult, analysis_result
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.units import Time

BAR = 20
HOST_COLUMNS = ("callback", "kind", ">interval", ">best", ">worst", "can lose", "method")
_CALLBACKS = "Callbacks (from the activation of the process to the end of the callback)"


def analysis_document(result: AnalysisResult) -> ResultDocument:
    """Tables of loads, response times, chains and requirements, with methods, assumptions and the verdict."""
    analysis = result.analysis
    return document(
        (
            *_first_answer(result),
            *_message_chains(result),
            section("Load", _loads(cores_of(analysis), "core", analysis)),
            section("Utilisation of wires", _loads(wires_of(analysis), "wire", analysis)),
            *overload_sections(analysis),
            section("Response times", response_times(analysis)),
            section(NEEDS_HEADING, execution_times(analysis)),
            section(_CALLBACKS, callbacks(analysis.of_periodic_executors)),
            *map(_executor, analysis.executors),
            *map(_host_executor, analysis.host),
            *(map(_metrics, analysis.processes) if result.with_metrics else ()),
            section(CHAINS_HEADING, _chains(analysis)),
            section("Requirements", _requirements(analysis)),
            *_on_request(result),
            section("Methods", Sentences(list(dict.fromkeys(_methods_of_responses(analysis))))),
            section("Assumptions", Sentences(analysis.assumptions)),
            missing_section(result),
        ),
        closing_line(analysis.summary),
    )


def _on_request(result: AnalysisResult) -> Iterator[Section]:
    """The sections that only some runs ask for, so that only these import their modules."""
    if result.impact is None and result.sensitivity is None and not result.proposals:
        return
    from amalthea_uros.report.documents.changes import factors_section, impact_section, priorities_section

    if result.impact is not None:
        yield impact_section(result.impact)
    if result.sensitivity is not None:
        yield factors_section(result.sensitivity)
    yield from map(priorities_section, result.proposals or ())


def analysis_alone(analysis: Analysis) -> ResultDocument:
    """The same of something that is not in files, after what is wrong with it."""
    alone = analysis_document(analysis_result(analysis))
    return document((flaws(analysis.findings), *alone.sections), alone.closing)


def _first_answer(result: AnalysisResult) -> Iterator[Section]:
    """The object that the verdict depends on, its largest part, and the best change."""
    if result.answer is not None:
        first, *others = answer_lines(result.answer)
        yield section(first, Sentences(others or [""]))


def _message_chains(result: AnalysisResult) -> Iterator[Section]:
    """The latency of messages: a line for one chain unless the answer is about it, or a table of several."""
    analysis, answer = result.analysis, result.answer
    answered = answer.chain if answer is not None and answer.explanation is not None else None
    if list(analysis.message_chains) == [answered]:
        return
    if len(analysis.message_chains) == 1:
        yield section(headline(analysis.message_chains[0]), Sentences([""]))
    elif analysis.message_chains:
        yield section("Latency of messages, end to end", latencies_of_messages(analysis, ""))


def latencies_of_messages(analysis: Analysis, remark: str = "why") -> Table:
    """The end-to-end latencies of messages."""
    return table("Latency of messages, end to end", (*MESSAGE_COLUMNS, remark), map(message_chain_row, analysis.message_chains))


def cores_of(analysis: Analysis) -> list[ProcessorResult]:
    """The cores that execute something, without those that stand for wires."""
    wires = analysis.solution.context.system.network.wire_cores
    return [each for each in analysis.processors if each.worst != 0 and each.name not in wires]


def wires_of(analysis: Analysis) -> list[ProcessorResult]:
    """The wires in their directions, on which something is sent."""
    cores = {each.name for each in cores_of(analysis)}
    return [each for each in analysis.processors if each.worst != 0 and each.name not in cores]


def _loads(processors: Sequence[ProcessorResult], kind: str, analysis: Analysis) -> Table:
    network = analysis.solution.context.system.network
    rows = [(*load_cells(processor, network), _bar(processor)) for processor in processors]
    clock = "clock" if kind == "core" else "bit rate"
    return table(f"Load of each {kind}", (kind, f"~>{clock}", "~~>best", "~~>mean", ">worst", "~~~"), rows)


def _bar(processor: ProcessorResult) -> str:
    """The worst load as far as it is known as a bar, with an exclamation mark above 100 %."""
    filled = min(BAR, ceil(processor.at_least * BAR))
    rest = ("." if processor.worst is not None else "?") * (BAR - filled)
    return "#" * filled + rest + ("!" if processor.is_overloaded else "")


def response_times(analysis: Analysis, is_detailed: bool = False) -> Table:
    """The response times of all processes, by core and priority.

    Parameters
    ----------
    is_detailed : with the terms of each response time, and both its claim and what is wrong
    """
    ordered = sorted(analysis.processes, key=lambda each: by_core_and_priority(each.processor, each.is_isr, each.priority))
    terms = list(dict.fromkeys(term for each in ordered if each.response is not None for term in each.response.terms))
    terms = terms if is_detailed else []
    rows = [
        (
            *_response_row(each, terms),
            verdict_badge(each) if each.verdict is not None or is_detailed else "-",
            *(_unlike(str(each.failure), brief(remark, analysis)) for remark in _remarks(each, is_detailed)),
        )
        for each in ordered
    ]
    remarks = ("claim", "why") if is_detailed else ("",)
    columns = (
        "process",
        "core",
        "~>priority",
        "~~~>WCET",
        "~~>best",
        ">worst",
        *(f">{term}" for term in terms),
        ">deadline",
        "verdict",
    )
    return table("Response times by core and priority", (*columns, *remarks), rows)


def _response_row(process: ProcessResult, terms: Sequence[str]) -> tuple[Cell, ...]:
    response = process.response
    parts = response.terms if response is not None and response.worst is not None else {}
    return (
        process.name,
        process.processor or UNKNOWN,
        priority_text(process.priority, process.is_isr),
        at_most(process.wcet),
        *response_ends(response, process.deadline),
        *(at_most(parts[term]) if parts.get(term) else "-" for term in terms),
        deadline_text(process.deadline, process.is_implicit),
    )


def _unlike(word: str, remark: str) -> str:
    """A remark that says more than the word beside it."""
    return "" if remark == word else remark


def _remarks(process: ProcessResult, is_detailed: bool) -> tuple[str, ...]:
    response = process.response
    if not is_detailed:
        return (process.reason or (str(response.claim) if response else ""),)
    from amalthea_uros.report.documents.judged import why

    return (str(response.claim) if response is not None and response.worst is not None else "", why(process))


def execution_times(analysis: Analysis) -> Table:
    """The execution times of processes on each kind of core, where no single one is stated."""
    return needs_table(analysis.processes)


def callbacks(results: Iterable[CallbackResult]) -> Table:
    """The response times of the callbacks of periodic executors."""
    columns = ("callback", "~process", "~~>best", "~~~>mean", ">worst", ">deadline", "")
    title = "Callbacks, from the activation of the process to the end of the callback"
    return table(title, columns, map(_callback_row, results))


def _callback_row(callback: CallbackResult) -> tuple[str, ...]:
    best, worst = response_ends(callback.response, callback.deadline)
    mean = callback.metrics[JobMetric.RESPONSE_TIME].mean if callback.response else None
    claim = str(callback.response.claim) if callback.response else ""
    deadline = deadline_text(callback.deadline)
    return (callback.name, callback.process, best, _mean(mean), worst, deadline, callback.reason or claim)


def _mean(value: Fraction | None) -> str:
    return "-" if value is None else about(round(value))


def _executor(executor: ExecutorResult) -> Section:
    """The handles of an executor that spins in a loop, its iterations, and what can be lost."""
    loop = (
        f"an iteration takes {_span(executor.round.least, executor.round.most)}, "
        f"from one wait to the next {_span(executor.loop.least, executor.loop.most)}"
    )
    losses = [
        f"{each.name} {'loses' if each.lost.is_certain else 'can lose'} {each.lost.what}: {each.lost.sequence}"
        for each in executor.handles
        if each.lost is not None
    ]
    return section(
        f"Executor {executor.name} (from the arrival of a message, or when a timer is due, to the end of the callback)",
        Sentences([executor.reason or loop]),
        handles(executor),
        Sentences(losses),
    )


def _host_executor(executor: ExecutorResult) -> Section:
    """The callbacks of an executor of the host, by which method, and what can be lost."""
    losses = [
        f"{each.name} can lose {each.lost.what}: {each.lost.sequence}" for each in executor.handles if each.lost is not None
    ]
    return section(
        f"Executor {executor.name} of the host (from the arrival of a message, or when a timer is due, to the end of the callback)",
        Sentences([executor.reason] if executor.reason else []),
        table(f"Executor {executor.name} of the host", HOST_COLUMNS, map(host_row, executor.handles)),
        Sentences(losses),
    )


def host_row(handle: HandleResult) -> tuple[Cell, ...]:
    """A callback of the host, with its bounds."""
    lost, response = "-" if handle.lost is None else handle.lost.what, handle.response
    method = f"{response.method} ({response.source})" if response.worst is not None else UNKNOWN
    return (
        handle.name,
        handle.kind.value,
        exactly(handle.interval, "-"),
        *response_ends(response, handle.interval),
        lost,
        method,
    )


def handles(executor: ExecutorResult, is_detailed: bool = False) -> Table:
    """The response times of the handles of an executor, and what can be lost; with how and why if it is detailed."""
    remarks = ("what can be lost, and how", "claim", "why") if is_detailed else ("can lose", "")
    columns = ("handle", "~~kind", ">interval", "~~~>best", ">worst", "~>late by", *remarks)
    return table(f"Executor {executor.name}", columns, (_handle_row(each, is_detailed) for each in executor.handles))


def _handle_row(handle: HandleResult, is_detailed: bool) -> tuple[Cell, ...]:
    response, lateness, claim = handle.response, handle.lateness, str(handle.response.claim)
    lost = "-" if handle.lost is None else handle.lost.what
    if is_detailed and handle.lost is not None:
        lost = f"{lost}: {handle.lost.sequence}"
    return (
        handle.name,
        handle.kind.value,
        exactly(handle.interval, UNKNOWN),
        *response_ends(response, handle.interval),
        "-" if lateness is None else at_most(lateness.most),
        lost,
        *((claim, response.reason) if is_detailed else (response.reason or claim,)),
    )


def _span(lower: Time, upper: Time | None) -> str:
    return f"{at_least(lower)} to {at_most(upper)}"


def _metrics(process: ProcessResult) -> Section:
    """Minimum, mean and maximum of each metric of a process."""
    rows = [_metric_row(name, metric) for name, metric in process.metrics.items()] or [("none", *[""] * 4)]
    return section(f"Metrics of {process.name}", table("", ("metric", ">min", ">mean", ">max", ""), rows))


def _metric_row(name: JobMetric, metric: Metric) -> tuple[str, ...]:
    return (words(name), at_least(metric.min), _mean(metric.mean), at_most(metric.max), str(metric.claim))


def _chains(analysis: Analysis) -> Table:
    rows = [
        (chain.name, *(brief(cell, analysis) for cell in latency_cells(chain, LATENCY_COLUMNS))) for chain in analysis.chains
    ]
    return table("Latencies of event chains", ("chain", *(f">{column}" for column in LATENCY_COLUMNS), ""), rows)


def _requirements(analysis: Analysis) -> Table:
    ordered = sorted(analysis.requirements, key=lambda requirement: WORST_FIRST.index(requirement.verdict))
    columns = ("requirement", "~what", "limit", ">value", "verdict", ">margin", "")
    return table("Requirements", columns, (_requirement_row(each, analysis) for each in ordered))


def _requirement_row(requirement: RequirementResult, analysis: Analysis) -> tuple[Cell, ...]:
    is_certain = requirement.margin is not None and requirement.verdict is not Verdict.UNKNOWN
    limit = stated_limit(requirement)
    return (
        requirement.name,
        limited_text(requirement.quantity, requirement.object),
        directed_limit(limit, is_upper=requirement.is_upper) if limit else "-",
        _value(requirement),
        verdict_badge(requirement),
        at_least(requirement.margin) if is_certain else "",
        "" if _shows_ends(requirement) else brief(requirement.reason, analysis),
    )


def _shows_ends(requirement: RequirementResult) -> bool:
    """Whether the value of an unknown verdict is shown with both ends, which its reason only says again."""
    ends = requirement.lower, requirement.upper
    return requirement.verdict is Verdict.UNKNOWN and None not in ends and " is between " in requirement.reason


def _value(requirement: RequirementResult) -> str:
    """The maximum or minimum that is limited: its safe end, or both ends if it is between them and the verdict is not met."""
    lower, upper, limit = requirement.lower, requirement.upper, requirement.limit
    if lower == upper or requirement.verdict is Verdict.MET or lower is None or upper is None:
        return at_most(requirement.value, limit) if requirement.is_upper else at_least(requirement.value, limit)
    return f"{at_least(lower, limit)} to {at_most(upper, limit)}"


def methods(analysis: Analysis) -> list[str]:
    """The methods of response times and latencies with their sources, each once."""
    of_responses = (f"Response times: {each}" for each in _methods_of_responses(analysis))
    of_latencies = (f"Latencies: {value.method} ({value.source})" for chain in analysis.chains for value in chain.values)
    return list(dict.fromkeys((*of_responses, *of_latencies)))


def _methods_of_responses(analysis: Analysis) -> Iterable[str]:
    return (f"{each.response.method} ({each.response.source})" for each in analysis.processes if each.response is not None)
