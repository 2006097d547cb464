"""The one answer of an analysis in three lines: what is at most, what most of it is, and what would help."""

from __future__ import annotations

import shlex
from collections.abc import Iterator

from amalthea_uros.analyze.results.chains import LIMITED
from amalthea_uros.analyze.results.explanations import ChainExplanation, ProcessExplanation
from amalthea_uros.analyze.results.processes import ProcessorResult, ProcessResult, RequirementResult
from amalthea_uros.judge.evidence import Ends
from amalthea_uros.judge.verdict import FAILURES, Verdict
from amalthea_uros.report.wording.cells import at_least, at_most, load_text, relief
from amalthea_uros.report.wording.chains import remark
from amalthea_uros.report.wording.largest_part import largest_cause, largest_term
from amalthea_uros.services.first_answer import FirstAnswer
from amalthea_uros.units import Rounding, Time, time_text

#: Of an overloaded core, so many processes are named.
_SHARES = 3
#: Of a change, so many drawbacks.
_DRAWBACKS = 2


def answer_lines(first: FirstAnswer) -> Iterator[str]:
    """The answer, the first line alone being enough."""
    yield headline(first)
    yield from filter(None, (_largest(first), *_help(first)))


def headline(first: FirstAnswer) -> str:
    """The limited quantity, its value and limit, and how far they are apart."""
    item = first.item
    if isinstance(item, ProcessorResult):
        return f"{item.name}: overloaded, at least {load_text(item.at_least, Rounding.DOWN)} of its time is needed"
    value, limit, bound = _value(item), item.limit, "at most" if item.is_upper else "at least"
    if limit is None:
        return f"{_subject(first)}: {item.verdict}"
    text = f"no bound, limit {bound} {time_text(limit)}"
    if value is not None:
        text = f"{_bounded(value, limit, is_upper=item.is_upper)}, limit {time_text(limit)}"
    return f"{_subject(first)}: {text}: {_distance(item)}"


def _subject(first: FirstAnswer) -> str:
    """The subject of the limit."""
    item, chain = first.item, first.chain
    assert not isinstance(item, ProcessorResult)
    if isinstance(item, ProcessResult):
        return f"{item.name}, response time"
    if chain is not None and item.quantity in LIMITED:
        between = f"{chain.start} to {chain.end}" if chain.start and chain.end else chain.name
        return between if item.quantity == "reaction" else f"{between}, {item.quantity}"
    return f"{item.object}, {item.quantity}" if item.object else item.name


def _value(item: ProcessResult | RequirementResult) -> Time | None:
    """The safe end of what is limited."""
    if isinstance(item, RequirementResult):
        return item.value
    return None if item.response is None else item.response.worst


def _bounded(value: Time, limit: Time, *, is_upper: bool) -> str:
    return f"at most {at_most(value, limit)}" if is_upper else f"at least {at_least(value, limit)}"


def _distance(item: ProcessResult | RequirementResult) -> str:
    """How far the value is from the limit; of a bound beyond the limit, the value itself can be anywhere before it."""
    margin = item.margin
    if item.verdict is Verdict.UNKNOWN:
        if margin is None or margin >= 0:
            return f"not proved: {item.reason}" if item.reason else "not proved"
        return f"not proved, the bound is {at_most(-margin)} {'above' if item.is_upper else 'below'} it"
    if item.verdict in FAILURES:
        if (missed := _missed_by(item)) is not None:
            return f"missed by {'' if missed == -(margin or 0) else 'at least '}{at_least(missed)}"
        word = str((item.failure if isinstance(item, ProcessResult) else None) or item.verdict)
        return item.reason if item.reason.startswith(word) else ": ".join(filter(None, (word, item.reason)))
    return f"{item.verdict}" if margin is None else f"{item.verdict}, {at_least(margin)} left"


def _missed_by(item: ProcessResult | RequirementResult) -> Time | None:
    """By how much a limit is missed for certain; None if it is not the value that is wrong."""
    ends = Ends(item.lower, item.upper) if isinstance(item, RequirementResult) else item.worst_response
    certain, limit = ends.lower if item.is_upper else ends.upper, item.limit
    if certain is None or limit is None:
        return None
    beyond = certain - limit if item.is_upper else limit - certain
    return beyond if beyond > 0 else None


def _largest(first: FirstAnswer) -> str:
    """The largest part, in words."""
    explained, chain = first.explanation, first.chain
    if first.shares:
        shares = (f"{name} {load_text(share, Rounding.UP)}" for name, share in first.shares[:_SHARES])
        return f"most of it: {', '.join(shares)}"
    if isinstance(explained, ProcessExplanation):
        largest = largest_term(explained)
        return f"largest part: {largest}" if largest else ""
    if chain is not None and chain.crosses_messages:
        said = remark(chain)
        if chain.worst_if_not_lost is not None and chain.loss:
            return f"at most {at_most(chain.worst_if_not_lost)} for messages that are not lost"
        return "" if said == getattr(first.item, "reason", "") else said
    if isinstance(explained, ChainExplanation) and (largest := largest_cause(explained)):
        return f"largest part: {largest}"
    return ""


def _help(first: FirstAnswer) -> Iterator[str]:
    """The change that helps most, and the options to try it."""
    found, best, item = first.improvements, first.best, first.item
    if isinstance(item, ProcessorResult):
        yield f"what helps: {relief(item, is_wire=first.is_wire)}"
    if found is None or not isinstance(item, RequirementResult):
        return
    if best is None:
        yield f"no change that was tried helps without breaking something else ({found.tried} tried)"
        return
    verdict = ", limit met" if best.is_enough else ""
    if item.limit is not None and best.after > item.limit:
        verdict = f", still {at_most(best.after - item.limit)} above"
    yield f"best change: {best.change.text}: at most {at_most(best.after, item.limit)}{verdict}"
    if best.drawbacks:
        worse = (f"{each.name}: {each.before} -> {each.after}" for each in best.drawbacks[:_DRAWBACKS])
        yield f"what it makes worse: {'; '.join(worse)}"
    yield f"to see all its effects: {shlex.join(best.change.options)}"
