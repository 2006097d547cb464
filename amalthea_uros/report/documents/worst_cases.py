"""The worst cases of a system in pictures: the hops of chains, the worst that was observed, and distributions."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial

from amalthea_uros._internal.plural import counted
from amalthea_uros.analyze.explanations.chains import explain_chain
from amalthea_uros.analyze.results.chains import LIMITED, LatencyQuantity
from amalthea_uros.analyze.results.explanations import ChainExplanation
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.report.basics.document import Block, Figure, Folded, Heading, Section, Sentences
from amalthea_uros.report.documents.explanation import changes, hops, tried
from amalthea_uros.report.documents.judged import (
    concerned,
    decisive_quantity,
    judged_items,
    requirements_of,
    worst_chains,
)
from amalthea_uros.report.pictures.chain_hops import draw_hops
from amalthea_uros.report.pictures.histogram import Mark, MarkKind
from amalthea_uros.report.pictures.simulation import gantt_picture, histogram_picture
from amalthea_uros.report.wording.cells import at_least, at_most, words
from amalthea_uros.report.wording.chains import value_text
from amalthea_uros.services.report import ReportContent
from amalthea_uros.services.simulate import SimulationResult
from amalthea_uros.simulate.observations import MetricObservation
from amalthea_uros.timing.basics.quantities import ChainQuantity, JobMetric
from amalthea_uros.timing.response import Claim
from amalthea_uros.units import Time

#: Chains that are explained, the worst first, and those of them that are seen at once.
MOST_CHAINS, _SHOWN_OF_HOPS = 6, 2


def hops_section(content: ReportContent) -> Section | None:
    """The hops of the worst chains, of each the latency with the tightest limit; if that is not met, also what would shorten it."""
    chains = worst_chains(content.analysis)
    if not chains:
        return None
    blocks: list[Block] = []
    for number, chain in enumerate(chains[:MOST_CHAINS]):
        quantity = decisive_quantity(chain.name, content.analysis)
        limit = _limit(chain.name, quantity, content)
        explanation = explain_chain(content.analysis, chain.name, quantity)
        found = _blocks(explanation, limit, f"hops-{number}")
        if number == 0 and requirements_of(chain.name, content.analysis):
            found.append(_shortened(content, chain.name, quantity))
        blocks += [Heading(_title(explanation)), *found] if number < _SHOWN_OF_HOPS else [Folded(_title(explanation), found)]
    if len(chains) > MOST_CHAINS:
        sentence = f"The {MOST_CHAINS} worst of {len(chains):,} chains are shown; amuros analyze --explain NAME explains any."
        blocks.append(Sentences([sentence]))
    lead = "Where the time goes on the way from the stimulus to the response: waits and runs add up to the latency."
    return Section("chains", "Worst cases of the event chains", lead, blocks)


def _title(explanation: ChainExplanation) -> str:
    quantity = explanation.quantity.removeprefix("max_reduced_").replace("_", " ")
    return f"{explanation.chain.name}: {quantity} {value_text(explanation.value).replace('-', 'unknown')}"


def _blocks(explanation: ChainExplanation, limit: Time | None, name: str) -> list[Block]:
    value = explanation.value
    if not explanation.hops or value is None or value.value is None:
        return [Sentences([f"Its single hops are not known: {explanation.reason}."])]
    notes = [f"{explanation.route}.", f"{value.claim}: {value.method} ({value.source})."]
    if value.claim is Claim.BOUND:
        notes.append("Each read is as early and each write as late as possible, which need not occur in one run.")
    return [
        Figure(name, draw_hops(explanation, limit)),
        hops(explanation),
        Sentences(notes),
    ]


def _limit(chain: str, quantity: LatencyQuantity, content: ReportContent) -> Time | None:
    """The tightest limit of a latency."""
    limits = (
        each for each in requirements_of(chain, content.analysis) if each.is_upper and LIMITED.get(each.quantity) is quantity
    )
    return min((each.limit for each in limits if each.limit is not None), default=None)


def _shortened(content: ReportContent, chain: str, quantity: LatencyQuantity) -> Block:
    """The single changes with the greatest effect, and what they make worse, if the answer of the analysis has tried them."""
    found = None if content.answer is None else content.answer.improvements
    if found is None or (found.chain, found.quantity) != (chain, quantity):
        return Sentences([f"What would shorten the latency is tried by amuros analyze --explain {chain}."])
    if not found.found:
        return Sentences([f"No single change shortens it: {tried(found)}."])
    return Folded("What would shorten it", [changes(found), Sentences([f"{tried(found)}."])])


#: Chains whose ways are drawn, rows of a chart, and charts that are seen at once.
_MOST_CHAINS_OF_GANTT, _MOST_ROWS, _SHOWN_OF_GANTT = 3, 40, 2


def gantt_section(content: ReportContent) -> Section | None:
    """Around the job that came closest to its deadline, and around the longest latency of the worst chains."""
    if content.simulation is None or not any(each.response_time for each in content.simulation.simulation.processes):
        return None
    charts: list[Block] = []
    missing: list[str] = []
    for number, draw in enumerate(_charts(content)):
        try:
            charts.append(Figure(f"gantt-{number}", draw()))
        except InvalidArgumentError as error:
            missing.append(f"Not drawn: {error}.")
    blocks = charts[:_SHOWN_OF_GANTT]
    if charts[_SHOWN_OF_GANTT:]:
        blocks.append(Folded(counted(len(charts[_SHOWN_OF_GANTT:]), "more chart"), charts[_SHOWN_OF_GANTT:]))
    if missing:
        blocks.append(Sentences(missing))
    lead = "What each task does around the longest observed times; lines between tasks show the path of an event chain."
    return Section("worst-observed", "Worst observed cases", lead, blocks)


def _charts(content: ReportContent) -> Iterator[Callable[[], str]]:
    assert content.simulation is not None
    yield partial(gantt_picture, content.simulation, most_rows=_MOST_ROWS)
    observed = [
        chain for chain in worst_chains(content.analysis) if content.simulation.simulation.chains[chain.name].quantities
    ]
    for chain in observed[:_MOST_CHAINS_OF_GANTT]:
        yield partial(gantt_picture, content.simulation, chain=chain.name, most_rows=_MOST_ROWS)


_MOST_CHAINS_OF_HISTOGRAMS, _MOST_PROCESSES = 3, 3


def histogram_section(content: ReportContent) -> Section | None:
    """Those of the worst chains; those of the tightest tasks are folded if there are chains."""
    if content.simulation is None:
        return None
    simulation = content.simulation
    chains = [_block(simulation, f"histogram-{number}", *each) for number, each in enumerate(_chains(content))]
    tasks = [_block(simulation, f"histogram-of-task-{number}", *each) for number, each in enumerate(_processes(content))]
    title = "Response times of the tasks that are closest to their limits"
    blocks = [*chains, Folded(title, tasks)] if chains and tasks else [*chains, *tasks]
    lead = "How often each time was observed; the bound of the analysis is never exceeded, the limit must not be."
    return Section("histograms", "Distributions of observed times", lead, blocks) if blocks else None


def _block(
    simulation: SimulationResult, name: str, of: str, quantity: str, observed: MetricObservation, marks: Sequence[Mark]
) -> Block:
    """A histogram; a sentence for values that are all in the same bin."""
    if observed.histogram is not None and sum(count > 0 for count in observed.histogram.counts) > 1:
        return Figure(name, histogram_picture(simulation, f"{of}.{quantity}", marks))
    least, most = at_least(observed.min), at_most(observed.max)
    values = least if least == most else f"{least} to {most}"
    return Sentences([f"The {words(quantity)} of {of} was {values} in all {observed.count:,} observations."])


def _chains(content: ReportContent) -> Iterator[tuple[str, str, MetricObservation, Sequence[Mark]]]:
    assert content.simulation is not None
    quantity = ChainQuantity.REDUCED_REACTION_TIME
    observed = content.simulation.simulation.chains
    chains = [each for each in worst_chains(content.analysis) if quantity in observed[each.name].quantities]
    for chain in chains[:_MOST_CHAINS_OF_HISTOGRAMS]:
        marks = [
            Mark("limit", each.limit, MarkKind.LIMIT)
            for each in requirements_of(chain.name, content.analysis)
            if each.quantity == "reaction" and each.is_upper and each.limit is not None
        ]
        value = chain.value(LatencyQuantity.MAX_REDUCED_REACTION_TIME)
        if value is not None and value.value is not None:
            marks.append(Mark("worst case", value.value, MarkKind.BOUND))
        yield chain.name, quantity, observed[chain.name].quantities[quantity], marks


def _processes(content: ReportContent) -> Iterator[tuple[str, str, MetricObservation, Sequence[Mark]]]:
    assert content.simulation is not None
    # Without those that are not simulated.
    simulated = {each.name: each for each in content.simulation.simulation.processes}
    names = dict.fromkeys(map(concerned, judged_items(content.analysis)))
    found = [simulated[name] for name in names if name in simulated]
    for each in [each for each in found if each.response_time is not None][:_MOST_PROCESSES]:
        assert each.response_time is not None
        response = content.analysis.processes[each.name].response
        worst = response.worst if response is not None else None
        marks = [] if worst is None else [Mark("worst case", worst, MarkKind.BOUND)]
        yield each.name, JobMetric.RESPONSE_TIME, each.response_time, marks
