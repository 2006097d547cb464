"""When a callback ends in the jobs of its executor: what they execute before it, and the worst case."""

from __future__ import annotations

from dataclasses import dataclass

from amalthea_uros.analyze.execution_shares import ExecutionShare, execution_shares
from amalthea_uros.analyze.results import Analysis, CallbackResult, ProcessResult


@dataclass(frozen=True, slots=True, kw_only=True)
class CallbackExplanation:
    """What the response time of a callback consists of.

    Attributes
    ----------
    process : whose jobs call it
    execution : what these jobs execute up to the callback, in order, with the callback itself last
    """

    callback: CallbackResult
    process: ProcessResult
    execution: tuple[ExecutionShare, ...]


def explain_callback(analysis: Analysis, name: str) -> tuple[CallbackExplanation, ...]:
    """The explanation of a callback, for each process that calls it."""
    return tuple(
        CallbackExplanation(
            callback=callback,
            process=analysis.processes[callback.process],
            execution=_until(execution_shares(analysis.solution.context, callback.process), name),
        )
        for callback in analysis.callbacks
        if callback.name == name
    )


def _until(shares: list[ExecutionShare], name: str) -> tuple[ExecutionShare, ...]:
    """The shares up to the one of a runnable; all of them if a job calls it inside another runnable."""
    index = next((number for number, share in enumerate(shares) if share.is_runnable and share.name == name), len(shares))
    return tuple(shares[: index + 1])
