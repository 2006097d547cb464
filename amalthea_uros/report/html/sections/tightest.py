"""All requirements and chains, the worst first."""

from __future__ import annotations

from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.results.chains import ChainResult, LatencyQuantity
from amalthea_uros.report.html.badges import badge, verdict_badge
from amalthea_uros.report.html.blocks import Block, Cell, Section, table
from amalthea_uros.report.judged import judged_rows, limit_text, margin_text, requirements_of, why, worst_chains
from amalthea_uros.report.latencies import value_text
from amalthea_uros.services.report import ReportContent


def section(content: ReportContent) -> Section | None:
    """What is missed, unknown or closest to its limit first; the rest of long tables is folded."""
    analysis = content.analysis
    blocks: list[Block] = []
    rows = judged_rows(analysis)
    if rows:
        shown = [
            (
                row.item.name,
                verdict_badge(row.item),
                row.what,
                row.value,
                row.limit,
                row.used,
                row.margin,
                row.claim,
                why(row.item),
            )
            for row in rows
        ]
        titles = ("requirement", "verdict", "what", ">value", ">limit", ">used", ">margin", "claim", "why")
        blocks.append(table("Deadlines, requirements and constraints", titles, shown))
    chains = worst_chains(analysis)
    if chains:
        of_chains = ("chain", "verdict", ">reaction time", ">data age", "claim", ">limit", ">margin", "why")
        blocks.append(table("Latencies of event chains", of_chains, [_chain(chain, analysis) for chain in chains]))
    if not blocks:
        return None
    lead = (
        "What is missed or unknown comes first, then what uses most of its limit. “Met” and “missed” are certain; a limit between the"
        " known ends of a value is unknown. “Exact” values occur, a “bound” is never exceeded."
    )
    return Section("requirements", "Closest to their limits", lead, blocks)


def _chain(chain: ChainResult, analysis: Analysis) -> tuple[Cell, ...]:
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
