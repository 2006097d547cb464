"""How the worst cases of chains come about."""

from __future__ import annotations

from amalthea_uros.analyze.explanations.chains import ChainExplanation, ProcessHop, explain_chain
from amalthea_uros.analyze.results.chains import LatencyQuantity
from amalthea_uros.report.html import shortened
from amalthea_uros.report.html.blocks import Block, Figure, Folded, Heading, Section, Sentences, table
from amalthea_uros.report.judged import LIMITED, decisive_quantity, requirements_of, worst_chains
from amalthea_uros.report.latencies import value_text
from amalthea_uros.report.pictures.chain_hops import draw_hops
from amalthea_uros.services.report import ReportContent
from amalthea_uros.timing.response import Claim
from amalthea_uros.units import Time, time_text

#: Chains that are explained, the worst first, and those of them that are seen at once.
MOST_CHAINS, _SHOWN = 6, 2


def section(content: ReportContent) -> Section | None:
    """The hops of the worst chains, of each the latency with the tightest limit; of the worst one, also what would shorten it."""
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
            found.append(shortened.block(content, chain.name, quantity))
        blocks += [Heading(_title(explanation)), *found] if number < _SHOWN else [Folded(_title(explanation), found)]
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
    rows = [_row(hop) for hop in explanation.hops]
    if explanation.overwritten:
        rows.append(("until overwritten", "", "", "", "", "", time_text(explanation.overwritten), ""))
    titles = ("process", ">job", ">release", ">start", ">read", ">write", ">wait", ">run")
    notes = [f"{explanation.route}.", f"{value.claim}: {value.method} ({value.source})."]
    if value.claim is Claim.BOUND:
        notes.append("Each read is as early and each write as late as possible, which need not occur in one run.")
    return [
        Figure(name, draw_hops(explanation, limit)),
        table(f"Hops of {explanation.chain.name}; times are relative to the first read", titles, rows),
        Sentences(notes),
    ]


def _limit(chain: str, quantity: LatencyQuantity, content: ReportContent) -> Time | None:
    """The tightest limit of a latency."""
    limits = (
        each for each in requirements_of(chain, content.analysis) if each.is_upper and LIMITED.get(each.quantity) is quantity
    )
    return min((each.limit for each in limits if each.limit is not None), default=None)


def _row(hop: ProcessHop) -> tuple[str, ...]:
    return (
        hop.process,
        "-" if hop.job is None else f"{hop.job:,}",
        *(_time(time) for time in (hop.release, hop.start, hop.read, hop.write, hop.wait, hop.run)),
    )


def _time(time: Time | None) -> str:
    return "-" if time is None else time_text(time)
