"""When a callback ends in the jobs of its executor: what they execute before it, and the worst case."""

from __future__ import annotations

from dataclasses import dataclass

from amalthea_uros.analyze.execution_shares import ExecutionShare, execution_shares
from amalthea_uros.analyze.results import Analysis, CallbackResult, ProcessResult
from amalthea_uros.executors.results import HandleResult


@dataclass(frozen=True, slots=True, kw_only=True)
class CallbackExplanation:
    """What the response time of a callback consists of.

    Attributes
    ----------
    process : whose jobs call it
    execution : what these jobs execute up to the callback, in order, with the callback itself last
    handles : in an executor that spins in a loop, the handles that call it; their terms take the response time apart
    """

    callback: CallbackResult
    process: ProcessResult
    execution: tuple[ExecutionShare, ...]
    handles: tuple[HandleResult, ...] = ()


def explain_callback(analysis: Analysis, name: str) -> tuple[CallbackExplanation, ...]:
    """The explanation of a callback, for each process that calls it."""
    return tuple(
        CallbackExplanation(
            callback=callback,
            process=analysis.processes[callback.process],
            execution=() if handles else _until(execution_shares(analysis.solution.context, callback.process), name),
            handles=handles,
        )
        for callback in analysis.callbacks
        if callback.name == name
        for handles in [_handles(analysis, callback)]
    )


def _handles(analysis: Analysis, callback: CallbackResult) -> tuple[HandleResult, ...]:
    """The handles of an executor that spins in a loop that call a callback."""
    found = (executor for executor in analysis.executors if executor.task == callback.process)
    return tuple(handle for executor in found for handle in executor.handles if handle.runnable == callback.name)


def _until(shares: list[ExecutionShare], name: str) -> tuple[ExecutionShare, ...]:
    """The shares up to the one of a runnable; all of them if a job calls it inside another runnable."""
    index = next((number for number, share in enumerate(shares) if share.is_runnable and share.name == name), len(shares))
    return tuple(shares[: index + 1])
