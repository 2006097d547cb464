"""A built model with the decisions of its assembly, for people."""

from __future__ import annotations

from amalthea_uros._internal.plural import counted
from amalthea_uros.perf.executors import Executor
from amalthea_uros.perf.system import System
from amalthea_uros.report.memory_text import memory_rows
from amalthea_uros.report.wording.cells import activation_text
from amalthea_uros.report.writers.terminal import Terminal
from amalthea_uros.services.build import BuildResult
from amalthea_uros.units import percent_text, time_text
from amalthea_uros.uros.application.entities import Initialisation
from amalthea_uros.uros.assemble import Assembly
from amalthea_uros.uros.memory import MemoryDemand
from amalthea_uros.uros.middleware.options import Option, OptionRole


def write(result: BuildResult, terminal: Terminal) -> None:
    """Write tables of tasks, interrupts, messages, and the start and the pools of the middleware."""
    write_closing(result, terminal)
    assembly = result.assembly
    _tasks(terminal, assembly)
    _isrs(terminal, assembly.system)
    _executors(terminal, assembly)
    _traffic(terminal, assembly)
    if assembly.initialisation is not None:
        terminal.heading("Initialisation of the middleware")
        terminal.line(f"  {start_text(assembly.initialisation)}")
    _pools(terminal, assembly)
    _memory(terminal, assembly.memory)


def write_closing(result: BuildResult, terminal: Terminal) -> None:
    """Write which file was written."""
    objects = counted(sum(1 for _ in result.model.walk()), "object")
    document = result.document
    name = terminal.style(str(document.path or "unsaved"), "1")
    terminal.line(f"{name}: AMALTHEA {document.version}, {objects}, built from {result.description}")


def _tasks(terminal: Terminal, assembly: Assembly) -> None:
    system = assembly.system
    reasons = {choice.task: choice.reason for choice in assembly.choices}
    rows = []
    for allocation in system.mapping.tasks:
        task = system.processes[allocation.task]
        scheduler = system.schedulers[allocation.scheduler]
        when = ", ".join(activation_text(system.stimuli_by_name[name]) for name in task.stimuli)
        rows.append((task.name, when, allocation.priority, ", ".join(scheduler.cores), reasons.get(task.name, "")))
    if rows:
        terminal.heading(f"Tasks ({len(rows)})")
        terminal.table(("task", "activated", "priority", "core", "reason"), rows, right=(2,))
    if assembly.placement:
        terminal.line(f"  {assembly.placement}")


def _isrs(terminal: Terminal, system: System) -> None:
    rows = []
    for allocation in system.mapping.isrs:
        isr = system.processes[allocation.isr]
        when = ", ".join(activation_text(system.stimuli_by_name[name]) for name in isr.stimuli)
        cores = ", ".join(system.interrupt_controllers[allocation.controller].cores)
        rows.append((isr.name, when, allocation.priority, cores))
    if rows:
        terminal.heading(f"Interrupt service routines ({len(rows)})")
        terminal.table(("ISR", "activated", "priority", "core"), rows, right=(2,))


def _executors(terminal: Terminal, assembly: Assembly) -> None:
    executors = assembly.system.executors
    if not executors:
        return
    terminal.heading(f"Executors ({len(executors)})")
    for executor in executors:
        terminal.line(f"  {executor.name}: {loop_text(executor)}")
    rows = [
        (
            executor.name,
            number,
            handle.name,
            handle.kind,
            "-" if handle.interval is None else time_text(handle.interval),
            handle.runnable,
        )
        for executor in executors
        for number, handle in enumerate(executor.handles, start=1)
    ]
    terminal.table(("executor", "order", "handle", "kind", "interval", "calls"), rows, right=(1, 4))


def loop_text(executor: Executor) -> str:
    """How an executor spins, in words."""
    loop = executor.loop
    timeout = f"timeout {time_text(loop.timeout)}"
    period = "" if loop.period is None else f", period {time_text(loop.period)}"
    sleep = f", sleep {time_text(loop.sleep)}" if loop.sleep else ""
    semantics = ", all messages are taken first (LET)" if executor.takes_first else ""
    return f"{loop.kind}, {timeout}{period}{sleep}; trigger condition {executor.trigger.kind}{semantics}"


def _traffic(terminal: Terminal, assembly: Assembly) -> None:
    if not assembly.messages:
        return
    load = float(sum(item.bus_load for item in assembly.messages))
    terminal.heading(f"Messages on the CAN bus (bus load at most {percent_text(load, 1)} %)")
    rows = [
        (
            item.message.topic,
            "in" if item.message.is_incoming else "out",
            time_text(item.message.interval),
            f"{item.length} B",
            item.frames,
            time_text(item.transmission_time),
        )
        for item in assembly.messages
    ]
    headings = ("topic", "direction", "interval", "with headers", "frames", "transmission time")
    terminal.table(headings, rows, right=(2, 3, 4, 5))


def start_text(start: Initialisation) -> str:
    """The initialisation of the middleware, in a sentence."""
    count = f"{counted(len(start.entities), 'entity')}, created one after the other"
    text = f"{count}: at least {counted(start.min_cycles, 'cycle')} ({time_text(start.min_time)})"
    if start.max_cycles is None or start.max_time is None:
        return text
    return f"{text}, at most {counted(start.max_cycles, 'cycle')} ({time_text(start.max_time)})"


def _pools(terminal: Terminal, assembly: Assembly) -> None:
    used = [pool for pool in assembly.pools if pool.needed]
    if not used:
        return
    terminal.heading("Static pools")
    rows = [(pool.name, _needed(pool), pool.available, "" if pool.is_stated else "default") for pool in used]
    terminal.table(("option", "needed", "available", ""), rows, right=(1, 2))


def _needed(pool: Option) -> str:
    """What a pool needs; how many messages wait depends on response times, and is known only after an analysis."""
    return f"at least {pool.needed}" if pool.role is OptionRole.QUEUE else str(pool.needed)


def _memory(terminal: Terminal, memory: MemoryDemand) -> None:
    rows = memory_rows(memory)
    if rows:
        terminal.heading("Memory")
        terminal.table(("part", "size", ""), rows, right=(1,))
