"""A simulation as a document: what was observed, in words and tables."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from fractions import Fraction
from math import ceil, floor

from amalthea_uros._internal.plural import counted
from amalthea_uros.design.campaign.run import RunOutcome
from amalthea_uros.design.campaign.simulations import CampaignResult, judged_in
from amalthea_uros.judge.causes import distinct
from amalthea_uros.judge.verdict import WORST_OBSERVED_FIRST, ObservedVerdict
from amalthea_uros.report.basics.document import (
    Cell,
    ResultDocument,
    Section,
    Sentences,
    Table,
    document,
    flaws,
    lines,
    section,
    table,
)
from amalthea_uros.report.documents.changes import impact_section
from amalthea_uros.report.wording.cells import (
    about,
    at_most,
    badge,
    by_core_and_priority,
    deadline_text,
    directed_limit,
    limited_text,
    load_text,
    observed,
    words,
)
from amalthea_uros.report.wording.chains import CHAINS_HEADING
from amalthea_uros.report.wording.closing_line import left_text
from amalthea_uros.report.wording.findings import joined
from amalthea_uros.services.simulate import SimulationResult
from amalthea_uros.simulate.observations import (
    ChainObservation,
    ExecutorObservation,
    ProcessObservation,
    RequirementObservation,
)
from amalthea_uros.simulate.results import Judged, Simulation
from amalthea_uros.simulate.runs.not_simulated import LIMITED_PROCESS_LEFT_OUT, consequence_of
from amalthea_uros.timing.basics.quantities import ChainQuantity, JobMetric
from amalthea_uros.units import NANOSECOND, SECOND, Rounding, Time, number_text, rounded, rounded_time_text, time_text

_MINUTE = 60 * SECOND
REMINDER = "Observed values are no bounds; for bounds use `amuros analyze`."


def duration_text(duration: Time) -> str:
    """A duration, in minutes if it is a number of them: "5 min", "1.5 s"; one that was measured has four digits."""
    return f"{duration // _MINUTE} min" if duration % _MINUTE == 0 else about(duration)


def closing_line(simulation: Simulation) -> str:
    """What was missed, or what came closest to its limit; and that this is no bound."""
    run = f"Observed over {duration_text(simulation.duration)} (seed {simulation.seed})"
    parts = filter(None, (simulation.incomplete, _missed(simulation), _not_observed(simulation)))
    return f"{run}: {'; '.join(parts)}. {REMINDER}"


def limit_text(requirement: RequirementObservation) -> str:
    """The limit, such as "at most 1 ms"."""
    if requirement.limit is None:
        return "-"
    return directed_limit(value_text(requirement, requirement.limit), is_upper=requirement.is_upper)


def value_text(requirement: RequirementObservation, value: Fraction | None) -> str:
    """A value of what a requirement limits."""
    if value is None:
        return "-"
    return time_text(round(value)) if requirement.is_time else number_text(value)


def _missed(simulation: Simulation) -> str:
    missed = distinct(simulation.missed)
    if missed:
        others = len(missed) - 1
        return _failure(missed[0]) + (f"; {counted(others, 'other failure')}" if others else "")
    if len(simulation.not_observed) == len(simulation.judged):
        return "" if simulation.judged else "no deadline, requirement or constraint to judge"
    what = "deadline or requirement" if simulation.requirements else "deadline"
    return f"no {what} missed{_tightest(simulation)}"


def _tightest(simulation: Simulation) -> str:
    item = simulation.tightest
    if item is None or item.margin is None or item.limit is None:
        return ""
    return f"; tightest: {item.name}, {left_text(item.margin, item.limit, item.is_upper)}"


def _failure(item: Judged) -> str:
    if isinstance(item, RequirementObservation):
        what = limited_text(item.quantity, item.object)
        if item.value is None or item.limit is None:
            return f"{what}: {item.reason}"
        reason = f" ({item.reason})" if item.reason else ""
        return f"{what} is {_observed_text(item)}{reason}, limit {limit_text(item)}"
    is_late = item.response_time is not None and item.deadline is not None and item.response_time.max > item.deadline
    if item.response_time is None or (item.reason and not is_late):
        return f"{item.name}: {item.reason}"
    kind = "period" if item.is_implicit else "deadline"
    after = at_most(item.response_time.max, item.deadline)
    late = f"{item.name} responds after {after}, {kind} {time_text(item.deadline or 0)}"
    return f"{late}; {item.reason}" if item.reason else late


def _not_observed(simulation: Simulation) -> str:
    missing = simulation.not_observed
    if not missing:
        return ""
    count, left_out = f"not observed: {len(missing)} of {len(simulation.judged)}", {each.name for each in simulation.left_out}
    # What is not simulated stands before this in the line; what follows from it needs no reason of its own.
    consequences = {LIMITED_PROCESS_LEFT_OUT, *map(consequence_of, left_out)}
    others = [each for each in missing if each.name not in left_out and each.reason not in consequences]
    return f"{count}, because of {others[0].name!r}: {others[0].reason}" if others else count


def simulation_document(result: SimulationResult) -> ResultDocument:
    """Tables of loads, response times, chains and requirements, with assumptions and what was observed."""
    simulation = result.simulation
    of_files = f" of {joined(result.paths)}" if result.paths else ""
    changed = [] if result.impact is None else [impact_section(result.impact, f"observed with seed {simulation.seed}")]
    metrics = [_metrics(process) for process in simulation.processes] if result.with_metrics else []
    opening = f"Simulation{of_files}: {_run_text(simulation)}"
    return document(_sections(simulation, metrics, changed), closing_line(simulation), opening=opening)


def simulation_alone(simulation: Simulation) -> ResultDocument:
    """The same of something that is not in files, after what the simulation does not take into account."""
    sections = (flaws(simulation.findings), section("", lines(f"Simulation: {_run_text(simulation)}")), *_sections(simulation))
    return document(sections, closing_line(simulation))


def _run_text(simulation: Simulation) -> str:
    return f"{duration_text(simulation.duration)}, seed {simulation.seed}, mode {simulation.mode}"


def _sections(simulation: Simulation, metrics: Iterable[Section] = (), changed: Iterable[Section] = ()) -> Iterator[Section]:
    loads = [(core.name, load_text(core.load)) for core in simulation.cores if core.load]
    yield section("Load", table("", ("core or wire", ">load"), loads))
    yield section("Observed response times", _processes(simulation))
    yield from metrics
    yield from map(_executor, simulation.executors)
    yield from (_executor(executor, is_of_host=True) for executor in simulation.host)
    yield section("Messages on wires that lose some", _losses(simulation))
    yield section(CHAINS_HEADING, _chains(simulation))
    yield section("Runnables with requirements", _runnables(simulation))
    yield section("Labels", _labels(simulation))
    yield section("Requirements", _requirements(simulation))
    yield from changed
    yield section("Assumptions", Sentences(simulation.assumptions))


def _processes(simulation: Simulation) -> Table:
    ordered = sorted(simulation.processes, key=lambda each: by_core_and_priority(each.core, each.is_isr, each.priority))
    rows = [
        (
            process.name,
            process.core or "-",
            f"{process.jobs:,}",
            load_text(process.load),
            *observed(process.response_time, process.deadline),
            deadline_text(process.deadline, process.is_implicit),
            f"{process.lost_activations:,}",
            "-" if process.verdict is None else badge(process.verdict),
            process.reason,
        )
        for process in ordered
    ]
    numbers = ("~~>jobs", "~~>load", "~~~>min", "~>mean", ">max", ">deadline", ">lost")
    return table("Observed response times", ("process", "core", *numbers, "verdict", ""), rows)


def _metrics(process: ProcessObservation) -> Section:
    rows = [
        (words(name), _microseconds(found.min), _microseconds(found.mean), _microseconds(found.max, is_max=True))
        for name, found in process.metrics.items()
    ]
    return section(
        f"Metrics of {process.name} (us)", table("", ("metric", ">min", ">avg", ">max"), rows or [("none", "", "", "")])
    )


def _microseconds(value: Fraction, is_max: bool = False) -> str:
    """A time in microseconds with three digits, so that minimum and maximum are rounded outwards; means are cut off."""
    nanoseconds = (ceil if is_max else floor)(value / NANOSECOND)
    whole, digits = divmod(abs(nanoseconds), 1000)
    return f"{'-' if nanoseconds < 0 else ''}{whole}.{digits:03}"


def _executor(executor: ExecutorObservation, is_of_host: bool = False) -> Section:
    rows = [
        (
            handle.name,
            handle.kind,
            f"{handle.calls:,}",
            *observed(handle.response_time),
            observed(handle.lateness)[2],
            f"{handle.lost:,}",
        )
        for handle in executor.handles
    ]
    failed = [f"{counted(executor.timeouts, 'publication')} not acknowledged in time"] if executor.timeouts else []
    if executor.refusals:
        failed.append(f"{counted(executor.refusals, 'publication')} not sent, because all buffers are in use")
    where, jobs = (" of the host", "call") if is_of_host else ("", "iteration")
    return section(
        f"Executor {executor.name}{where} (from the arrival of a message, or when a timer is due, to the end of the callback)",
        Sentences([f"{counted(executor.iterations, jobs)}", *failed]),
        table(
            "",
            ("callback" if is_of_host else "handle", "~kind", "~~>calls", "~~~>min", "~~~>mean", ">max", ">late by", ">lost"),
            rows,
        ),
    )


def _losses(simulation: Simulation) -> Table:
    rows = [(each.name, each.wire, f"{each.sent:,}", f"{each.lost:,}", f"{each.sent_again:,}") for each in simulation.losses]
    return table("", ("message", "wire", ">sent", ">lost", ">sent again"), rows)


def _chains(simulation: Simulation) -> Table:
    columns = ("chain", "~~>observations", "~~~>min", "~~~>mean", ">reaction", ">data age", "~>unanswered", "")
    return table("Latencies of event chains", columns, map(_chain, simulation.chains))


def _chain(chain: ChainObservation) -> tuple[str, ...]:
    age = observed(chain.quantities.get(ChainQuantity.REDUCED_DATA_AGE))
    missing = f"{chain.not_evaluated:,} latencies too long to be observed" if chain.not_evaluated else ""
    return (
        chain.name,
        f"{chain.observations:,}",
        *observed(chain.quantities.get(ChainQuantity.REDUCED_REACTION_TIME)),
        age[2],
        f"{chain.unanswered:,}",
        chain.reason or missing,
    )


def _runnables(simulation: Simulation) -> Table:
    rows = [
        (
            runnable.name,
            f"{runnable.executions:,}",
            *observed(runnable.metrics.get(JobMetric.RESPONSE_TIME)),
            observed(runnable.metrics.get(JobMetric.NET_EXECUTION_TIME))[2],
        )
        for runnable in simulation.runnables
    ]
    return table("", ("runnable", ">executions", ">min response", ">mean", ">max", ">max net execution"), rows)


def _labels(simulation: Simulation) -> Table:
    rows = [
        (
            label.name,
            *(f"{number:,}" for number in (label.reads, label.writes, label.unwritten_reads, label.overwritten)),
            *observed(label.age),
        )
        for label in simulation.labels
    ]
    return table("", ("label", "~~>reads", "~~>writes", "~>unwritten", "~>overwritten", ">min age", ">mean", ">max"), rows)


def _requirements(simulation: Simulation) -> Table:
    ordered = sorted(simulation.requirements, key=lambda each: WORST_OBSERVED_FIRST.index(each.verdict))
    columns = ("requirement", "~what", "limit", ">observed", "verdict", ">margin", "")
    return table("Requirements", columns, map(_requirement, ordered))


def _requirement(requirement: RequirementObservation) -> tuple[Cell, ...]:
    return (
        requirement.name,
        limited_text(requirement.quantity, requirement.object),
        limit_text(requirement),
        _observed_text(requirement),
        badge(requirement.verdict),
        "" if requirement.margin is None else _rounded(requirement, requirement.margin, Rounding.DOWN),
        _remark(requirement),
    )


def _observed_text(requirement: RequirementObservation) -> str:
    """The observed value of the limited quantity, on its side of the limit."""
    rounding = Rounding.UP if requirement.is_upper else Rounding.DOWN
    return _rounded(requirement, requirement.value, rounding, requirement.limit)


def _rounded(
    requirement: RequirementObservation, value: Fraction | None, rounding: Rounding, limit: Fraction | None = None
) -> str:
    if value is None or not requirement.is_time:
        return value_text(requirement, None if value is None else rounded(value, rounding, limit))
    return rounded_time_text(value, rounding, limit)


def _remark(requirement: RequirementObservation) -> str:
    """Why, and when a limit was missed first."""
    is_missed = requirement.verdict is ObservedVerdict.MISSED and requirement.at is not None
    when = f"at {time_text(round(requirement.at or 0))}" if is_missed else ""
    return ", ".join(filter(None, (requirement.reason, when)))


#: More runs are for a table in a file.
_MOST_RUNS = 50


def campaign_document(result: CampaignResult) -> ResultDocument:
    """The runs with what was observed in them, and how many of them missed something or failed."""
    shown = result.outcomes[:_MOST_RUNS]
    targets = list(dict.fromkeys(change.target for outcome in shown for change in outcome.run.changes))
    rows = []
    for outcome in shown:
        values = {change.target: change.value for change in outcome.run.changes}
        given = (values.get(target, "") for target in targets)
        rows.append((f"{outcome.run.number}", f"{outcome.run.seed}", *given, _observed_in(outcome)))
    more = len(result.outcomes) - len(shown)
    rest = [f"{counted(more, 'more run')} not shown; write all to a file with --table FILE"] if more else []
    runs = table("", (">run", ">seed", *(f">{target}" for target in targets), "observed"), rows)
    return document([section("", runs, Sentences(rest))], campaign_line(result))


def _observed_in(outcome: RunOutcome) -> str:
    if outcome.error:
        return f"failed: {outcome.error}"
    lost = outcome.record.get("lost_activations")
    missed, unseen, kept = (
        judged_in(outcome.record, verdict)
        for verdict in (ObservedVerdict.MISSED, ObservedVerdict.NOT_OBSERVED, ObservedVerdict.OK)
    )
    texts = [str(errors)] if (errors := outcome.record.get("errors")) else []
    texts += [f"missed: {', '.join(missed)}"] if missed else ["nothing missed"] if kept else []
    texts += [f"lost: {counted(lost, 'activation')}"] if isinstance(lost, int) and lost else []
    texts += [f"not observed: {len(unseen):,}"] if unseen else []
    return "; ".join(texts) or "nothing to judge"


def campaign_line(result: CampaignResult) -> str:
    """In how many runs something was missed, or that nothing was; how many failed, and in how many not everything was observed."""
    finished = len(result.outcomes)
    runs = counted(finished, "run") if result.is_complete else f"{finished:,} of {counted(result.planned, 'run')}"
    parts = [_missed_in(result)] if result.missed or result.is_anything_kept else []
    if result.failed:
        parts.append(f"{counted(len(result.failed), 'run')} failed: {result.failed[0].error}")
    if result.incomplete:
        parts.append(f"not everything was simulated in {len(result.incomplete):,}: {result.incomplete[0].record['errors']}")
    if result.not_observed:
        parts.append(f"limits not observed in {len(result.not_observed):,}")
    found = "; ".join(parts) or "no deadline, requirement or constraint to judge"
    return f"Observed in {runs} of {time_text(result.options.duration)} each: {found}; what was not observed can still occur"


def _missed_in(result: CampaignResult) -> str:
    """In how many runs something was missed, and what is missed in most of them."""
    numbers = Counter(name for outcome in result.missed for name in judged_in(outcome.record, ObservedVerdict.MISSED))
    if not numbers:
        return "nothing missed"
    ((name, number),) = numbers.most_common(1)
    what = name if len(numbers) == 1 else f"most often {name}, in {number:,}"
    return f"limits missed or activations lost in {len(result.missed):,} ({what})"
