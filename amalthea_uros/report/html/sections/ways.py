"""Ways of messages: the latency of each from end to end, and what each hop takes of it."""

from __future__ import annotations

from amalthea_uros.analyze.ways.results import Way
from amalthea_uros.executors.results import Hop
from amalthea_uros.report.html.blocks import Block, Cell, Folded, Section, Sentences, table
from amalthea_uros.report.html.times import at_least, at_most
from amalthea_uros.report.ways import HEADINGS, RIGHT, latency_row, part_time
from amalthea_uros.services.report import ReportContent


def section(content: ReportContent) -> Section | None:
    """A row for each way, and its hops."""
    ways = content.analysis.ways
    if not ways:
        return None
    titles = [f">{title}" if number in RIGHT else title for number, title in enumerate(HEADINGS)]
    latencies = table("Latency of messages, end to end", (*titles, "why"), list(map(latency_row, ways)))
    lead = "A latency is the sum of the bounds of its hops, which need not occur in one run."
    return Section("ways", "Ways of messages", lead, [latencies, *(_hops(way) for way in ways if way.hops)])


def _hops(way: Way) -> Folded:
    rows: list[tuple[Cell, ...]] = []
    for hop in way.hops:
        rows.append(
            (f"{hop.kind}: {hop.name}", at_least(hop.best), at_most(hop.worst), _share(way, hop), hop.reason or hop.source)
        )
        rows += [(f"- {part.name}", "", part_time(part), "", part.why) for part in hop.parts]
    blocks: list[Block] = [table(f"Hops of {way.name}", ("hop", ">best", ">worst", ">share", "why"), rows)]
    notes = [*(hop.remedy for hop in way.hops if hop.worst is None and hop.remedy), *way.assumptions]
    if notes:
        blocks.append(Sentences(list(dict.fromkeys(notes))))
    return Folded(f"What {way.name} takes its time for", blocks)


def _share(way: Way, hop: Hop) -> str:
    share = way.share(hop)
    return "" if share is None else f"{float(share):.1%}"
