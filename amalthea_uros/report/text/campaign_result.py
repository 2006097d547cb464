"""A campaign for people."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from amalthea_uros._internal.plural import counted
from amalthea_uros.design.campaign.run import RunOutcome
from amalthea_uros.report.writers.terminal import Terminal
from amalthea_uros.services.simulate import KEPT, MISSED, NOT_OBSERVED, CampaignResult, judged_in
from amalthea_uros.units import time_text

#: More runs are for a table in a file.
_SHOWN = 50


def write(result: CampaignResult, terminal: Terminal) -> None:
    """Write the runs with what was observed in them, and how many of them missed something or failed."""
    shown = result.outcomes[:_SHOWN]
    targets = list(dict.fromkeys(change.target for outcome in shown for change in outcome.run.changes))
    rows = [(outcome.run.number, outcome.run.seed, *_values(outcome, targets), _observed(outcome)) for outcome in shown]
    terminal.table(("run", "seed", *targets, "observed"), rows, right=range(2 + len(targets)))
    if more := len(result.outcomes) - len(shown):
        terminal.line(f"  {counted(more, 'more run')} not shown; write all to a file with --table FILE")
    terminal.heading(closing_line(result))


def write_closing(result: CampaignResult, terminal: Terminal) -> None:
    """Write what was observed, in one line."""
    terminal.line(closing_line(result))


def _values(outcome: RunOutcome, targets: list[str]) -> Iterator[str]:
    values = {change.target: change.value for change in outcome.run.changes}
    return (values.get(target, "") for target in targets)


def _observed(outcome: RunOutcome) -> str:
    if outcome.error:
        return f"failed: {outcome.error}"
    lost = outcome.record.get("lost_activations")
    missed, unseen, kept = (judged_in(outcome.record, verdict) for verdict in (MISSED, NOT_OBSERVED, KEPT))
    texts = [str(errors)] if (errors := outcome.record.get("errors")) else []
    texts += [f"missed: {', '.join(missed)}"] if missed else ["nothing missed"] if kept else []
    texts += [f"lost: {counted(lost, 'activation')}"] if isinstance(lost, int) and lost else []
    texts += [f"not observed: {len(unseen):,}"] if unseen else []
    return "; ".join(texts) or "nothing to judge"


def closing_line(result: CampaignResult) -> str:
    """In how many runs something was missed, or that nothing was; how many failed, and in how many not everything was observed."""
    finished = len(result.outcomes)
    runs = counted(finished, "run") if result.is_complete else f"{finished:,} of {counted(result.planned, 'run')}"
    duration = time_text(result.options.duration)
    parts = [_missed(result)] if result.missed or result.is_anything_kept else []
    if result.failed:
        parts.append(f"{counted(len(result.failed), 'run')} failed: {result.failed[0].error}")
    if result.incomplete:
        parts.append(f"not everything was simulated in {len(result.incomplete):,}: {result.incomplete[0].record['errors']}")
    if result.not_observed:
        parts.append(f"limits not observed in {len(result.not_observed):,}")
    found = "; ".join(parts) or "no deadline, requirement or constraint to judge"
    return f"Observed in {runs} of {duration} each: {found}; what was not observed can still occur"


def _missed(result: CampaignResult) -> str:
    """In how many runs something was missed, and what is missed in most of them."""
    numbers = Counter(name for outcome in result.missed for name in judged_in(outcome.record, MISSED))
    if not numbers:
        return "nothing missed"
    ((name, number),) = numbers.most_common(1)
    what = name if len(numbers) == 1 else f"most often {name}, in {number:,}"
    return f"limits missed or activations lost in {len(result.missed):,} ({what})"
