"""The largest part of a response time or latency, in words."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from amalthea_uros.analyze.results.explanations import ChainExplanation, ProcessExplanation
from amalthea_uros.report.wording.cells import at_most, share_text
from amalthea_uros.report.wording.chains import cause_text
from amalthea_uros.units import Time


class LatencyPart(NamedTuple):
    """A wait or a run in a latency."""

    process: str
    kind: str
    time: Time
    reason: str


def latency_parts(explanation: ChainExplanation) -> Iterator[LatencyPart]:
    """All waits and runs with their causes, in their order."""
    for hop in explanation.hops:
        for kind, causes in (("wait", hop.wait_causes), ("run", hop.run_causes)):
            for cause in causes:
                yield LatencyPart(hop.process, kind, cause.time, cause_text(cause, hop))
    if explanation.overwritten:
        yield LatencyPart(explanation.hops[-1].process, "wait", explanation.overwritten, "until it writes again")


def largest_cause(explanation: ChainExplanation) -> str:
    """Which wait or run takes the largest part of a latency; "" if none is known."""
    largest = max(latency_parts(explanation), key=lambda part: part.time, default=None)
    if largest is None:
        return ""
    return f"{at_most(largest.time)} ({share_text(explanation.share(largest.time))}), {largest.process}: {largest.reason}"


def largest_term(explanation: ProcessExplanation) -> str:
    """The largest part of a response time; "" if it has no several parts."""
    response = explanation.process.response
    if response is None or response.worst is None:
        return ""
    shares = {f"interference by {share.name}": share.time for share in explanation.shares}
    terms = {term: time for term, time in response.terms.items() if time and not (term == "interference" and shares)}
    parts = {**terms, **shares}
    if len(parts) < 2:
        return ""
    name = max(parts, key=lambda part: parts[part])
    return f"{at_most(parts[name])} ({parts[name] / response.worst:.1%}), {name}"
