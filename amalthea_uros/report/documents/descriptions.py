"""What becomes of a description as documents: the built model, generated files, new descriptions; and the sections of a report."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING

from amalthea_uros._internal.plural import counted
from amalthea_uros.report.basics.document import (
    Badge,
    Block,
    Cell,
    Lead,
    Listing,
    ResultDocument,
    Section,
    Sentences,
    Table,
    Tone,
    document,
    lines,
    section,
    table,
)
from amalthea_uros.report.wording.cells import activation_text, exactly, load_text
from amalthea_uros.units import Rounding, Time, rounded_time_text, time_text

if TYPE_CHECKING:
    from amalthea_uros.perf.executors import Executor
    from amalthea_uros.services.build import BuildResult
    from amalthea_uros.services.generate import GenerateResult
    from amalthea_uros.services.import_code import ImportResult
    from amalthea_uros.services.init import Catalogue, InitResult, Offered
    from amalthea_uros.services.report import ReportContent
    from amalthea_uros.uros.assemble import Assembly
    from amalthea_uros.uros.creation_traffic import CreationTraffic
    from amalthea_uros.uros.initialisation import Initialisation
    from amalthea_uros.uros.memory import MemoryDemand
    from amalthea_uros.uros.middleware.options import Option


def build_document(result: BuildResult) -> ResultDocument:
    """Which file was written, with tables of tasks, interrupts, messages, and the start and the pools of the middleware."""
    assembly = result.assembly
    objects = counted(sum(1 for _ in result.model.walk()), "object")
    rest = f": AMALTHEA {result.document.version}, {objects}, built from {result.description}"
    written = lines(Lead(str(result.document.path or "unsaved"), rest))
    tasks, isrs = _tasks(assembly), _isrs(assembly)
    sections = (
        section("", written),
        section(f"Tasks ({len(tasks.rows)})", tasks, Sentences([assembly.placement] if assembly.placement else [])),
        section(f"Interrupt service routines ({len(isrs.rows)})", isrs),
        _executors(assembly.system.executors),
        *(each for one, of in _controllers(assembly) for each in _of_middleware(one, of)),
    )
    return document(sections, kept=[written])


def _controllers(assembly: Assembly) -> list[tuple[Assembly, str]]:
    """The controllers, with what titles say of which one they are; nothing if there is one."""
    return [(each, f" of {name}") for name, each in assembly.controllers.items()] or [(assembly, "")]


def _of_middleware(assembly: Assembly, of: str) -> Iterator[Section]:
    """The messages, the start and the pools of the middleware of a controller, and its memory."""
    initialisation = assembly.initialisation
    start = [] if initialisation is None else list(_start_texts(initialisation))
    yield section(f"Messages on the CAN bus{of} (bus load at most {_bus_load(assembly)})", _messages(assembly))
    yield section(f"Initialisation of the middleware{of}", Sentences(start))
    yield section(f"Static pools{of}", _pools(assembly))
    yield section(f"Memory{of}", _memory(assembly.memory))


def _tasks(assembly: Assembly) -> Table:
    system, reasons = assembly.system, {choice.task: choice.reason for choice in assembly.choices}
    rows = [
        (*_process(assembly, each.task), str(each.priority), ", ".join(system.schedulers[each.scheduler].cores), reason)
        for each in system.mapping.tasks
        for reason in (reasons.get(each.task, ""),)
    ]
    return table("", ("task", "activated", ">priority", "core", "reason"), rows)


def _isrs(assembly: Assembly) -> Table:
    system = assembly.system
    rows = [
        (*_process(assembly, each.isr), str(each.priority), ", ".join(system.interrupt_controllers[each.controller].cores))
        for each in system.mapping.isrs
    ]
    return table("", ("ISR", "activated", ">priority", "core"), rows)


def _process(assembly: Assembly, name: str) -> tuple[str, str]:
    """A process, and when it is activated."""
    system = assembly.system
    return name, ", ".join(activation_text(system.stimuli_by_name[each]) for each in system.processes[name].stimuli)


def _executors(executors: Sequence[Executor]) -> Section:
    rows = [
        (executor.name, str(number), handle.name, str(handle.kind), exactly(handle.interval), handle.runnable)
        for executor in executors
        for number, handle in enumerate(executor.handles, start=1)
    ]
    handles = table("", ("executor", ">order", "handle", "kind", ">interval", "calls"), rows)
    loops = Sentences([f"{executor.name}: {_loop_text(executor)}" for executor in executors])
    return section(f"Executors ({len(executors)})", loops, handles)


def _loop_text(executor: Executor) -> str:
    """How an executor spins, in words."""
    loop = executor.loop
    period = "" if loop.period is None else f", period {time_text(loop.period)}"
    sleep = f", sleep {time_text(loop.sleep)}" if loop.sleep else ""
    semantics = ", all messages are taken first (LET)" if executor.takes_first else ""
    return (
        f"{loop.kind}, timeout {time_text(loop.timeout)}{period}{sleep}; trigger condition {executor.trigger.kind}{semantics}"
    )


def _messages(assembly: Assembly, of: str = "") -> Table:
    """What an `app.yaml` sends and receives, with headers and maximum bit stuffing."""
    rows = [
        (
            each.message.topic,
            "received" if each.message.is_incoming else "sent",
            time_text(each.message.interval),
            f"{each.length} B",
            f"{each.frames}",
            "common" if each.identifier is None else f"0x{each.identifier:X}",
            time_text(each.transmission_time),
            load_text(each.bus_load, Rounding.UP),
        )
        for each in assembly.messages
    ]
    titles = ("topic", "direction", ">interval", ">with headers", ">frames", ">identifier", ">transmission time", ">bus load")
    return table(f"Messages of the application{of}", titles, rows)


def _bus_load(assembly: Assembly) -> str:
    return load_text(sum((each.bus_load for each in assembly.messages), Fraction(0)), Rounding.UP)


def _start_texts(start: Initialisation) -> Iterator[str]:
    """The initialisation of the middleware: its time, and its messages."""
    count = f"{counted(len(start.entities), 'entity')}, created one after the other"
    least = _start_time(start.min_cycles, start.min_time, Rounding.DOWN)
    most = "" if start.max_time is None else f", at most {_start_time(start.max_cycles, start.max_time, Rounding.UP)}"
    yield f"{count}: at least {least}{most}"
    if start.reason:
        limit = "" if start.limit is None else f"; what is not created after {time_text(start.limit)} has failed"
        yield f"{start.reason}{limit}"
    if start.traffic is not None:
        yield from _traffic_texts(start.traffic, start.most_load)


def _start_time(cycles: int | None, time: Time, rounding: Rounding) -> str:
    return rounded_time_text(time, rounding) if cycles is None else f"{counted(cycles, 'cycle')} ({time_text(time)})"


def _traffic_texts(traffic: CreationTraffic, load: Fraction | None) -> Iterator[str]:
    """The messages of the creation, their time on the wire, and why it is unknown."""
    there, back, most = traffic.to_agent, traffic.to_controller, traffic.most_wire_time
    size = f"at least {there.least_bytes} B" if there.most_bytes is None else f"{there.least_bytes} to {there.most_bytes} B"
    answers = there.acknowledgements + back.acknowledgements
    acknowledged = f", at most {counted(answers, 'acknowledgement')}" if answers else ""
    yield f"{counted(there.messages, 'message')} to the agent ({size}) and {back.messages} back ({back.most_bytes} B){acknowledged}"
    if traffic.least_wire_time is not None:
        text = f"on the wire: at least {rounded_time_text(traffic.least_wire_time, Rounding.DOWN)}"
        text += "" if most is None else f", at most {rounded_time_text(most, Rounding.UP)}"
        yield text + ("" if load is None else f", a load of at most {load_text(load, Rounding.UP)}")
    if traffic.reason:
        yield traffic.reason


def _pools(assembly: Assembly, of: str = "") -> Table:
    """How many objects of the middleware are needed; how many messages wait depends on response times, which no model has."""
    from amalthea_uros.uros.middleware.options import OptionRole

    def row(pool: Option) -> tuple[Cell, ...]:
        verdict = Badge("too small", Tone.BAD) if pool.is_exceeded else Badge("sufficient", Tone.GOOD)
        needed = f"at least {pool.needed}" if pool.role is OptionRole.QUEUE else f"{pool.needed}"
        return pool.name, needed, f"{pool.available}", "app.yaml" if pool.is_stated else "default", verdict

    titles = ("option", ">needed", ">available", "set by", "verdict")
    return table(f"Pools of the middleware{of}", titles, (row(pool) for pool in assembly.pools if pool.needed))


def _memory(memory: MemoryDemand, of: str = "") -> Table:
    """The parts with sizes and remarks, then total, budget and memory of the board; empty without micro-ROS and stated stacks."""
    stacks = memory.stacks
    rows = [(use.name, f"{use.size} B" if use.is_bounded else "?", use.formula) for use in memory.uses]
    if stacks.users:
        parts = " + ".join(f"{user.size} B ({user.name})" for user in stacks.users if user.size)
        how = f"longest chain of preemption: {parts}" if stacks.shared else parts
        rows.append(("stack, shared" if stacks.shared else "stacks", f"{stacks.size} B", how))
    if rows:
        missing = f"without the stacks of {', '.join(stacks.unknown)}, which are not stated" if stacks.unknown else ""
        rows.append(("total" if memory.is_complete else "total, at least", f"{memory.total} B", missing))
        limits = {"budget": memory.budget, "memory of the board": memory.ram}
        rows += [(name, f"{size} B", "") for name, size in limits.items() if size is not None]
    return table(f"Memory{of}", ("part", ">size", "how it is computed"), rows)


def bus_section(content: ReportContent) -> Section | None:
    """What an `app.yaml` sends and receives."""
    buses = [] if content.assembly is None else [each for each in _controllers(content.assembly) if each[0].messages]
    if not buses:
        return None
    need = ", ".join(f"{_bus_load(each)} of the bus{of}" for each, of in buses)
    lead = f"Each message with its headers and maximum bit stuffing; together they need at most {need}."
    return Section("messages", "Messages on the CAN bus", lead, [_messages(each, of) for each, of in buses])


def pools_section(content: ReportContent) -> Section | None:
    """The pools that the application needs, the files for a build with the right sizes, and the memory."""
    from amalthea_uros.uros.generated_files import texts_of

    controllers = [] if content.assembly is None else _controllers(content.assembly)
    blocks: list[Block] = []
    for assembly, of in ((each, of) for each, of in controllers if each.description.application.nodes):
        files = ((f"{name}{of}", text) for name, text in texts_of(assembly).items() if not name.endswith(".h"))
        blocks += [
            _pools(assembly, of),
            _memory(assembly.memory, of),
            *(Listing(name, text.splitlines()) for name, text in files),
        ]
    if not blocks:
        return None
    lead = "The middleware takes its objects from pools of fixed size; these files set those that the application needs in the build."
    return Section("pools", "Static pools", lead, blocks)


def generate_document(result: GenerateResult) -> ResultDocument:
    """The names of the files, the options in them, the memory of the description, and what to do next."""
    from amalthea_uros.uros.generated_options import values_of

    paths = (name if result.folder is None else str(result.folder / name) for name in result.texts)
    written = lines(*(Lead(path, f": generated from {result.description}") for path in paths))
    rows = [
        (option.name, option.text(value), option.unit, option.text(option.available), option.counts)
        for option, value in values_of(result.assembly.options)
    ]
    options = table("", ("option", ">generated", "", ">described", "what it counts"), rows)
    saved = result.assembly.memory.total - result.memory.total
    compared = f" ({saved} B less than described)" if saved > 0 else ""
    rebuild = "The values are compiled into the library of the middleware: rebuild it from clean, or nothing changes."
    sections = (
        section("", written),
        section("Build options", options or Sentences(["The defaults of the middleware hold."])),
        section(f"Memory with these options{compared}", _memory(result.memory)),
        section("", lines("" if result.folder is None else rebuild)),
    )
    return document(sections, kept=[written])


#: Commands for a new description, with what they are good for.
_NEXT = (
    ("amuros check {}", "find mistakes"),
    ("amuros analyze {}", "compute response times, latencies and verdicts"),
    ("amuros report {} -o report.html", "show it to others"),
    ("amuros build {}", "make the AMALTHEA model"),
)
#: With a measurement, a log and its markers.
_NEXT_MEASURED = (
    ("amuros measure {1} --markers {2}", "show what was measured"),
    ("amuros calibrate {0} {1} --markers {2}", "put measured times into the description"),
)


def init_document(result: InitResult) -> ResultDocument:
    """The names of the written files, and the next commands."""
    written = lines(*_written(result))
    files = [shlex.quote(str(path)) for path in (result.path, *result.measurement)]
    following = (*_NEXT, *_NEXT_MEASURED) if result.measurement else _NEXT
    commands = [(command.format(*files), f"# {purpose}") for command, purpose in following]
    return document((section("", written), section("Next:", _in_columns(commands))), kept=[written])


def _written(result: InitResult) -> Iterator[Lead]:
    yield Lead(str(result.path), f": written from {result.origin}")
    if result.database is not None:
        yield Lead(str(result.database), ": foreign frames on its bus")
    if result.measurement:
        yield Lead(", ".join(map(str, result.measurement)), ": its measurement")


def catalogue_document(catalogue: Catalogue) -> ResultDocument:
    """A line for each board and each example that a description can begin with."""
    offers = {"Boards (--board NAME)": catalogue.boards, "Examples (--example NAME)": catalogue.examples}
    return document(section(title, _offers(offered)) for title, offered in offers.items())


def _offers(offers: Sequence[Offered]) -> Sentences:
    return _in_columns([(offer.name, offer.summary) for offer in offers])


def _in_columns(pairs: Sequence[tuple[str, str]]) -> Sentences:
    """Lines with what the first parts mean at the same distance from the margin."""
    width = max(len(name) for name, _ in pairs)
    return Sentences([f"{name:<{width}}  {meaning}" for name, meaning in pairs])


def import_document(result: ImportResult) -> ResultDocument:
    """The name of the description, and how many gaps are to be filled."""
    written = "a description: made" if result.path is None else f"{result.path}: written"
    return document([section("", lines(f"{written}, with {counted(result.gaps, 'gap')} to fill (TODO)"))])
