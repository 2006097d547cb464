"""Facts -> the text of an app.yaml, with a comment about the source of each value; what the code cannot tell is `TODO`."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from pathlib import Path

from amalthea_uros._internal.message_types import Length, LengthBounds, MessageType, length_of, unbounded_parts
from amalthea_uros.diagnostics import Location
from amalthea_uros.source.boards import platform_of_board
from amalthea_uros.source.facts import (
    CodeEntity,
    CodeEntityKind,
    CodeExecutor,
    CodeFacts,
    CodeHandle,
    CodeLoopItem,
    CodeLoopKind,
    CodeSender,
    SpinKind,
    Thread,
)
from amalthea_uros.source.names import CodeNames
from amalthea_uros.units import SECOND, Time, time_text

GAP = "TODO"
_PLAIN = re.compile(r"[A-Za-z/][\w/.-]*", re.ASCII)
_WORDS = ("true", "false", "null", "yes", "no", "on", "off", "y", "n", "todo")
_LISTS = {
    CodeEntityKind.SUBSCRIPTION: "subscriptions",
    CodeEntityKind.TIMER: "timers",
    CodeEntityKind.SERVICE: "services",
    CodeEntityKind.CLIENT: "clients",
    CodeEntityKind.GUARD_CONDITION: "guard_conditions",
    CodeEntityKind.ACTION_SERVER: "action_servers",
    CodeEntityKind.ACTION_CLIENT: "action_clients",
}
#: What a description takes for a type; others are comments.
_TYPE = re.compile(r"[a-z]\w*/(msg|srv|action)/[A-Z]\w*", re.ASCII)
#: Keys of sizes -> the parts of the type.
_MESSAGE: Mapping[str, str] = {"message_size": ""}
_SERVICE: Mapping[str, str] = {"request_size": "Request", "response_size": "Response"}
_ACTION: Mapping[str, str] = {"goal_size": "Goal", "result_size": "Result", "feedback_size": "Feedback"}
_ON, _OFF = ("on", "1", "true"), ("off", "0", "false")


def description_text(facts: CodeFacts, name: str, board: str | None, options: Mapping[str, str]) -> str:
    """The description.

    Parameters
    ----------
    board : the name of a platform, if it is known
    options : build options of the middleware that a description can have, each with its unit: "B", "ms", "number", "switch", "word"
    """
    names = CodeNames(facts)
    lines = [
        "# Imported from source code. Each TODO is a value that the code cannot tell: replace all of them, then run amuros check.",
        "amuros: 1",
        f"name: {quoted(name)}",
        *_hardware(facts, board),
        *_os(facts),
        "middleware:",
        *(f"  {line}" for line in _middleware(facts, names, options)),
        "application:",
        *(f"  {line}" for line in _application(facts, names)),
    ]
    return "\n".join(lines) + "\n"


def quoted(text: str) -> str:
    """A text as YAML."""
    is_plain = _PLAIN.fullmatch(text) is not None and text.lower() not in _WORDS
    return text if is_plain else json.dumps(text)


def _at(place: Location | None, note: str = "") -> str:
    """A comment with the place of a value."""
    where = f"{Path(place.path).name}:{place.line}" if place is not None else ""
    return remark("; ".join(filter(None, (where, note))))


def remark(text: str) -> str:
    """A comment at the end of a line, "" if there is nothing to say."""
    return f" # {''.join(each if each.isprintable() else '?' for each in text)}" if text else ""


def _time(time: Time | None) -> str:
    return time_text(time) if time is not None else GAP


def _hardware(facts: CodeFacts, board: str | None) -> Iterator[str]:
    """The platform, and the clock that the build states, which replaces that of the platform."""
    stated = platform_of_board(facts.board.value) if facts.board is not None else None
    platform, place = (board, None) if board is not None or facts.board is None else (stated, facts.board.place)
    note = "" if platform or place is None else "no platform of this board is known"
    yield "hardware:"
    yield f"  platform: {quoted(platform or 'generic')}{_at(place, note)}"
    if facts.clock is not None:
        yield f"  frequency: {facts.clock.value} Hz{_at(facts.clock.place)}"
    elif platform is None:
        yield f"  frequency: {GAP} # clock of the cores"


def _os(facts: CodeFacts) -> Iterator[str]:
    if facts.rtos and facts.tick_rate is not None:
        tick = Time(int(SECOND / facts.tick_rate))
        default = "" if facts.ticks_are_stated else " # the default of the port, if its configuration says nothing else"
        yield f"os: {{rtos: {facts.rtos}, tick: {time_text(tick)}}}{default}"
    elif facts.rtos:
        yield f"os: {{rtos: {facts.rtos}}}"


def _middleware(facts: CodeFacts, names: CodeNames, options: Mapping[str, str]) -> Iterator[str]:
    if facts.ros is not None:
        yield f"ros: {facts.ros.value}{_at(facts.ros.place)}"
    if facts.port:
        yield f"port: {facts.port}"
    executors = list(facts.executors.values())
    if len(executors) == 1 and not facts.senders:
        yield "executor:"
        yield from (f"  {line}" for line in _executor(executors[0], facts, names))
    elif executors or facts.senders:
        yield "executors:"
        for executor in executors:
            yield from item_lines(_executor(executor, facts, names), "  ")
        for sender, name in zip(facts.senders, names.senders, strict=True):
            yield from item_lines(_sender(sender, name, names), "  ")
    else:
        yield f"executor: {GAP} # none is initialised in these files"
    option = facts.options.get("UCLIENT_PROFILE_MULTITHREAD")
    if option is not None and option.value.upper() in ("ON", "1", "TRUE"):
        yield f"multithread: true{_at(option.place)}"
    elif facts.lock is not None:
        yield f"multithread: true{_at(facts.lock, 'the application locks the session')}"
    yield from _transport(facts)
    limits = list(_limits(facts, options))
    if limits:
        yield "limits:"
        yield from (f"  {line}" for line in limits)


def _limits(facts: CodeFacts, options: Mapping[str, str]) -> Iterator[str]:
    """Build options as they are stated, as far as a description can have them."""
    for name, option in facts.options.items():
        value = option.value.lower()
        match options.get(name):
            case "switch" if value in (*_ON, *_OFF):
                yield f"{name}: {str(value in _ON).lower()}{_at(option.place)}"
            case "word" if value.isalpha():
                yield f"{name}: {value}{_at(option.place)}"
            case "number" | "B" | "ms" as unit if value.removeprefix("-").isdecimal():
                text = value if unit == "number" or (unit == "ms" and value == "0") else f"{value} {unit}"
                yield f"{name}: {text}{_at(option.place)}"


def _transport(facts: CodeFacts) -> Iterator[str]:
    transport = facts.transport
    if transport is None or transport.key is None:
        note = transport.note if transport is not None else "not set in these files"
        yield f"transport: {GAP}{_at(transport.place if transport is not None else None, note)}"
        return
    values = ", ".join(f"{key}: {value or GAP}" for key, value in transport.values)
    yield "transport:"
    yield f"  {transport.key}: {{{values}}}{_at(transport.place, transport.note)}"


def _executor(executor: CodeExecutor, facts: CodeFacts, names: CodeNames) -> Iterator[str]:
    yield f"name: {quoted(names.executors[executor.key])}{_at(executor.place)}"
    if executor.max_handles:
        yield f"max_handles: {executor.max_handles}{_at(executor.place)}"
    if executor.thread is not None and not _is_of_other_loop(executor):
        yield from _thread(executor.thread)
    if not _is_of_other_loop(executor):
        yield from _loop(executor, names)
    yield "callbacks: in-executor"
    if not any(handle.entity in facts.entities or handle.kind is CodeEntityKind.LIFECYCLE for handle in executor.handles):
        yield f"order: {GAP} # nothing that is added to it is understood: describe its callbacks under the nodes"
    order = [names.handles[handle.entity] for handle in executor.handles if handle.entity in names.handles]
    if len(order) > 1:
        yield f"order: [{', '.join(map(quoted, order))}]"
    if executor.semantics != "ROS":
        yield f"semantics: {executor.semantics}"
    yield from _trigger(executor, names)
    yield f"execution_time: {{base: {GAP}, per_message: {GAP}}} # of a round, and of taking a message"


def _sender(sender: CodeSender, name: str, names: CodeNames) -> Iterator[str]:
    yield f"name: {quoted(name)}{_at(sender.place, 'publishes outside of callbacks')}"
    if sender.thread is not None:
        yield from _thread(sender.thread)
    yield "loop:"
    yield from (f"  - {_loop_item(item, None, names)}" for item in sender.items)


def _thread(thread: Thread) -> Iterator[str]:
    if thread.stack is not None:
        yield f"stack: {thread.stack} B{_at(thread.place)}"
    elif thread.entry is not None:
        yield f"stack: {GAP}{_at(thread.place)}"
    yield f"priority: {GAP if thread.priority is None else thread.priority}{_at(thread.place)}"
    if thread.core is not None:
        yield f"core: {GAP}{_at(thread.place, f'pinned to core {thread.core}')}"


def _is_of_other_loop(executor: CodeExecutor) -> bool:
    """Whether the description has its loop at another executor, the first one that spins in it."""
    if not executor.spins or executor.spins[0].items.again is not None:
        return False
    return executor.spins[0].items.executors[:1] not in ((), (executor.key,))


def _loop(executor: CodeExecutor, names: CodeNames) -> Iterator[str]:
    if not executor.spins:
        yield f"loop: {GAP} # no call lets it spin"
        return
    spin = executor.spins[0]
    if spin.items.again is not None:
        yield f"loop: {GAP}{_at(spin.items.again.place, 'an executor spins more than once in an iteration, which a loop cannot have')}"
        return
    if spin.kind is SpinKind.ENDLESS:
        is_default = executor.timeout_place is None
        time = Time(10**12) if is_default else executor.timeout
        yield f"loop: {{spin: {_time(time)}}}{_at(spin.place, 'the default timeout' if is_default else '')}"
        return
    if {item.kind for item in spin.items} - {CodeLoopKind.SPIN, CodeLoopKind.SLEEP} or len(spin.items.executors) > 1:
        yield "loop:"
        yield from (f"  - {_loop_item(item, executor, names)}" for item in spin.items)
        return
    parts = [f"{spin.kind}: {_time(spin.time)}"]
    if spin.kind is SpinKind.SOME:
        sleep = spin.items.sleep if spin.is_in_loop else None
        parts += [f"sleep: {_time(sleep)}"] if sleep != 0 else []
    elif executor.timeout_place is not None:
        parts.append(f"timeout: {_time(executor.timeout)}")
    others = ", ".join(f"sleep in line {item.place.line}" for item in spin.items if item.kind is CodeLoopKind.SLEEP)
    yield f"loop: {{{', '.join(parts)}}}{_at(spin.place, others)}"


def _loop_item(item: CodeLoopItem, owner: CodeExecutor | None, names: CodeNames) -> str:
    comment = _at(item.place, item.note)
    if item.kind is CodeLoopKind.PUBLISH:
        topic = names.topics.get(item.of)
        sent = f"{item.kind}: {GAP if topic is None else f'[{quoted(topic)}]'}"
        return f"{{{sent}, every: {_time(item.every)}}}{comment}" if item.every else f"{sent}{comment}"
    if item.kind is CodeLoopKind.SPIN and (owner is None or item.of != owner.key):
        return f"{{{item.kind}: {_time(item.time)}, executor: {quoted(names.executors[item.of])}}}{comment}"
    more = f", attempts: {item.attempts}" if item.attempts > 1 else ""
    more += f", every: {_time(item.every)}" if item.every else ""
    return f"{{{item.kind}: {_time(item.time)}{more}}}{comment}" if more else f"{item.kind}: {_time(item.time)}{comment}"


def _trigger(executor: CodeExecutor, names: CodeNames) -> Iterator[str]:
    trigger = executor.trigger
    if trigger is None or trigger.function == "any":
        return
    if trigger.is_custom:
        yield f"trigger: {GAP}{_at(trigger.place, f'function {trigger.function}')}"
    elif trigger.function == "one":
        target = names.handles.get(trigger.object)
        yield f"trigger: {{one: {quoted(target) if target is not None else GAP}}}{_at(trigger.place)}"
    else:
        yield f"trigger: {trigger.function}{_at(trigger.place)}"


def _application(facts: CodeFacts, names: CodeNames) -> Iterator[str]:
    nodes = facts.of_kind(CodeEntityKind.NODE)
    if not nodes:
        yield f"nodes: {GAP} # no node is created in these files"
        return
    yield "nodes:"
    for node in nodes:
        yield from item_lines(_node(node, node is nodes[0], facts, names), "  ")


def item_lines(lines: Iterator[str], indent: str) -> Iterator[str]:
    """An item of a list in YAML, of the lines of its content."""
    for index, line in enumerate(lines):
        yield f"{indent}{'  ' if index else '- '}{line}"


def _node(node: CodeEntity, is_first: bool, facts: CodeFacts, names: CodeNames) -> Iterator[str]:
    # The code of a timer or guard condition does not say which node it belongs to; nothing depends on it.
    own = [each for each in facts.entities.values() if each.node == node.key or (is_first and not each.node)]
    yield f"name: {quoted(node.name) if node.name else GAP}{_at(node.place)}"
    publishers = [each for each in own if each.kind is CodeEntityKind.PUBLISHER]
    if publishers:
        yield "publishers:"
        for publisher in publishers:
            yield from item_lines(_publisher(publisher, facts), "  ")
    handles = names.handle_by_entity
    for kind, key in _LISTS.items():
        entities = [each for each in own if each.kind is kind and each.key in handles]
        if entities:
            yield f"{key}:"
        for entity in entities:
            yield from item_lines(_callback(entity, *handles[entity.key], facts, names), "  ")
    yield from _servers(node, own, facts, names)


def _publisher(entity: CodeEntity, facts: CodeFacts) -> Iterator[str]:
    yield f"topic: {quoted(entity.name) if entity.name else GAP}{_at(entity.place)}"
    yield from _sizes(entity.type, _MESSAGE, facts)
    yield f"reliability: {entity.reliability or GAP}"


def _sizes(kind: MessageType | None, parts: Mapping[str, str], facts: CodeFacts) -> Iterator[str]:
    """The type of messages, and of their sizes what does not follow from it.

    Parameters
    ----------
    parts : keys of the sizes -> the parts of the type
    """
    if kind is None or _TYPE.fullmatch(str(kind)) is None:
        yield from (f"{key}: {GAP}{_at(None, str(kind or ''))}" for key in parts)
        return
    types = {key: kind.part(suffix) if suffix else kind for key, suffix in parts.items()}
    lengths = {key: length_of(each, facts.types) for key, each in types.items()}
    common = {key: length for key, length in lengths.items() if length is not None and length == length_of(types[key])}
    yield f"type: {kind}{remark(' and '.join(map(_length, lengths.values())) if None not in lengths.values() else '')}"
    for key, length in lengths.items():
        if key not in common:
            is_known = length is not None and length.most is not None
            yield f"{key}: {f'{length.most} B' if is_known and length is not None else GAP}"
    open_parts = {part for key in common for part in unbounded_parts(types[key])}
    if open_parts:
        yield f"bounds: {{{', '.join(f'{part}: {GAP}' for part in LengthBounds._fields if part in open_parts)}}}"


def _length(length: Length | None) -> str:
    if length is None or length.is_fixed:
        return "" if length is None else f"{length.bytes} B"
    if length.most is None:
        return f"{length.bytes} B with empty strings and sequences"
    return f"{length.most} B with the longest strings and sequences"


def _callback(entity: CodeEntity, handle: CodeHandle, executor: str, facts: CodeFacts, names: CodeNames) -> Iterator[str]:
    yield f"name: {quoted(names.handles[entity.key])}{_at(handle.place)}"
    yield from _content(entity, facts)
    if entity.kind is CodeEntityKind.TIMER:
        yield f"period: {_time(entity.period)}{_at(entity.place)}"
    else:
        what = "it is triggered" if entity.kind is CodeEntityKind.GUARD_CONDITION else "messages arrive"
        yield f"rate: {GAP} # how often {what} at most"
    if handle.always:
        yield "invocation: always"
    if executor != next(iter(names.executors.values())):
        yield f"runs_in: {quoted(executor)}"
    yield f"execution_time: {GAP}"
    yield from _outputs(entity, handle, facts, names)


def _content(entity: CodeEntity, facts: CodeFacts) -> Iterator[str]:
    named = quoted(entity.name) if entity.name else GAP
    match entity.kind:
        case CodeEntityKind.SUBSCRIPTION:
            yield f"topic: {named}{_at(entity.place)}"
            yield from _sizes(entity.type, _MESSAGE, facts)
            yield f"reliability: {entity.reliability or GAP}"
        case CodeEntityKind.SERVICE | CodeEntityKind.CLIENT:
            if entity.kind is CodeEntityKind.CLIENT:
                yield f"service: {named}{_at(entity.place)}"
            yield from _sizes(entity.type, _SERVICE, facts)
        case CodeEntityKind.ACTION_SERVER | CodeEntityKind.ACTION_CLIENT:
            if entity.kind is CodeEntityKind.ACTION_CLIENT:
                yield f"action: {named}{_at(entity.place)}"
            yield from _sizes(entity.type, _ACTION, facts)


def _outputs(entity: CodeEntity, handle: CodeHandle, facts: CodeFacts, names: CodeNames) -> Iterator[str]:
    callbacks = [*handle.callbacks, *([entity.callback] if entity.callback is not None else [])]
    used: dict[str, Location] = {}
    for callback in callbacks:
        if callback.function is not None:
            used |= facts.publishes.get(callback.function.scope, {})
    unknown = [place for each, place in used.items() if each not in facts.entities]
    if unknown:
        yield f"publishes: {GAP}{_at(unknown[0], 'with an object that is not understood')}"
    for key, kind in (("publishes", CodeEntityKind.PUBLISHER), ("requests", CodeEntityKind.CLIENT)):
        if unknown and kind is CodeEntityKind.PUBLISHER:
            continue
        found = [(facts.entities[each], place) for each, place in used.items() if each in facts.entities]
        values = [(_target(each, names), place) for each, place in found if each.kind is kind]
        if values:
            yield f"{key}: [{', '.join(value for value, _ in values)}]{_at(values[0][1])}"


def _target(entity: CodeEntity, names: CodeNames) -> str:
    name = entity.name if entity.kind is CodeEntityKind.PUBLISHER else names.handles.get(entity.key)
    return quoted(name) if name else GAP


def _servers(node: CodeEntity, own: list[CodeEntity], facts: CodeFacts, names: CodeNames) -> Iterator[str]:
    for entity in own:
        if entity.kind is CodeEntityKind.PARAMETER_SERVER and entity.key in names.handle_by_entity:
            stated = dict(entity.options)
            yield f"parameter_server:{_at(entity.place)}"
            yield f"  rate: {GAP} # of requests"
            yield f"  execution_time: {GAP}"
            executor = names.handle_by_entity[entity.key][1]
            if executor != next(iter(names.executors.values())):
                yield f"  runs_in: {quoted(executor)}"
            for key, option in (("events", "notify_changed_over_dds"), ("low_memory", "low_mem_mode")):
                if option in stated:
                    yield f"  {key}: {str(stated[option]).lower()}"
        elif entity.kind is CodeEntityKind.LIFECYCLE:
            services = [
                handle
                for executor in facts.executors.values()
                for handle in executor.handles
                if handle.kind is CodeEntityKind.LIFECYCLE
            ]
            if services:
                yield f"lifecycle:{_at(entity.place)}"
                yield f"  services: {len(services)}"
                yield f"  rate: {GAP} # of requests"
                yield f"  execution_time: {GAP}"
