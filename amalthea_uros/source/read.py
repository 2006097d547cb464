"""Sources -> facts."""

from __future__ import annotations

import re
from collections.abc import Iterable

from amalthea_uros._internal.ports import parameter_services
from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.source.boards import platform_of_board, pools_of_board
from amalthea_uros.source.build_files import BuildFacts, build_facts
from amalthea_uros.source.entities import CREATIONS, entity_of
from amalthea_uros.source.executors import ACTIONS, SPINS, executor_of
from amalthea_uros.source.facts import CodeCallback, CodeEntity, CodeFacts, CodeOption, Thread
from amalthea_uros.source.files import SourceFile, Sources
from amalthea_uros.source.flaws import WITH_HANDLES, flaws, not_understood
from amalthea_uros.source.locks import LOCKS
from amalthea_uros.source.loops import SENDS, add_lock, add_senders, add_spins
from amalthea_uros.source.message_flaws import message_flaws
from amalthea_uros.source.messages import defined_types
from amalthea_uros.source.platform import OF_ARDUINO, platform_of
from amalthea_uros.source.ports import FORMS, SETTERS, WORD, thread_of, transport_of
from amalthea_uros.source.program import CodeProgram, read_program
from amalthea_uros.source.sleeps import SLEEPS
from amalthea_uros.source.walk import ENTRIES, CodeWalk, FunctionCall

_NAMES = frozenset({*SLEEPS, *FORMS, *SETTERS, *LOCKS, "Serial.begin"})
#: What FreeRTOS.h and task.h define alike for all controllers.
_CONSTANTS = {"tskIDLE_PRIORITY": "0"}
#: rclc_parameter/include/rclc_parameter/rclc_parameter.h of ros2/rclc; by the distribution.
_SERVER_HANDLES = ("RCLC_EXECUTOR_PARAMETER_SERVER_HANDLES", "RCLC_PARAMETER_EXECUTOR_HANDLES_NUMBER")
#: A place in an array that is not constant.
_OPEN = re.compile(r"\[(?!\d+\])[^\]]*\]")
_DEFINED = re.compile(r"-D\s*(\w+)")
_OPTION = re.compile(r'"\s*-D\s*(\w+)(?::\w+)?=([^"]*)"')
#: Texts, which stay, and comments; those without an end are taken up to that of the line or the file.
_COMMENT = re.compile(r'("(?:[^"\\\n]|\\.)*+"?)|//[^\n]*|/\*.*?(?:\*/|\Z)', re.DOTALL)


def read_facts(sources: Sources, board: str | None = None) -> CodeFacts:
    """What sources say about their application.

    Parameters
    ----------
    board : the name of a platform, if it is known

    Raises
    ------
    ReadError : the parsers are not installed.
    """
    program = read_program(sources.code)
    facts, build = CodeFacts(types=defined_types(sources.interfaces)), build_facts(sources.build)
    for name in _SERVER_HANDLES:
        program.macros[name] = program.macros[name] or {
            str(parameter_services(build.ros.value if build.ros is not None else None))
        }
    for name, stated in (_CONSTANTS | build.macros).items():
        program.macros[name].add(stated)
    walk = CodeWalk(program, _NAMES, {name: (form.entry, form.argument) for name, form in FORMS.items()})
    walk.all()
    facts.findings += [*sources.findings, *program.findings, *walk.findings, *_several_programs(program), *build.findings]
    facts.ros, facts.board, facts.clock = build.ros, build.board, build.clock
    facts.findings += _other_board(board, build)
    name = board or (build.board.value if build.board is not None else "")
    facts.port, facts.rtos, facts.tick_rate, facts.ticks_are_stated = platform_of(program, walk.calls, build, name)
    _note_objects(facts, walk)
    add_spins(facts, walk.calls)
    _note_threads(facts, walk)
    _note_main_thread(facts, walk, build)
    _note_publications(facts, walk)
    add_senders(facts, walk.calls)
    add_lock(facts, walk)
    facts.transport = transport_of(walk.calls, program, build.transport, facts.port, name)
    _note_options(facts, sources, build, name)
    facts.findings += [*not_understood(walk, facts), *flaws(facts, walk), *message_flaws(facts, program)]
    return facts


def _note_options(facts: CodeFacts, sources: Sources, build: BuildFacts, board: str) -> None:
    """Build options: of the board, then of files for colcon, then of the configuration of the port, which replaces them."""
    place = build.board.place if build.board is not None else None
    pools = pools_of_board(facts.port, board)
    facts.options |= {name: CodeOption(name=name, value=str(size), place=place) for name, size in pools.items()}
    for file in sources.meta:
        facts.options |= _options(file)
    facts.options |= build.options


def _note_objects(facts: CodeFacts, walk: CodeWalk) -> None:
    for call in walk.calls:
        if call.name in CREATIONS:
            entity = entity_of(call, walk)
            if entity is not None:
                facts.findings += _of_each_object(call, entity, walk.program)
            if entity is not None and entity.key not in facts.entities:
                facts.entities[entity.key] = entity
            elif entity is not None and _differs(entity, facts.entities[entity.key]):
                message = f"'{entity.variable}' is created again as something else; the description has the first one"
                advice = "Add the other ones to the description by hand."
                facts.findings.append(Finding("IMP003", Severity.WARNING, message, call.place, advice))
    # All executors first: functions that are called later can come earlier in the files.
    _act(facts, walk, {"rclc_executor_init"})
    _act(facts, walk, ACTIONS.keys() - {"rclc_executor_init"})
    for executor in facts.executors.values():
        for handle in executor.handles:
            if handle.kind in WITH_HANDLES and handle.entity not in facts.entities:
                variable = re.sub(r"\W+", "_", handle.entity.rpartition(":")[2]).strip("_")
                facts.entities[handle.entity] = CodeEntity(
                    kind=handle.kind, key=handle.entity, variable=variable, place=handle.place, is_created=False
                )


