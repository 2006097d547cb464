"""How the code of a port looks: its headers, how it sleeps and waits, and how it starts threads."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from amalthea_uros._internal.ports import known_ports
from amalthea_uros._internal.records import dataclass
from amalthea_uros.perf.named import Brief
from amalthea_uros.units import Time

_MICROSECOND, _MILLISECOND = 10**6, 10**9


@dataclass(frozen=True, slots=True, kw_only=True)
class CodePort(Brief):
    """A port as code.

    Attributes
    ----------
    headers : that it needs, which also identify it
    sleep, wait : how a thread sleeps, and waits without sleeping; `{ms}` and `{us}` are the time; "" if it cannot
    threads : how threads are started: `freertos`, `zephyr`, or "" for one in `main`
    entry : `main`, or `arduino` for `setup` and `loop`
    ticks : the setting of its configuration for ticks per second; "" if that is elsewhere
    stack_unit : bytes of what the function that starts a thread counts stacks in
    """

    headers: tuple[str, ...]
    sleep: str = "usleep({us});"
    wait: str = ""
    threads: str = ""
    entry: str = "main"
    stack_unit: int = 1
    suffix: str = "c"
    ticks: str = ""


#: Operating systems with a port of their name, built by micro_ros_setup or as a module.
_AS_PORTS = ("freertos", "zephyr", "nuttx")


def code_port(port: str | None, rtos: str | None) -> CodePort:
    """The code of a port, or of the operating system if no port is stated; else that of a POSIX system."""
    known = known_ports().get(port or (rtos if rtos in _AS_PORTS else ""))
    facts: Mapping[str, Any] = {"headers": ["unistd.h"]} if known is None else known.code
    return CodePort(**{**facts, "headers": tuple(facts["headers"])})


def waiting(template: str, time: Time) -> str | None:
    """The call that waits for a time; None if the function cannot wait so long or so exactly."""
    unit = _MILLISECOND if "{ms}" in template else _MICROSECOND
    if not template or time % unit:
        return None
    return template.format(ms=time // _MILLISECOND, us=time // _MICROSECOND)
