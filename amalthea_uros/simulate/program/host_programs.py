"""The program of a thread of an executor of the host: each job calls one callback."""

from __future__ import annotations

from typing import TYPE_CHECKING

from amalthea_uros.perf.host import HostExecutor
from amalthea_uros.simulate.kernel import layout
from amalthea_uros.simulate.program.image import JumpLabel, JumpTable

if TYPE_CHECKING:
    from amalthea_uros.perf.software import Process
    from amalthea_uros.simulate.program.body import Body


def add_thread(body: Body, process: Process, executor: HostExecutor) -> None:
    """Append the wait for a callback, all callbacks of which one is called, and what each publishes."""
    records, code, done = body.resources.executors, body.code, JumpLabel()
    thread = records.host.threads[process.name]
    table, _ = body.resources.image.items([0] * len(executor.callbacks))
    labels: list[JumpLabel] = []
    code.add(layout.BEGIN_WAIT, thread)
    code.add(layout.CALL_NEXT, thread, table)
    for activity, callback in zip(process.activities, executor.callbacks, strict=True):
        labels.append(code.here())
        measured = records.measure_host(executor, callback, thread)
        code.add(layout.BEGIN_ITERATION)
        code.add(layout.BEGIN_EXECUTION, measured)
        body.activities([activity])
        code.add(layout.END_EXECUTION, measured)
        for publication in records.host.publications(callback, records.messages.transmissions):
            code.add(layout.HOST_PUBLISH, publication)
        code.add(layout.HAVE_CALLED, thread)
        code.add(layout.JUMP, done)
    code.tables.append(JumpTable(labels, table))
    code.mark(done)
    code.add(layout.PLAN_ITERATION, thread)
