"""How many received messages can wait at the same time, as the analysis finds: what the size of their storage has to be."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.diagnostics import Finding
from amalthea_uros.executors.results import ExecutorResult
from amalthea_uros.executors.semantics.readiness import messages
from amalthea_uros.perf.executors import Executor
from amalthea_uros.perf.qualified import qualified
from amalthea_uros.uros.assemble import Assembly
from amalthea_uros.uros.generated_options import WaitingMessages, with_waiting_messages
from amalthea_uros.uros.middleware.checks import kept_messages
from amalthea_uros.uros.middleware.options import OptionRole
from amalthea_uros.uros.storage import storage_of


def with_analysed_storage(assembly: Assembly, analysis: Analysis | None = None) -> Assembly:
    """The assembly with what the analysis finds to be needed for messages that wait.

    Parameters
    ----------
    analysis : of its system; None: it is made
    """
    if assembly.controllers:
        analysis = analysis or analyze_system(assembly.system)
        parts = {
            name: _with_storage(each, waiting_messages(each, analysis, name)) for name, each in assembly.controllers.items()
        }
        return replace(assembly, controllers=parts)
    return _with_storage(assembly, waiting_messages(assembly, analysis))


def _with_storage(assembly: Assembly, waiting: WaitingMessages | None) -> Assembly:
    return replace(assembly, options=with_waiting_messages(assembly.options, waiting))


#: Messages that are dropped because no slot is free.
_NO_SLOT = "EXE014"


def findings_of(assembly: Assembly | None, analysis: Analysis) -> Iterator[Finding]:
    """The findings of an analysis, with advice about the storage for messages that fits the memory of the board.

    Parameters
    ----------
    assembly : of the system of the analysis; None if no description says how large the memory is
    """
    for finding in analysis.findings:
        # The storage of a robot is that of several controllers, each with its own memory.
        is_stored = finding.rule == _NO_SLOT and assembly is not None and not assembly.controllers
        advice = _storage_advice(assembly, analysis) if is_stored and assembly is not None else ""
        yield replace(finding, help=advice) if advice else finding


def _storage_advice(assembly: Assembly, analysis: Analysis) -> str:
    storage = storage_of(assembly.profile, assembly.description.application, assembly.options, assembly.memory)
    waiting = waiting_messages(assembly, analysis)
    return "" if storage is None or waiting is None else storage.advice(waiting.most, f"{waiting.most}, {waiting.why}")


def waiting_messages(assembly: Assembly, analysis: Analysis | None = None, part: str = "") -> WaitingMessages | None:
    """The messages that can wait at the same time; None if the middleware has no limit for them, or no executor spins in a loop.

    Parameters
    ----------
    analysis : of the system of the assembly, or of the robot that it is a part of; None: it is made
    part : the name of the controller in the robot
    """
    described = [each.available for each in assembly.options if each.role is OptionRole.QUEUE]
    executors = assembly.system.executors
    if not described or not executors:
        return None
    if part:
        executors = tuple(qualified(each, part) for each in executors)
    results = (analysis or analyze_system(assembly.system)).executors
    found = [results[each.name] for each in executors]
    unbounded = [name for each in executors for name in _unbounded(each, results[each.name])]
    periodic = [each.name for each in assembly.description.middleware.stated_executors if each.loop is None]
    needed = [each.slots_needed for each in found if each.slots_needed is not None]
    if not periodic and len(needed) == len(found):
        kept = f"all that are kept for {' and '.join(unbounded)}, whose response time has no bound"
        return WaitingMessages(most=max(needed), why=kept if unbounded else "as many as the analysis finds")
    # What nobody knows to be unnecessary is kept.
    most = max(*needed, *described, kept_messages(assembly.description.application, assembly.profile.middleware))
    why = f"no number is known to be enough because of {' and '.join(periodic or unbounded)}"
    return WaitingMessages(most=most, why=why)


def _unbounded(executor: Executor, result: ExecutorResult) -> list[str]:
    """The handles whose messages may wait for ever."""
    return [each.name for each in messages(executor) if result.handles[each.name].response.worst is None]
