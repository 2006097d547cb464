"""A report as a page: all that is known of the timing of a system, what matters most first."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from amalthea_uros.analyze.explanations.processes import explain_process
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.results.chains import ChainResult, LatencyQuantity
from amalthea_uros.analyze.results.explanations import ProcessExplanation
from amalthea_uros.analyze.results.processes import ProcessorResult
from amalthea_uros.report.basics.document import (
    Badge,
    Block,
    Cell,
    Figure,
    Folded,
    Heading,
    Section,
    Sentences,
    Table,
    Tone,
    section,
    table,
)
from amalthea_uros.report.documents.analysis import (
    callbacks,
    cores_of,
    execution_times,
    handles,
    latencies_of_messages,
    methods,
    response_times,
    wires_of,
)
from amalthea_uros.report.documents.descriptions import bus_section, pools_section
from amalthea_uros.report.documents.explanation import interference, message_hops, terms_of
from amalthea_uros.report.documents.findings import findings_section
from amalthea_uros.report.documents.judged import (
    concerned,
    judged_items,
    limit_text,
    limits_table,
    margin_text,
    requirements_of,
    why,
    worst_chains,
)
from amalthea_uros.report.documents.observed import host_section, observed_section
from amalthea_uros.report.documents.worst_cases import gantt_section, histogram_section, hops_section
from amalthea_uros.report.pictures.load_bars import draw_loads
from amalthea_uros.report.pictures.response_bars import draw_responses
from amalthea_uros.report.pictures.system_picture import draw_system
from amalthea_uros.report.wording.cells import badge, load_cells, load_text, verdict_badge
from amalthea_uros.report.wording.chains import value_text
from amalthea_uros.report.wording.closing_line import closing_line
from amalthea_uros.services.report import ReportContent


def _changes_section(content: ReportContent) -> Section | None:
    """The values before and after, and the verdict without the changes."""
    if content.before is None:
        return None
    from amalthea_uros.report.documents.changes import comparison_section

    rows = [(each.target, each.before, each.after) for each in content.differences]
    return Section(
        "changes",
        "What was changed",
        "This report is about the system with these changes; the files are as they were.",
        (
            table("Changed values", ("value", "before", "after"), rows),
            *comparison_section(content.before, content.analysis).blocks,
            Sentences([f"Before the changes: {closing_line(content.before.summary)}"]),
        ),
    )


def chains_table(analysis: Analysis) -> Table:
    """The latencies of all chains, the worst first."""
    columns = ("chain", "verdict", ">reaction time", ">data age", "claim", ">limit", ">margin", "why")
    return table("Latencies of event chains", columns, [_chain_of_limits(chain, analysis) for chain in worst_chains(analysis)])


def _tightest_section(content: ReportContent) -> Section:
    """What is missed, unknown or closest to its limit first; the rest of long tables is folded."""
    lead = (
        "What is missed or unknown comes first, then what uses most of its limit. “Met” and “missed” are certain; a limit between the"
        " known ends of a value is unknown. “Exact” values occur, a “bound” is never exceeded."
    )
    found = limits_table(content.analysis), chains_table(content.analysis)
    return section("Closest to their limits", *found, lead=lead, anchor="requirements")


def _chain_of_limits(chain: ChainResult, analysis: Analysis) -> tuple[Cell, ...]:
    values = [
        chain.value(quantity) for quantity in (LatencyQuantity.MAX_REDUCED_REACTION_TIME, LatencyQuantity.MAX_REDUCED_DATA_AGE)
    ]
    claims = dict.fromkeys(str(value.claim) for value in values if value is not None and value.value is not None)
    worst = next(iter(requirements_of(chain.name, analysis)), None)
    return (
        chain.name,
        badge(None) if worst is None else verdict_badge(worst),
        *(value_text(value).replace("-", "unknown") for value in values),
        ", ".join(claims),
        "-" if worst is None or worst.limit is None else f"{worst.quantity} {limit_text(worst)}",
        "-" if worst is None else margin_text(worst),
        chain.reason or ("" if worst is None else why(worst)),
    )


def _message_chains_section(content: ReportContent) -> Section | None:
    """A row for each chain over wires and executors, and its hops."""
    chains = content.analysis.message_chains
    if not chains:
        return None
    lead = "A latency is the sum of the bounds of its hops, which need not occur in one run."
    blocks: list[Block] = [latencies_of_messages(content.analysis), *(_hops(chain) for chain in chains if chain.hops)]
    return Section("message-chains", "Chains over wires and executors", lead, blocks)


def _hops(chain: ChainResult) -> Folded:
    remarks = [*(hop.remedy for hop in chain.hops if hop.worst is None and hop.remedy), *chain.assumptions]
    found = section("", message_hops(chain), Sentences(list(dict.fromkeys(remarks))))
    return Folded(f"Where the latency of {chain.name} comes from", found.blocks)


def _system_section(content: ReportContent) -> Section | None:
    """The tasks on their cores, and the flows between them."""
    if not content.system.processes:
        return None
    lead = "Boxes are tasks and interrupts on their cores, the most urgent first. Arrows are data and triggers, coloured ones chains."
    return Section("system", "System", lead, [Figure("system", draw_system(content.system, content.analysis))])


def _load_section(content: ReportContent) -> Section | None:
    """The best, mean and worst load of each core and wire that is used."""
    cores, wires = cores_of(content.analysis), wires_of(content.analysis)
    if not cores and not wires:
        return None
    tables = [
        table(
            title, (kind, clock, ">best", ">mean", ">worst", ">observed", ""), [_row_of_loads(each, content) for each in used]
        )
        for title, kind, clock, used in (
            ("Load of each core", "core", ">clock", cores),
            ("Utilisation of each wire", "wire", ">bit rate", wires),
        )
        if used
    ]
    lead = "The part of its time that a core needs for what is activated; above 100 % work piles up without end."
    title = "Load of the cores and wires" if wires else "Load of the cores"
    return Section("load", title, lead, [Figure("loads", draw_loads(content.analysis)), *tables])


def _row_of_loads(core: ProcessorResult, content: ReportContent) -> tuple[Cell, ...]:
    simulation = content.simulation.simulation if content.simulation is not None else None
    observed = simulation.cores[core.name].load if simulation is not None else None
    network = content.analysis.solution.context.system.network
    return (*load_cells(core, network), "-" if observed is None else load_text(observed), _remark(core))


def _remark(core: ProcessorResult) -> Cell:
    if core.is_overloaded:
        return Badge("overload", Tone.BAD)
    return "" if core.worst is not None else Badge("partly unknown", Tone.UNKNOWN)


#: The processes whose interference is listed, the tightest first.
_MOST_EXPLAINED = 5


def _response_times_section(content: ReportContent) -> Section | None:
    """All processes; of the tightest, who interferes."""
    analysis = content.analysis
    if not analysis.processes:
        return None
    simulation = content.simulation.simulation if content.simulation is not None else None
    blocks: list[Block] = [Figure("responses", draw_responses(analysis, simulation))]
    blocks.append(response_times(analysis, is_detailed=True))
    blocks += [Folded(f"What delays {each.process.name}", [interference(each)]) for each in _tightest(content)]
    blocks += filter(None, [execution_times(analysis), callbacks(analysis.of_periodic_executors)])
    lead = "From the activation of a task to its end: the worst case is the sum of its own execution and of what delays it."
    return Section("response-times", "Response times", lead, blocks)


def _tightest(content: ReportContent) -> list[ProcessExplanation]:
    """The explanations of the processes with the tightest response times."""
    analysis = content.analysis
    names = dict.fromkeys(map(concerned, judged_items(analysis)))
    found = [analysis.processes[name] for name in names if name in content.system.processes]
    known = [each.name for each in found if each.response is not None and each.response.worst is not None]
    explained = (explain_process(analysis, name) for name in known)
    return [each for _, each in zip(range(_MOST_EXPLAINED), (each for each in explained if each.shares), strict=False)]


def _executors_section(content: ReportContent) -> Section | None:
    """A table for each executor, and the terms of each response time."""
    executors = content.analysis.executors
    if not executors:
        return None
    blocks: list[Block] = []
    for executor in executors:
        blocks.append(handles(executor, is_detailed=True))
        blocks += [Folded(f"What {each.name} waits for", [terms_of(each)]) for each in executor.handles if each.terms]
    lead = "From the arrival of a message at the controller, or from when a timer is due, to the end of the callback."
    return Section("executors", "Executors", lead, blocks)


def _methods_section(content: ReportContent) -> Section | None:
    """What the numbers rest on."""
    simulated = content.simulation.simulation.assumptions if content.simulation is not None else ()
    lists = {
        "Assumptions of the analysis": content.analysis.assumptions,
        "Assumptions of the simulation": tuple(each for each in simulated if each not in content.analysis.assumptions),
        "Methods and sources": methods(content.analysis),
    }
    blocks: list[Block] = []
    for title, sentences in lists.items():
        if sentences:
            blocks += (Heading(title), Sentences(list(sentences)))
    lead = "Each number holds under these assumptions, and was computed by a published method."
    return Section("methods", "Assumptions and methods", lead, blocks) if blocks else None


#: The sections in their order; those that have nothing to show are left out.
_SECTIONS: Sequence[Callable[[ReportContent], Section | None]] = (
    _changes_section,
    _tightest_section,
    _message_chains_section,
    _system_section,
    _load_section,
    _response_times_section,
    _executors_section,
    host_section,
    observed_section,
    gantt_section,
    histogram_section,
    hops_section,
    findings_section,
    _methods_section,
    bus_section,
    pools_section,
)


def page_sections(content: ReportContent) -> list[Section]:
    """The sections in which there is something."""
    made = (make(content) for make in _SECTIONS)
    return [each for each in made if each is not None and each.blocks]