def _differs(entity: CodeEntity, other: CodeEntity) -> bool:
    """Whether two entities of one variable have another name, type, period or callback, so that they are not one created twice."""
    pairs = ((entity.name, other.name), (entity.type, other.type), (entity.period, other.period))
    callbacks = [each.callback.name if each.callback is not None else "" for each in (entity, other)]
    return any(None not in pair and pair[0] != pair[1] for pair in pairs) or callbacks[0] != callbacks[1]


def _of_each_object(call: FunctionCall, entity: CodeEntity, program: CodeProgram) -> list[Finding]:
    """An entity of each object of a class, where the code does not show which object it is."""
    if call.loops and _OPEN.search(entity.key) is not None:
        message = f"'{entity.variable}' is created in a loop of unknown length; the description has it once"
        return [Finding("IMP003", Severity.WARNING, message, call.place, "Add the other ones to the description by hand.")]
    owner = call.function.owner if call.function is not None else ""
    number = program.number_of_objects(owner)
    if not owner or number < 2 or not entity.key.startswith(f"{owner}::"):
        return []
    message = f"'{entity.variable}' is created for each of {number} objects of '{owner}', which the description has once"
    return [
        Finding("IMP003", Severity.WARNING, message, call.place, "Add those of the other objects to the description by hand.")
    ]


def _act(facts: CodeFacts, walk: CodeWalk, names: Iterable[str]) -> None:
    wanted = frozenset(names)
    for call in walk.calls:
        if call.name in wanted:
            ACTIONS[call.name](facts, call, walk)


def _note_threads(facts: CodeFacts, walk: CodeWalk) -> None:
    """The threads, and for each executor the one whose entry leads to its spin."""
    is_idf = any(b'"freertos/' in file.text or b"<freertos/" in file.text for file, _ in walk.program.files)
    # Arduino has FreeRTOS of ESP-IDF on some boards, and a library for it on others.
    unit = 1 if is_idf or (facts.port in OF_ARDUINO and facts.ticks_are_stated) else None if facts.port in OF_ARDUINO else WORD
    threads = [thread_of(call, walk, unit) for call in walk.calls if call.name in FORMS]
    facts.threads = {each.entry.scope: each for each in threads if each is not None and each.entry is not None}
    for call in walk.calls:
        given = call.argument(0)
        executor = facts.executors.get(given.key) if call.name in SPINS and given is not None else None
        if executor is not None and call.root is not None:
            executor.thread = executor.thread or facts.threads.get(call.root.scope)


def _note_main_thread(facts: CodeFacts, walk: CodeWalk, build: BuildFacts) -> None:
    """Give executors that spin in main() what the configuration says of its thread."""
    stated = build.main_stack or build.main_priority
    for call in walk.calls:
        executor = executor_of(facts, call) if call.name in SPINS else None
        if executor is None or executor.thread is not None or call.root is None or call.root.name != "main" or stated is None:
            continue
        executor.thread = Thread(
            name=executor.variable,
            entry=None,
            place=stated.place,
            stack=int(build.main_stack.value) if build.main_stack is not None else None,
            priority=int(build.main_priority.value) if build.main_priority is not None else None,
        )


def _other_board(board: str | None, build: BuildFacts) -> list[Finding]:
    """A board that was named, and is not that of the build."""
    stated = platform_of_board(build.board.value) if build.board is not None else None
    if board is None or build.board is None or stated in (None, board):
        return []
    message = f"the build is for the board '{build.board.value}', which is '{stated}', not '{board}'"
    return [
        Finding("IMP025", Severity.WARNING, message, build.board.place, "Leave out --board, or give the files of that board.")
    ]


def _note_publications(facts: CodeFacts, walk: CodeWalk) -> None:
    """What callbacks publish, also by functions that they call."""
    callbacks: list[CodeCallback] = [entity.callback for entity in facts.entities.values() if entity.callback is not None]
    for executor in facts.executors.values():
        for handle in executor.handles:
            callbacks += handle.callbacks
    for callback in callbacks:
        if callback.function is not None and callback.function.scope not in facts.publishes:
            facts.publishes[callback.function.scope] = {
                given.key: call.place
                for call in walk.calls_from(callback.function)
                if call.name in SENDS and (given := call.argument(0)) is not None
            }


def _several_programs(program: CodeProgram) -> list[Finding]:
    found = []
    for name in set(ENTRIES) - {"loop"}:
        entries = [each for each in program.functions.get(name, ()) if not each.owner]
        if len({each.file.path for each in entries}) > 1:
            place = entries[1].file.location(entries[1].body.start_point.row, 0)
            message = f"several programs: {name}() is defined in {entries[0].file.path} and {entries[1].file.path}"
            found.append(Finding("IMP016", Severity.ERROR, message, place, "Give the files of one program."))
    return found


def _options(file: SourceFile) -> dict[str, CodeOption]:
    """The options in a file for colcon, which may have comments; anything else in it is ignored."""
    text = _COMMENT.sub(lambda match: match[1] or "", file.text.decode("utf-8", "replace"))
    rows: dict[str, int] = {}
    for row, line in enumerate(file.text.decode("utf-8", "replace").split("\n")):
        for name in _DEFINED.findall(line):
            rows.setdefault(name, row)
    return {
        name: CodeOption(name=name, value=value, place=file.location(rows.get(name, 0), 0))
        for name, value in _OPTION.findall(text)
    }
