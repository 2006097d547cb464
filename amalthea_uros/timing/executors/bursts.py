"""Rounds that follow each other more densely than the stimulus of their task says.

The stimulus of an executor without a sleep occurs when something arrives that begins a round. While a round is suspended, because a
publication waits, others become due, and follow it without a pause: to processes of lower priority they come later and closer together.
A loop with a period catches up after a round that took longer, with rounds that follow each other as messages arrive.
"""

from __future__ import annotations

from amalthea_uros.perf.executors import Executor, LoopKind
from amalthea_uros.timing.executors.loops import least_sleep
from amalthea_uros.timing.executors.readiness import shares_session
from amalthea_uros.timing.executors.wait import greatest_wait
from amalthea_uros.units import Time


def dense_rounds(executor: Executor, others: tuple[Executor, ...], longest: Time) -> str:
    """Why it is unknown how close together the rounds of an executor can be; "" if its stimulus says it.

    Parameters
    ----------
    longest : greatest execution time of a round
    """
    if least_sleep(executor):
        return ""
    waiting = [publication.topic for handle in executor.handles for publication in handle.publications if publication.waits]
    if waiting:
        return (
            f"its loop has no sleep, so that rounds follow each other after one in which a publication of {waiting[0]!r} waited"
        )
    if shares_session(executor, others):
        return "its loop has no sleep, so that rounds follow each other after one that waited for others of its session"
    if executor.loop.kind is LoopKind.SPIN_PERIOD and greatest_wait(executor) + longest > (executor.loop.period or 0):
        return "a wait and a round can be longer than its period, so that rounds follow each other until it has caught up"
    return ""
