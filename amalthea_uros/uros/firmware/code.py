"""From a description to C: one file with everything of micro-ROS in it, which calls functions that the application defines."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from amalthea_uros._internal.records import dataclass
from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.perf.executors import HandleKind
from amalthea_uros.perf.named import Brief
from amalthea_uros.perf.system import System
from amalthea_uros.spec.application import NodeSection
from amalthea_uros.spec.description import Description
from amalthea_uros.spec.executors import ExecutorSection
from amalthea_uros.units import SECOND, Time
from amalthea_uros.uros.firmware.entities import CodeEntities, CodeMessage, open_types
from amalthea_uros.uros.firmware.loops import loop_lines, nanoseconds, without_code
from amalthea_uros.uros.firmware.ports import CodePort, code_port, waiting
from amalthea_uros.uros.firmware.signatures import arguments, parameters, quality

if TYPE_CHECKING:
    from jinja2 import Environment

#: In which threads look whether everything is created: 10 ms.
_MOMENT = 10 * 10**9
#: Of identifiers with 29 bits: a start and an end for each callback, of low priority on the bus.
FIRST_STAMP = 0x18000000


@dataclass(frozen=True, slots=True, kw_only=True)
class CodeThread(Brief):
    """A thread, and what it does again and again.

    Attributes
    ----------
    repeats : whether the lines are in an endless loop; else they do not return
    """

    function: str
    identifier: str
    name: str
    section: ExecutorSection
    lines: tuple[str, ...]
    repeats: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class FirmwareCode(Brief):
    """The content of the templates.

    Attributes
    ----------
    tick : of the operating system
    reconnects : whether the loop creates everything anew when the agent comes back
    """

    port: CodePort
    entities: CodeEntities
    executors: dict[str, str]
    threads: tuple[CodeThread, ...]
    sections: dict[str, ExecutorSection]
    tick: Time | None
    reconnects: bool
    stamps: bool

    @property
    def headers(self) -> list[str]:
        """Those of the port, of rclc and of the types."""
        types = {header_of(message) for message in self.entities.messages}
        return [*self.port.headers, "stdbool.h", "rcl/rcl.h", "rclc/rclc.h", "rclc/executor.h", *sorted(types)]

    @property
    def open_messages(self) -> list[CodeMessage]:
        """Those whose strings and sequences need memory."""
        return [each for each in self.entities.messages if each.is_open]


def firmware_code(description: Description, system: System, *, reconnects: bool, stamps: bool) -> FirmwareCode:
    """The code of an application.

    Raises
    ------
    ReadError : something in the description has no code; carries a finding for each.
    """
    middleware, nodes = description.middleware, description.application.nodes
    problems = list(_problems(nodes))
    port = code_port(middleware.port, description.os.rtos)
    # Messages that loops send outside of callbacks are in the lines of the loops.
    created = [each for each in system.executors if all(handle.kind is not HandleKind.LOOP_ITEM for handle in each.handles)]
    entities = CodeEntities(nodes, created)
    names = entities.names
    # Without threads of their own, executors have their names.
    prefix = ("executor",) if port.threads else ()
    executors = {each.name: names.of(*prefix, each.name) for each in created}
    publishers = {each.section.topic: each for each in entities.publishers}
    threads = []
    for section in middleware.executors or [middleware.executor]:
        if section.loop is None and _spins_elsewhere(section, middleware.executors):
            continue
        if port.threads and (section.stack is None or section.priority is None):
            problems.append(without_code(f"'stack' and 'priority' of {section.name!r} are not stated", section.location()))
        try:
            repeats, lines = loop_lines(section, executors, publishers, port)
        except ReadError as error:
            problems += error.findings
            continue
        function = names.of("run", section.name)
        threads.append(
            CodeThread(
                function=function,
                identifier=names.of(section.name),
                name=section.name,
                section=section,
                lines=tuple(lines),
                repeats=repeats,
            )
        )
    for section in middleware.stated_executors:
        if section.trigger.custom is not None:
            problems.append(
                without_code(f"the trigger of {section.name!r} is a function of the application", section.location())
            )
    if len(threads) > 1 and (not port.threads or reconnects):
        reason = "connecting again needs a single thread" if reconnects else "the port has one thread only"
        problems.append(without_code(f"{len(threads)} threads: {reason}", threads[1].section.location()))
    if reconnects and threads and not threads[0].repeats:
        problems.append(without_code("connecting again needs a loop with 'spin_some'", threads[0].section.location()))
    if problems:
        raise ReadError(problems)
    sections = {each.name: each for each in middleware.stated_executors}
    return FirmwareCode(
        port=port,
        entities=entities,
        executors=executors,
        threads=tuple(threads),
        sections=sections,
        tick=description.os.tick,
        reconnects=reconnects,
        stamps=stamps,
    )


def _spins_elsewhere(section: ExecutorSection, others: Sequence[ExecutorSection]) -> bool:
    """Whether an executor spins in the loop of another one."""
    loops = [each.loop for each in others if each.loop is not None]
    return any(item.executor == section.name for loop in loops for item in loop.items or ())


def _problems(nodes: Sequence[NodeSection]) -> Iterator[Finding]:
    for node in nodes:
        if node.lifecycle is not None:
            yield without_code(f"no code is written for a lifecycle of {node.name!r}", node.lifecycle.location())
    for section, kind in open_types(nodes):
        message = f"{kind} has no longest string or sequence: nothing can give it memory"
        yield Finding("GEN010", Severity.ERROR, message, section.location(), "State 'bounds'.")


def header_of(message: CodeMessage) -> str:
    """The header of a type: ros2/rosidl rosidl_cmake, string_camel_case_to_lower_case_underscore."""
    name = re.sub(r"(_SendGoal|_GetResult)?_(Request|Response)$|_FeedbackMessage$", "", message.type.name)
    snake = re.sub(r"(.)([A-Z][a-z]+)", r"\1_\2", name)
    snake = re.sub(r"([a-z0-9])([A-Z])", r"\1_\2", snake).lower()
    return f"{message.type.package}/{message.type.kind}/{snake}.h"


def code_texts(code: FirmwareCode, environment: Environment, content: Mapping[str, object]) -> dict[str, str]:
    """The files, by name."""

    def stack(thread: CodeThread) -> int:
        return -(-(thread.section.stack or 0) // (8 * code.port.stack_unit))

    functions = {
        "arguments": arguments,
        "nanoseconds": nanoseconds,
        "parameters": parameters,
        "quality": quality,
        "stack": stack,
    }
    handlers = [each for each in code.entities.every_handler if each.kind != "parameter_server"]
    stamps = [(each, FIRST_STAMP + 2 * number) for number, each in enumerate(handlers)]
    whole = {**content, **functions, "code": code, "stamps": stamps, "first_wait": waiting(code.port.sleep, _MOMENT)}
    names = {"amuros_app.c": f"amuros_app.{code.port.suffix}"}
    names |= {name: name for name in ("amuros_stamps.h", "amuros.markers.yml") if code.stamps}
    texts = {target: environment.get_template(f"{name}.j2").render(whole) for name, target in names.items()}
    if code.port.ticks and code.tick is not None:
        texts["sdkconfig.defaults"] = (
            f"# {content['mark']} from the description of {content['name']}.\n{code.port.ticks}={SECOND // code.tick}\n"
        )
    return texts | code.entities.stand_ins
