"""The loops of threads: the items in the same loop as a call that lets an executor spin, in their order."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

from amalthea_uros._internal.limits import ADVICE, SOURCE_LOOP_ITEMS
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.source.entities import CREATIONS
from amalthea_uros.source.executors import NANOSECOND, SPIN_KINDS, executor_of
from amalthea_uros.source.facts import CodeFacts, CodeLoop, CodeLoopItem, CodeLoopKind, CodeSender, Spin, SpinKind
from amalthea_uros.source.locks import ReleasedLocks, held_at_all
from amalthea_uros.source.ports import MILLISECOND
from amalthea_uros.source.sleeps import SLEEPS, WaitCall, wait_of
from amalthea_uros.source.walk import CodeWalk, FunctionCall, Mark
from amalthea_uros.units import Time

#: Functions of micro-ROS/rmw_microxrcedds that wait for an answer of the agent -> what they do, and the position of their attempts.
_AGENT = {
    "rmw_uros_ping_agent": (CodeLoopKind.PING, 1),
    "rmw_uros_ping_agent_options": (CodeLoopKind.PING, 1),
    "rmw_uros_sync_session": (CodeLoopKind.SYNC, None),
}
ROUND_TRIPS = tuple(_AGENT)
SENDS = ("rcl_publish", "rcl_send_request")
_CREATING = frozenset({"rclc_executor_init", *CREATIONS})
_USES = frozenset({*SPIN_KINDS, *SENDS, "rclc_action_publish_feedback", "rclc_action_send_result"})


def add_spins(facts: CodeFacts, calls: Sequence[FunctionCall]) -> None:
    """Add to each executor how it spins, with everything else that is in the same loop."""
    loops = _LoopItems(facts, calls)
    known: set[tuple[str, Location]] = set()
    for call in calls:
        if call.name in SPIN_KINDS and (executor := executor_of(facts, call)) is not None:
            if (executor.key, call.place) in known:
                continue
            known.add((executor.key, call.place))
            executor.spins.append(_spin(call, loops))


def _spin(call: FunctionCall, loops: _LoopItems) -> Spin:
    kind, is_loop = SPIN_KINDS[call.name], is_repeated(call)
    return Spin(
        kind=kind,
        time=_timeout(call),
        place=call.place,
        # A sleep before an endless loop, or in setup(), is not part of the iteration.
        items=loops.around(call) if kind is SpinKind.SOME and is_loop else CodeLoop(),
        is_in_loop=(kind is not SpinKind.SOME and call.name != "rclc_executor_spin_one_period") or is_loop,
    )


def add_senders(facts: CodeFacts, calls: Sequence[FunctionCall]) -> None:
    """Add the loops that send outside of callbacks, and in which no executor spins."""
    published = {place for places in facts.publishes.values() for place in places.values()}
    loops = _LoopItems(facts, calls)
    known = published | facts.described_places()
    for call in calls:
        sender = call.argument(0)
        is_sending = call.name in SENDS and sender is not None
        if not is_sending or not is_repeated(call) or call.root is None or call.place in known:
            continue
        items = loops.around(replace(call, loops=_loop_of_thread(call, loops.creations)))
        known |= {item.place for item in items}
        if _add_to_spins(facts, items):
            continue
        thread = facts.threads.get(call.root.scope)
        name = thread.name if thread is not None else call.root.name
        facts.senders.append(CodeSender(name=name, thread=thread, items=items, place=call.place))


def _add_to_spins(facts: CodeFacts, items: CodeLoop) -> bool:
    """Whether executors spin in a loop that sends, which then is theirs, with the loop in which they spin in it."""
    spinning = [facts.executors[item.of] for item in items if item.kind is CodeLoopKind.SPIN]
    for executor in spinning:
        executor.spins[0] = replace(executor.spins[0], items=items)
    return bool(spinning)


def _loop_of_thread(call: FunctionCall, creations: Creations) -> tuple[Mark, ...]:
    """The loops around the iteration of the thread that sends: up to the outermost one that does not create what it sends with."""
    created = next((each.loops for each in creations.of(call)), ())
    common = sum(first == second for first, second in zip(created, call.loops, strict=False))
    is_iteration = call.root is not None and call.root.name == "loop" and not common
    return call.loops[: common + (not is_iteration)]


class Creations:
    """The calls that create what others spin or send with, by thread and object."""

    def __init__(self, calls: Iterable[FunctionCall]) -> None:
        self._calls: dict[tuple[int, str], list[FunctionCall]] = {}
        for call in calls:
            if call.name in _CREATING and (given := call.argument(0)) is not None:
                self._calls.setdefault((id(call.root), given.key), []).append(call)

    def of(self, user: FunctionCall) -> Sequence[FunctionCall]:
        """Those of the same thread that create what a call spins or sends with."""
        used = user.argument(0)
        return self._calls.get((id(user.root), used.key), ()) if used is not None else ()


def is_only_at_creation(call: FunctionCall, user: FunctionCall, created: Iterable[FunctionCall]) -> bool:
    """Whether a call is made only together with the creation of what another one spins or sends with, not in each iteration.

    Parameters
    ----------
    created : the creations of the other one
    """
    return any(each.always_with(call) and not each.always_with(user) for each in created)


def session_users(facts: CodeFacts, walk: CodeWalk) -> dict[str, list[FunctionCall]]:
    """The threads that use the session of the middleware again and again, by their names, with the calls that do."""
    users: dict[str, list[FunctionCall]] = {}
    for call in walk.calls:
        if call.root is None or call.name not in _USES or call.root.scope in facts.publishes:
            continue
        thread = facts.threads.get(call.root.scope)
        if thread is not None or is_repeated(call):
            users.setdefault(thread.name if thread is not None else call.root.name, []).append(call)
    return users


def add_lock(facts: CodeFacts, walk: CodeWalk) -> None:
    """Note a lock that every thread holds whenever it uses the session."""
    calls = [call for each in session_users(facts, walk).values() for call in each]
    if calls and held_at_all(calls, walk.calls):
        facts.lock = calls[0].place


def is_repeated(call: FunctionCall) -> bool:
    """Whether a call is in a loop; `loop` of Arduino is one."""
    return bool(call.loops) or (call.root is not None and call.root.name == "loop")


def _timeout(call: FunctionCall) -> Time | None:
    given = call.argument(1)
    number = given.number if given is not None else None
    return Time(number * NANOSECOND) if number is not None and number >= 0 else None


class _LoopItems:
    """The items of loops, those of each loop found once, because thousands of calls may spin or send in it."""

    def __init__(self, facts: CodeFacts, calls: Sequence[FunctionCall]) -> None:
        self.creations = Creations(calls)
        self._inside: dict[tuple[int, Mark | None], list[tuple[FunctionCall, CodeLoopItem]]] = defaultdict(list)
        self._found: dict[tuple[object, ...], CodeLoop] = {}
        self._left = SOURCE_LOOP_ITEMS
        locks = ReleasedLocks(calls)
        for call in calls:
            if (item := _item(facts, call)) is not None and not locks.has(call):
                for loop in (None, *dict.fromkeys(call.loops)):
                    self._inside[id(call.root), loop].append((call, item))

    def around(self, user: FunctionCall) -> CodeLoop:
        """The items in the same loop as a call that spins or sends.

        Raises
        ------
        ReadError : there are too many, under too many conditions.
        """
        # What else a call uses makes a difference by the conditions under which that is created only.
        created = frozenset(each.conditions for each in self.creations.of(user))
        key = (id(user.root), user.loops, user.conditions, created)
        if key not in self._found:
            self._found[key] = CodeLoop(self._items(user))
        return self._found[key]

    def _items(self, user: FunctionCall) -> Iterator[CodeLoopItem]:
        """The items in the same loop, or in one in it, and not in another branch of a choice, such as another state."""
        created = self.creations.of(user)
        candidates = self._inside[id(user.root), user.loops[-1] if user.loops else None]
        self._left -= len(candidates)
        if self._left < 0:
            message = "too much is in loops, under too many conditions"
            raise ReadError([Finding("IMP002", Severity.ERROR, message, user.place, f"Give only the application. {ADVICE}")])
        for call, item in candidates:
            # A function that is called in several places has the same loop several times.
            if call.loops[: len(user.loops)] != user.loops or call.excludes(user):
                continue
            if is_only_at_creation(call, user, created):
                continue
            if call.loops != user.loops:
                yield replace(item, time=None, note="in a loop of its own: how often per iteration is unknown")
            elif call.always_with(user) or item.kind not in _TIMED:
                yield item
            else:
                yield replace(item, time=None, note="not in each iteration")


_TIMED = (CodeLoopKind.SLEEP, CodeLoopKind.BUSY_WAIT)


def _item(facts: CodeFacts, call: FunctionCall) -> CodeLoopItem | None:
    if call.name in SLEEPS:
        return _wait(wait_of(call, facts), call)
    if call.name in _AGENT:
        kind, position = _AGENT[call.name]
        attempts = 1 if position is None else _number(call, position)
        return CodeLoopItem(kind=kind, time=_answer(call, attempts), place=call.place, attempts=attempts or 1, every=call.every)
    if call.name in SENDS and (sender := call.argument(0)) is not None:
        return CodeLoopItem(kind=CodeLoopKind.PUBLISH, time=None, place=call.place, of=sender.key, every=call.every)
    if SPIN_KINDS.get(call.name) is SpinKind.SOME and (executor := executor_of(facts, call)) is not None:
        return CodeLoopItem(kind=CodeLoopKind.SPIN, time=_timeout(call), place=call.place, of=executor.key)
    return None


def _wait(wait: WaitCall, call: FunctionCall) -> CodeLoopItem | None:
    if wait.time == 0:
        return None
    kind = CodeLoopKind.BUSY_WAIT if wait.is_busy else CodeLoopKind.SLEEP
    return CodeLoopItem(kind=kind, time=wait.time, place=call.place, note=wait.note or wait.waits_for)


def _answer(call: FunctionCall, attempts: int | None) -> Time | None:
    """The longest time until an answer of the agent comes, or none."""
    once = _number(call, 0)
    return None if once is None or attempts is None or once < 0 or attempts < 0 else Time(once * attempts * MILLISECOND)


def _number(call: FunctionCall, position: int) -> int | None:
    given = call.argument(position)
    return None if given is None else given.number
