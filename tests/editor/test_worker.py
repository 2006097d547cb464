"""Jobs beside the event loop."""

import asyncio
import threading

import pytest

pytest.importorskip("pygls")

from amalthea_uros.editor.worker import Worker


def test_a_job_runs_in_another_thread_and_gives_its_result():
    assert asyncio.run(Worker("test").run(threading.get_ident)) != threading.get_ident()


def test_an_error_reaches_whoever_waits_and_the_worker_goes_on():
    async def work():
        worker = Worker("test")
        with pytest.raises(ZeroDivisionError):
            await worker.run(lambda: 1 / 0)
        return await worker.run(lambda: 1)

    assert asyncio.run(work()) == 1


def test_a_job_that_nobody_waits_for_any_more_is_left_out():
    done, start = [], threading.Event()

    async def work():
        worker = Worker("test")
        first = asyncio.create_task(worker.run(start.wait))
        second = asyncio.create_task(worker.run(lambda: done.append("second")))
        await asyncio.sleep(0)
        second.cancel()
        await asyncio.sleep(0)
        start.set()
        await first
        await worker.run(lambda: done.append("third"))

    asyncio.run(work())
    assert done == ["third"]
