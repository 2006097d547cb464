"""Effects of changes, maximum factors on execution times, and better priorities, as sections of documents."""

from __future__ import annotations

from fractions import Fraction

from amalthea_uros.analyze.impact import Effect, Impact, impact
from amalthea_uros.analyze.priorities.assignment import Proposal, ProposalOutcome
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.sensitivity import MAX_FACTOR, Sensitivity
from amalthea_uros.report.basics.document import (
    Badge,
    Block,
    Cell,
    ResultDocument,
    Section,
    Sentences,
    Table,
    Tone,
    document,
    lines,
    section,
    table,
)
from amalthea_uros.report.wording.cells import UNKNOWN, at_least
from amalthea_uros.report.wording.impact import impact_cells, unchanged_text
from amalthea_uros.services.what_if import WhatIf

_EFFECTS = {Effect.BETTER: Tone.GOOD, Effect.WORSE: Tone.BAD, Effect.UNKNOWN: Tone.UNKNOWN}


def what_if_document(result: WhatIf) -> ResultDocument:
    """The changed values, and the effect on the results."""
    return document((section("", lines(*map(str, result.differences))), impact_section(result.impact)))


def proposal_document(proposal: Proposal) -> ResultDocument:
    """Better priorities for the tasks of a scheduler, or why there are none."""
    return document([priorities_section(proposal)])


def comparison_section(before: Analysis, after: Analysis) -> Section:
    """Two analyses of a system compared."""
    return impact_section(impact(before, after))


def impact_section(effect: Impact, remark: str = "") -> Section:
    """The effect of a change on the results."""
    title = "Before and after the change" + (f" ({remark})" if remark else "")
    return section(title, impact_table(effect), Sentences([unchanged_text(effect)]))


def impact_table(effect: Impact) -> Table:
    """A row for each figure that changed."""
    rows: list[tuple[Cell, ...]] = [
        (*cells[:-2], Badge(cells[-2], _EFFECTS.get(row.effect, Tone.NEUTRAL)), cells[-1])
        for row, cells in zip(effect.rows, impact_cells(effect), strict=True)
    ]
    return table("Results before and after the change", ("object", "quantity", ">before", ">after", "effect", "claim"), rows)


def factors_section(sensitivity: Sensitivity) -> Section:
    """By how much execution times can increase."""
    rows = [("all together", _factor(sensitivity.everything), "", "")]
    rows += [
        (name, _factor(factor), at_least(sensitivity.execution_times[name]), _longest(sensitivity, name))
        for name, factor in sensitivity.processes.items()
    ]
    factors = table("Maximum factors", ("process", ">factor", ">execution time", ">may grow to"), rows)
    return section("Maximum factors on execution times", factors)


def _longest(sensitivity: Sensitivity, name: str) -> str:
    factor = sensitivity.processes[name]
    return "" if factor is None or factor >= MAX_FACTOR else at_least(sensitivity.longest(name))


def _factor(factor: Fraction | None) -> str:
    if factor is None:
        return "none"
    return f"{float(factor):.3f}" if factor < MAX_FACTOR else f"{MAX_FACTOR} or more"


def priorities_section(proposal: Proposal) -> Section:
    """The proposed priorities of the tasks of a core."""
    return section(f"Priorities on {proposal.core}", _priorities(proposal))


def _priorities(proposal: Proposal) -> Block:
    if proposal.outcome is ProposalOutcome.KEPT:
        return Sentences(["the present priorities meet all deadlines"])
    if proposal.priorities is None:
        return Sentences([f"no proposal: {proposal.reason}"])
    ordered = sorted(proposal.priorities.items(), key=lambda item: -item[1])
    rows = [(name, UNKNOWN if (now := proposal.current[name]) is None else str(now), str(to)) for name, to in ordered]
    return table("Proposed priorities", ("task", ">now", ">proposed"), rows)
