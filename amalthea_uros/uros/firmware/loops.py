"""The loops of threads as lines of C."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.spec.executors import ExecutorSection
from amalthea_uros.spec.loops import LoopItem, LoopSection
from amalthea_uros.units import Time, time_text
from amalthea_uros.uros.firmware.entities import CodePublisher
from amalthea_uros.uros.firmware.ports import CodePort, waiting

_NANOSECOND, _MILLISECOND = 10**3, 10**9


def without_code(message: str, location: Location | None) -> Finding:
    """Something in a description that has no code."""
    return Finding("GEN010", Severity.ERROR, message, location, "Generate without --code, or change the description.")


def loop_lines(
    section: ExecutorSection, executors: Mapping[str, str], publishers: Mapping[str, CodePublisher], port: CodePort
) -> tuple[bool, list[str]]:
    """Whether the lines are to be repeated, and the lines.

    Parameters
    ----------
    executors : the variables of executors, by name
    publishers : by topic

    Raises
    ------
    ReadError : it has no loop, or a port cannot wait so.
    """
    loop = section.loop
    if loop is None:
        raise ReadError([without_code(f"{section.name!r} has no 'loop'", section.location())])
    own = executors.get(section.name, "")
    if loop.spin_period is not None:
        timeout = [] if loop.timeout is None else [f"rclc_executor_set_timeout(&{own}, {nanoseconds(loop.timeout)});"]
        return False, [*timeout, f"rclc_executor_spin_period(&{own}, {nanoseconds(loop.spin_period)});"]
    if loop.spin is not None:
        return False, [f"rclc_executor_set_timeout(&{own}, {nanoseconds(loop.spin)});", f"rclc_executor_spin(&{own});"]
    if loop.items is None:
        return True, list(_plain(loop, own, port))
    return True, [line for item in loop.items for line in _item(item, own, executors, publishers, port)]


def _plain(loop: LoopSection, own: str, port: CodePort) -> Iterator[str]:
    yield _spin(own, loop.spin_some or 0)
    if loop.sleep:
        yield _wait(port.sleep, loop.sleep, "sleep", loop.location("sleep"))


def _item(
    item: LoopItem, own: str, executors: Mapping[str, str], publishers: Mapping[str, CodePublisher], port: CodePort
) -> Iterator[str]:
    if item.every is not None:
        raise ReadError([without_code("code that sends only so often ('every') is not written", item.location("every"))])
    if item.spin_some is not None:
        yield _spin(executors[item.executor] if item.executor is not None else own, item.spin_some)
    elif item.sleep is not None:
        yield _wait(port.sleep, item.sleep, "sleep", item.location("sleep"))
    elif item.busy_wait is not None:
        yield _wait(port.wait, item.busy_wait, "wait without sleeping", item.location("busy_wait"))
    elif item.publish is not None:
        for topic in item.publish:
            publisher = publishers[topic]
            yield f"amuros_note(rcl_publish(&{publisher.variable}, &{publisher.message.variable}, NULL));"
    elif item.ping is not None:
        attempts = item.attempts or 1
        yield f"(void) rmw_uros_ping_agent({_milliseconds(item.ping // attempts)}, {attempts});"
    elif item.sync is not None:
        yield f"(void) rmw_uros_sync_session({_milliseconds(item.sync)});"


def _spin(executor: str, timeout: Time) -> str:
    return f"amuros_note(rclc_executor_spin_some(&{executor}, {nanoseconds(timeout)}));"


def _wait(template: str, time: Time, what: str, location: Location | None) -> str:
    call = waiting(template, time)
    if call is None:
        message = f"no function of the port is known to {what} for {time_text(time)}"
        raise ReadError([without_code(message, location)])
    return call


def nanoseconds(time: Time) -> str:
    """A time as rclc takes it."""
    return f"RCL_MS_TO_NS({time // _MILLISECOND})" if time % _MILLISECOND == 0 else str(time // _NANOSECOND)


def _milliseconds(time: Time) -> int:
    return time // _MILLISECOND
