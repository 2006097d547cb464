"""Chains over wires and executors: the latency of each from end to end, and what each hop takes of it."""

from __future__ import annotations

from amalthea_uros.analyze.results.chains import ChainResult
from amalthea_uros.report.html.blocks import Block, Cell, Folded, Section, Sentences, table
from amalthea_uros.report.html.times import at_least, at_most
from amalthea_uros.report.message_chains import HEADINGS, RIGHT, latency_row, part_time, share_text
from amalthea_uros.services.report import ReportContent


def section(content: ReportContent) -> Section | None:
    """A row for each chain, and its hops."""
    chains = content.analysis.message_chains
    if not chains:
        return None
    titles = [f">{title}" if number in RIGHT else title for number, title in enumerate(HEADINGS)]
    latencies = table("Latency of messages, end to end", (*titles, "why"), list(map(latency_row, chains)))
    lead = "A latency is the sum of the bounds of its hops, which need not occur in one run."
    hops = [_hops(chain) for chain in chains if chain.hops]
    return Section("message-chains", "Chains over wires and executors", lead, [latencies, *hops])


def _hops(chain: ChainResult) -> Folded:
    rows: list[tuple[Cell, ...]] = []
    for hop in chain.hops:
        note = hop.reason or hop.source
        rows.append((f"{hop.kind}: {hop.name}", at_least(hop.best), at_most(hop.worst), share_text(hop), note))
        rows += [(f"- {part.name}", "", part_time(part), "", part.why) for part in hop.parts]
    blocks: list[Block] = [table(f"Hops of {chain.name}", ("hop", ">best", ">worst", ">share", "why"), rows)]
    remarks = [*(hop.remedy for hop in chain.hops if hop.worst is None and hop.remedy), *chain.assumptions]
    if remarks:
        blocks.append(Sentences(list(dict.fromkeys(remarks))))
    return Folded(f"Where the latency of {chain.name} comes from", blocks)
