"""Mistakes in the code that show before any analysis, and code that is not understood."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from amalthea_uros._internal.plural import counted
from amalthea_uros._internal.ports import ACTION_SERVICES, ACTION_TOPICS, LIFECYCLE_SERVICES, known_ports, parameter_services
from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.source.entities import CREATIONS, RELIABLE
from amalthea_uros.source.executors import ACTIONS, SPINS
from amalthea_uros.source.facts import CodeEntity, CodeEntityKind, CodeExecutor, CodeFacts, CodeHandle, SpinKind
from amalthea_uros.source.loops import ROUND_TRIPS, SENDS, Creations, is_only_at_creation, is_repeated, session_users
from amalthea_uros.source.scope import literal
from amalthea_uros.source.sleeps import SLEEPS, wait_of
from amalthea_uros.source.spans import TextSpans
from amalthea_uros.source.syntax import descendants, text_of
from amalthea_uros.source.walk import ENTRIES, CodeWalk, FunctionCall
from amalthea_uros.units import Time, time_text

if TYPE_CHECKING:
    from tree_sitter import Node

_MILLISECOND = 10**9
_VERBS = {"rcl_publish": "publishes", "rcl_send_request": "sends requests"}
_SECOND = 10**12
#: What an executor needs a handle for, besides servers of parameters and lifecycles.
WITH_HANDLES = (
    CodeEntityKind.SUBSCRIPTION,
    CodeEntityKind.TIMER,
    CodeEntityKind.SERVICE,
    CodeEntityKind.CLIENT,
    CodeEntityKind.GUARD_CONDITION,
    CodeEntityKind.ACTION_SERVER,
    CodeEntityKind.ACTION_CLIENT,
)
#: Functions of rcl that wait for something or read it, without an executor -> the position of that.
_TAKEN = {
    **dict.fromkeys(("rcl_take", "rcl_take_request", "rcl_take_response"), 0),
    **{f"rcl_wait_set_add_{kind}": 1 for kind in ("subscription", "timer", "service", "client", "guard_condition")},
}
#: Defaults of micro-ROS/rmw_microxrcedds rmw_microxrcedds_c/CMakeLists.txt; each timer needs a guard condition.
_POOLS = {
    "RMW_UXRCE_MAX_NODES": (4, (CodeEntityKind.NODE,)),
    "RMW_UXRCE_MAX_PUBLISHERS": (4, (CodeEntityKind.PUBLISHER,)),
    "RMW_UXRCE_MAX_SUBSCRIPTIONS": (4, (CodeEntityKind.SUBSCRIPTION,)),
    "RMW_UXRCE_MAX_SERVICES": (4, (CodeEntityKind.SERVICE,)),
    "RMW_UXRCE_MAX_CLIENTS": (4, (CodeEntityKind.CLIENT,)),
    "RMW_UXRCE_MAX_GUARD_CONDITION": (4, (CodeEntityKind.TIMER, CodeEntityKind.GUARD_CONDITION)),
}


def flaws(facts: CodeFacts, walk: CodeWalk) -> Iterator[Finding]:
    """The findings about the application itself."""
    yield from _unchecked(walk.calls)
    yield from _pools(facts)
    yield from _never_called(facts, walk.calls)
    yield from _never_reached(facts, walk)
    for executor in facts.executors.values():
        yield from _handles(executor, facts)
        yield from _waiting(executor)
        yield from _timers(executor, facts)
        yield from _triggers(executor)
    yield from _sessions(facts, walk)
    yield from _sleepless(facts, walk)
    yield from _blocking(facts, walk)
    yield from _pings(facts, walk)
    yield from _never_again(facts, walk)


def _unchecked(calls: list[FunctionCall]) -> Iterator[Finding]:
    names = {*CREATIONS, *(name for name in ACTIONS if "_add_" in name or name.endswith("_init"))}
    for call in calls:
        if call.unchecked and call.name in names:
            message = f"the return code of '{call.name}' is not checked, so nobody sees that a pool is exhausted"
            yield Finding("IMP008", Severity.WARNING, message, call.place, "Compare it with RCL_RET_OK.")


def _pools(facts: CodeFacts) -> Iterator[Finding]:
    added = {handle.entity for handle in _every_handle(facts)}
    for name, (default, kinds) in _POOLS.items():
        own = [entity for entity in facts.entities.values() if entity.kind in kinds]
        implied = [(each, _created_by(each, facts, added)) for each in facts.entities.values()]
        used = own + [each for each, created in implied for _ in range(sum(created.get(kind, 0) for kind in kinds))]
        option = facts.options.get(name)
        port = known_ports().get(facts.port)
        by_default, sizes = (port.pools_of or "by default", port.pools) if port is not None else ("by default", {})
        stated_size = literal(option.value) if option is not None else None
        size = stated_size if stated_size is not None and stated_size >= 0 else sizes.get(name, default)
        if len(used) > size:
            stated = by_default if name in sizes else "by default"
            if option is not None:
                stated = f"in {option.place.path}" if option.place is not None else "for this board"
            need = f"need {name}={len(used)}, which is {size} {stated}"
            included = ", those of actions and servers included," if len(used) > len(own) else ""
            message = f"{counted(len(used), kinds[0].value)}{included} {need}"
            if len(kinds) > 1:
                message = f"the timers and guard conditions {need}"
            advice = "Set it in colcon.meta and rebuild libmicroros from scratch."
            if facts.port == "arduino" and option is None:
                advice = "Take a board whose library has more, such as ESP32 or Teensy 4 with 10, or build the library anew."
            severity = Severity.ERROR if option is not None else Severity.WARNING
            yield Finding("IMP007", severity, message, used[size].place, advice)


def _created_by(entity: CodeEntity, facts: CodeFacts, added: set[str]) -> Mapping[CodeEntityKind, int]:
    """How many entities of each kind an action, or a server of parameters or of a lifecycle, creates in the middleware.

    Parameters
    ----------
    added : the keys of what is added to executors
    """
    match entity.kind:
        case CodeEntityKind.ACTION_SERVER:
            return {CodeEntityKind.SERVICE: ACTION_SERVICES, CodeEntityKind.PUBLISHER: ACTION_TOPICS, CodeEntityKind.TIMER: 1}
        case CodeEntityKind.ACTION_CLIENT:
            return {CodeEntityKind.CLIENT: ACTION_SERVICES, CodeEntityKind.SUBSCRIPTION: ACTION_TOPICS}
        case CodeEntityKind.LIFECYCLE:
            return {CodeEntityKind.SERVICE: LIFECYCLE_SERVICES, CodeEntityKind.PUBLISHER: 1}
        case CodeEntityKind.PARAMETER_SERVER if entity.key in added:
            services = parameter_services(facts.ros.value if facts.ros is not None else None)
            changes = dict(entity.options).get("notify_changed_over_dds", True)
            return {CodeEntityKind.SERVICE: services, CodeEntityKind.PUBLISHER: int(changes)}
    return {}


def _every_handle(facts: CodeFacts) -> list[CodeHandle]:
    return [handle for executor in facts.executors.values() for handle in executor.handles]


def _never_called(facts: CodeFacts, calls: list[FunctionCall]) -> Iterator[Finding]:
    handles = _every_handle(facts)
    added = {handle.entity for handle in handles}
    open_kinds = {each.kind for each in handles if each.kind in WITH_HANDLES and not facts.entities[each.entity].is_created}
    places = [(call.argument(_TAKEN[call.name]), call) for call in calls if call.name in _TAKEN]
    taken = {given.key for given, _ in places if given is not None}
    for entity in facts.entities.values():
        if entity.kind not in (*WITH_HANDLES, CodeEntityKind.PARAMETER_SERVER) or entity.key in added:
            continue
        message = f"the {entity.kind} '{entity.variable}' is never added to an executor, so its callback never runs"
        advice = "Add it to an executor, or remove it."
        if entity.key in taken:
            message = f"the {entity.kind} '{entity.variable}' is read without an executor, which the description does not have"
            advice = "Add it to an executor, or add what it does to the description by hand."
        elif entity.kind in open_kinds:
            message = f"it is not understood where the {entity.kind} '{entity.variable}' is added to an executor"
            advice = "Complete it in the description."
        yield Finding("IMP017", Severity.WARNING, message, entity.place, advice)
    for executor in facts.executors.values():
        if not executor.spins:
            message = f"the executor '{executor.variable}' never spins in these files"
            yield Finding(
                "IMP017",
                Severity.WARNING,
                message,
                executor.place,
                "Give the file that calls a function such as rclc_executor_spin_some.",
            )
        for handle in executor.handles:
            if handle.kind in WITH_HANDLES and not facts.entities[handle.entity].is_created:
                message = f"the {handle.kind} that is added here is not created by a function that is understood"
                advice = "Complete it in the description, and add the others that a loop adds here."
                yield Finding("IMP017", Severity.WARNING, message, handle.place, advice)


def _never_reached(facts: CodeFacts, walk: CodeWalk) -> Iterator[Finding]:
    """Functions that create something, and that no path from the beginning of the program calls, if that is known."""
    begins = [each for name in ENTRIES for each in walk.program.functions.get(name, ()) if not each.owner]
    known = {*facts.threads, *facts.publishes, *(each.scope for each in begins)}
    for call in walk.calls:
        if begins and call.name in CREATIONS and call.root is not None and call.root.scope not in known:
            known.add(call.root.scope)
            message = f"nothing in these files calls '{call.root.name}', which creates entities; it is taken as called"
            yield Finding("IMP015", Severity.INFO, message, call.place, "Remove them from the description if it is not called.")


def _handles(executor: CodeExecutor, facts: CodeFacts) -> Iterator[Finding]:
    if executor.max_handles is None:
        message = f"the number of handles of '{executor.variable}' is not constant"
        yield Finding("IMP004", Severity.WARNING, message, executor.place, "Add max_handles to the description.")
        return
    total, servers = 0, 0
    for handle in executor.handles:
        servers += facts.ros is None and handle.kind is CodeEntityKind.PARAMETER_SERVER
        total += handle.count
        if total > executor.max_handles:
            message = (
                f"'{executor.variable}' is initialised with {counted(executor.max_handles, 'handle')}; this one exceeds them"
            )
            advice = f"Give rclc_executor_init {sum(each.count for each in executor.handles)}; else the callback never runs."
            severity = Severity.ERROR
            if total - servers <= executor.max_handles:
                # A parameter server had one handle less before iron.
                message, severity = f"{message}, unless ROS 2 is humble or older", Severity.WARNING
            yield Finding("IMP006", severity, message, handle.place, advice)
            return


def _waiting(executor: CodeExecutor) -> Iterator[Finding]:
    for spin in executor.spins:
        if spin.kind is SpinKind.SOME and spin.time is not None and spin.time < _MILLISECOND:
            message = f"the timeout of {time_text(spin.time)} is below 1 ms, so the executor polls instead of waiting"
            yield Finding(
                "IMP009", Severity.WARNING, message, spin.place, "The timeout is in nanoseconds: write RCL_MS_TO_NS(10)."
            )
        if spin.kind is SpinKind.PERIOD and spin.time is not None and _timeout(executor) >= spin.time:
            stated = time_text(executor.timeout) if executor.timeout else "1 s by default"
            message = f"the executor waits up to {stated} per round, longer than its period of {time_text(spin.time)}"
            yield Finding(
                "IMP010", Severity.WARNING, message, spin.place, "Call rclc_executor_set_timeout with less than the period."
            )
        is_first = not spin.items or spin.items[0].place == spin.place
        if spin.kind is SpinKind.SOME and spin.is_in_loop and spin.items.sleep == 0 and is_first:
            message = "the loop does not sleep; with timers only, some versions of the middleware never wait either"
            yield Finding(
                "IMP018",
                Severity.INFO,
                message,
                spin.place,
                "Sleep in the loop if other tasks with lower priority have to run.",
            )
        if not spin.is_in_loop:
            message = "no loop is found around this call, so how often it is repeated is unknown"
            yield Finding("IMP004", Severity.WARNING, message, spin.place, "Complete 'loop' in the description.")
    for spin in executor.spins[1:]:
        message = f"'{executor.variable}' spins in several places; the description has the first one"
        yield Finding("IMP004", Severity.WARNING, message, spin.place, "Check 'loop' in the description.")


def _timeout(executor: CodeExecutor) -> Time:
    """What a round waits at most, 0 if the code sets something that cannot be read."""
    return Time(_SECOND) if executor.timeout_place is None else executor.timeout or Time(0)


def _timers(executor: CodeExecutor, facts: CodeFacts) -> Iterator[Finding]:
    spin = next(iter(executor.spins), None)
    least = None if spin is None else spin.time if spin.kind is SpinKind.PERIOD else spin.items.sleep
    for handle in executor.handles:
        entity = facts.entities.get(handle.entity)
        if entity is not None and entity.period is not None and least is not None and entity.period < least:
            message = f"the period {time_text(entity.period)} is shorter than a round of the loop, {time_text(least)}: periods are lost"
            yield Finding("IMP011", Severity.WARNING, message, entity.place, "Sleep less in the loop, or use a longer period.")


def _triggers(executor: CodeExecutor) -> Iterator[Finding]:
    if executor.trigger is not None and executor.trigger.is_custom:
        message = f"the condition of the trigger '{executor.trigger.function}' cannot be read from the code"
        advice = "Write the sets of callbacks that it waits for as trigger: {custom: [[A, B], [C]]}."
        yield Finding("IMP014", Severity.WARNING, message, executor.trigger.place, advice)


def _pings(facts: CodeFacts, walk: CodeWalk) -> Iterator[Finding]:
    described = facts.described_places()
    creations = Creations(walk.calls)
    users = [(call, creations.of(call)) for call in walk.calls if call.name in (*SPINS, *SENDS) and is_repeated(call)]
    for call in walk.calls:
        if call.name not in ROUND_TRIPS or not is_repeated(call) or call.place in described:
            continue
        # Of another state than the one that the description has, or from before its loop.
        own = [(each, created) for each, created in users if each.root is call.root]
        inside = [(each, created) for each, created in own if call.loops[: len(each.loops)] == each.loops]
        if not own or (
            inside and not any(call.excludes(each) or is_only_at_creation(call, each, created) for each, created in inside)
        ):
            message = f"'{call.name}' in a loop waits for the agent, which the description does not have"
            yield Finding(
                "IMP013", Severity.WARNING, message, call.place, "Allow for its timeout where the loop has to be quick."
            )


def _never_again(facts: CodeFacts, walk: CodeWalk) -> Iterator[Finding]:
    """Programs that do not notice a restart of the agent, after which the session and all entities are gone."""
    first = next(iter(facts.executors.values()), None)
    asks = any("ping_agent" in call.name for call in walk.calls)
    if first is not None and any(spin.is_in_loop for spin in first.spins) and not asks:
        message = "nothing asks whether the agent is still there: after its restart, nothing is sent or received any more"
        advice = "Call rmw_uros_ping_agent now and then; without an answer, destroy everything and create it anew."
        yield Finding("IMP026", Severity.INFO, message, first.spins[0].place, advice)


def _sessions(facts: CodeFacts, walk: CodeWalk) -> Iterator[Finding]:
    """Threads that use the session of the middleware without a lock: eProsima/Micro-XRCE-DDS-Client CMakeLists.txt."""
    option, users = facts.options.get("UCLIENT_PROFILE_MULTITHREAD"), session_users(facts, walk)
    if len(users) > 1 and facts.lock is None and (option is None or option.value.upper() not in ("ON", "1", "TRUE")):
        sending = (calls[0] for calls in users.values() if all(call.name not in SPINS for call in calls))
        place = next(sending, next(iter(users.values()))[0]).place
        names = sorted(users, key=lambda name: all(call.name not in SPINS for call in users[name]))
        message = f"{' and '.join(map(repr, names))} use one session of the middleware, which nothing locks in these files"
        advice = "Build with UCLIENT_PROFILE_MULTITHREAD=ON, or publish in callbacks of the executor."
        yield Finding("IMP023", Severity.WARNING, message, place, advice)


def _sleepless(facts: CodeFacts, walk: CodeWalk) -> Iterator[Finding]:
    """Calls that seem to sleep, and do not."""
    for call in walk.calls:
        if call.name in SLEEPS and (wait := wait_of(call, facts)).note:
            message = f"'{call.name}' does not sleep here: {wait.note}"
            yield Finding(
                "IMP020", Severity.WARNING, message, call.place, "Use a function and a time with which the thread sleeps."
            )


def _blocking(facts: CodeFacts, walk: CodeWalk) -> Iterator[Finding]:
    published = {place for places in facts.publishes.values() for place in places.values()}
    reported, described = set(), facts.described_places()
    for call in walk.calls:
        given = call.argument(0)
        entity = facts.entities.get(given.key) if call.name in SENDS and given is not None else None
        if entity is None or call.place in reported:
            continue
        reported.add(call.place)
        if call.place in described:
            message = f"'{entity.variable}' {_VERBS[call.name]} in a loop, outside of callbacks: that delays every iteration"
            yield Finding("IMP013", Severity.WARNING, message, call.place, "Publish in the callback of a timer.")
        elif call.place in published and call.loops and call.root is not None and call.root.scope in facts.publishes:
            message = (
                f"'{entity.variable}' {_VERBS[call.name]} in a loop of unknown length, of which the description has one message"
            )
            yield Finding("IMP013", Severity.WARNING, message, call.place, "Add the other messages to 'publishes' by hand.")
        elif call.place not in published:
            message = f"'{entity.variable}' {_VERBS[call.name]} outside of callbacks, which the description does not have"
            yield Finding(
                "IMP013", Severity.WARNING, message, call.place, "Describe it as a timer, or publish in a timer callback."
            )
        elif entity.reliability == RELIABLE and entity.kind is CodeEntityKind.PUBLISHER:
            message = (
                f"publishing with '{entity.variable}' is reliable: the callback waits for the acknowledgement of the agent"
            )
            yield Finding(
                "IMP012", Severity.INFO, message, call.place, "Use rclc_publisher_init_best_effort where losses are harmless."
            )


#: Functions that change nothing in the description.
_HARMLESS = re.compile(
    r"rclc_(support_\w+|\w+_fini|executor_prepare|executor_get_zero\w*|lifecycle_init_\w+|parameter_\w+|add_parameter\w*|"
    r"action_(publish_feedback|send_result|server_goal_\w+|send_goal_request)|create_\w+|node_fini|set_parameter\w*|"
    r"lifecycle_\w+|delete_parameter)"
)
_CALL = re.compile(rb"\brclc_\w+(?=\s*\()")


def not_understood(walk: CodeWalk, facts: CodeFacts) -> Iterator[Finding]:
    """Calls of unknown functions, code that could not be parsed, and code that is compiled under unknown conditions."""
    if not facts.entities and not facts.executors:
        advice = "Give the files in which rclc_node_init_default and rclc_executor_init are called."
        yield Finding("IMP019", Severity.ERROR, "no entity or executor of micro-ROS is created in these files", None, advice)
    known = CREATIONS.keys() | ACTIONS.keys() | SPINS
    for call in walk.calls:
        if call.name.startswith("rclc_") and call.name not in known and not _HARMLESS.fullmatch(call.name):
            message = f"'{call.name}' is not understood; what it does is not in the description"
            yield Finding("IMP005", Severity.WARNING, message, call.place, "Add what it does to the description by hand.")
        elif call.uncertain and call.name in known:
            message = f"'{call.name}' is compiled under a condition that the sources do not decide; it is taken as compiled"
            yield Finding("IMP015", Severity.INFO, message, call.place, "Remove it from the description if it is not compiled.")
    yield from _unread(walk)


def _is_read_macro(node: Node, walk: CodeWalk) -> bool:
    name = node.child_by_field_name("name") if node.type == "preproc_function_def" else None
    return name is not None and any(each.is_macro for each in walk.program.functions.get(text_of(name), ()))


def _unread(walk: CodeWalk) -> Iterator[Finding]:
    """Calls in the text that no path through the code led to."""
    for file, root in walk.program.files:
        ignored = set(walk.inactive.get(str(file.path), ()))
        read = {start for path, start in walk.seen if path == str(file.path)}
        if _CALL.search(file.text) is None:
            continue
        for node in descendants(root):
            if node.type in ("comment", "string_literal", "preproc_def", "function_declarator") or _is_read_macro(node, walk):
                ignored.add((node.start_byte, node.end_byte))
        spans = TextSpans(ignored)
        for match in _CALL.finditer(file.text):
            position = match.start()
            if position not in read and position not in spans:
                place = file.location_at(position)
                message = f"'{match[0].decode()}' is in code that is not understood; it is not in the description"
                yield Finding("IMP003", Severity.WARNING, message, place, "Add what it does to the description by hand.")
