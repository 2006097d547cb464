"""What would shorten a latency of a chain."""

from __future__ import annotations

from amalthea_uros._internal.plural import counted
from amalthea_uros.analyze.results.chains import LatencyQuantity
from amalthea_uros.report.html.blocks import Block, Cell, Folded, Sentences, table
from amalthea_uros.report.html.times import at_most
from amalthea_uros.services.analyze import AnalysisResult
from amalthea_uros.services.improvements import Improvement, improvements
from amalthea_uros.services.report import ReportContent

#: Further changes shorten the latency less.
_MOST = 5
#: Each change is analysed: in larger systems that takes longer than the rest of the report.
MOST_RUNNABLES, MOST_PROCESSES = 300, 100


def block(content: ReportContent, chain: str, quantity: LatencyQuantity) -> Block:
    """The single changes with the greatest effect, and what they make worse."""
    software = content.system.software
    if len(software.runnables) > MOST_RUNNABLES or len(content.system.processes) > MOST_PROCESSES:
        return Sentences([f"The system is large; amuros analyze --explain {chain} also tries what would shorten the latency."])
    found = improvements(_analyzed(content), chain, quantity)
    tried = f"{counted(found.tried, 'change')} analysed, one at a time"
    if found.untried:
        tried += f"; {found.untried:,} more were not tried"
    rows = [_row(each) for each in found.best(_MOST)]
    if not rows:
        return Sentences([f"No single change shortens it: {tried}."])
    titles = ("change", ">before", ">after", "claim", "what gets worse")
    changes = table(f"Changes that shorten the latency of {chain}", titles, rows)
    return Folded("What would shorten it", [changes, Sentences([f"{tried}."])])


def _analyzed(content: ReportContent) -> AnalysisResult:
    periods = content.assembly.task_periods if content.assembly is not None else ()
    system, settings = content.system, content.settings
    return AnalysisResult(
        paths=(), task_periods=periods, system=system, settings=settings, analysis=content.analysis, findings=()
    )


def _row(improvement: Improvement) -> tuple[Cell, ...]:
    worse = "; ".join(f"{each.name}: {each.before} to {each.after}" for each in improvement.drawbacks)
    return (improvement.change.text, at_most(improvement.before), at_most(improvement.after), str(improvement.claim), worse)
