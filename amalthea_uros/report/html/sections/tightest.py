"""The tightest requirements and the worst chains."""

from __future__ import annotations

from amalthea_uros.analyze.results import Analysis, ChainResult, Quantity
from amalthea_uros.report.html.badges import badge, verdict_badge
from amalthea_uros.report.html.blocks import Block, Cell, Section, table
from amalthea_uros.report.judged import judged_rows, limit_text, margin_text, requirements_of, why, worst_chains
from amalthea_uros.report.latencies import value_text
from amalthea_uros.services.report import ReportContent

_MOST = 8


def section(content: ReportContent) -> Section | None:
    """The first rows of both; all of them are in later sections."""
    analysis = content.analysis
    blocks: list[Block] = []
    rows = judged_rows(analysis)
    if rows:
        shown = [
            (
                row.item.name,
                row.what,
                row.value,
                row.limit,
                row.margin,
                row.used,
                row.claim,
                verdict_badge(row.item),
                why(row.item),
            )
            for row in rows[:_MOST]
        ]
        titles = ("requirement", "what", ">value", ">limit", ">margin", ">used", "claim", "verdict", "why")
        blocks.append(table(f"Tightest of {len(rows):,} deadlines, requirements and constraints", titles, shown))
    chains = worst_chains(analysis)
    if chains:
        of_chains = ("chain", ">reaction time", ">data age", "claim", ">limit", ">margin", "verdict", "why")
        shown_chains = [_chain(chain, analysis) for chain in chains[:_MOST]]
        blocks.append(table(f"Worst of {len(chains):,} event chains", of_chains, shown_chains))
    if not blocks:
        return None
    lead = "Missed and unknown limits come first, then those with the least margin; “exact” values occur, “bounds” are never exceeded."
    return Section("tightest", "Tightest requirements and worst chains", lead, blocks)


def _chain(chain: ChainResult, analysis: Analysis) -> tuple[Cell, ...]:
    values = [chain.value(quantity) for quantity in (Quantity.MAX_REDUCED_REACTION_TIME, Quantity.MAX_REDUCED_DATA_AGE)]
    claims = dict.fromkeys(str(value.claim) for value in values if value is not None and value.value is not None)
    worst = next(iter(requirements_of(chain.name, analysis)), None)
    return (
        chain.name,
        *(value_text(value).replace("-", "unknown") for value in values),
        ", ".join(claims),
        "-" if worst is None or worst.limit is None else f"{worst.quantity} {limit_text(worst)}",
        "-" if worst is None else margin_text(worst),
        badge(None) if worst is None else verdict_badge(worst),
        chain.reason or ("" if worst is None else why(worst)),
    )
