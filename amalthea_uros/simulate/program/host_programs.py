"""The program of a thread of an executor of the host: each job calls one callback."""

from __future__ import annotations

from typing import TYPE_CHECKING

from amalthea_uros.perf.host import HostCallback, HostExecutor
from amalthea_uros.simulate.kernel import layout
from amalthea_uros.simulate.program.host_system import host_name
from amalthea_uros.simulate.program.image import JumpLabel, JumpTable

if TYPE_CHECKING:
    from amalthea_uros.perf.software import Process
    from amalthea_uros.simulate.program.body import Body


def add_thread(body: Body, process: Process, executor: HostExecutor) -> None:
    """Append the wait for a callback, all callbacks of which one is called, and what each publishes."""
    messages, code, done = body.resources.executors.messages, body.code, JumpLabel()
    thread = messages.host.threads[process.name]
    table, _ = body.resources.image.items([0] * len(executor.callbacks))
    labels: list[JumpLabel] = []
    code.add(layout.BEGIN_WAIT, thread)
    code.add(layout.CALL_NEXT, thread, table)
    for activity, callback in zip(process.activities, executor.callbacks, strict=True):
        labels.append(code.here())
        measured = _measured(body, executor, callback, thread)
        code.add(layout.BEGIN_ITERATION)
        code.add(layout.BEGIN_EXECUTION, measured)
        body.activities([activity])
        code.add(layout.END_EXECUTION, measured)
        for publication in messages.host.publications(callback, process.name, messages.transmissions):
            code.add(layout.HOST_PUBLISH, publication)
        code.add(layout.HAVE_CALLED, thread)
        code.add(layout.JUMP, done)
    code.tables.append(JumpTable(labels, table))
    code.mark(done)
    code.add(layout.PLAN_ITERATION, thread)


def _measured(body: Body, executor: HostExecutor, callback: HostCallback, thread: int) -> int:
    """The record of the calls of a callback by a thread, from its release; they count together with those of other threads."""
    executors, key = body.resources.executors, (host_name(executor), callback.name)
    if key not in executors.measured:
        executors.measured.append(key)
    number = executors.first_number + executors.measured.index(key)
    fields = {layout.EXECUTION_NUMBER: number, layout.ASKED_AT: thread + layout.CALLED_SINCE}
    return body.resources.image.record(layout.EXECUTION_SIZE, fields)
