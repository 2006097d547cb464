"""The chains of a system: resolved, put in time, evaluated by every method, and the tightest valid value of each taken."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from amalthea_uros.analyze.chains.methods import Methods
from amalthea_uros.analyze.chains.read_write_times import StageTiming, UnboundedStageError
from amalthea_uros.analyze.chains.stages import Stage, communication_of, hop_text, stages
from amalthea_uros.analyze.chains.timed_stage import TimedStage
from amalthea_uros.analyze.results import ChainResult, Claim, Quantity, Value
from amalthea_uros.analyze.solution import Solution
from amalthea_uros.perf.events import Event, EventChain
from amalthea_uros.timing.clocks import controller_of_core
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.dataflow.chains import Unfolded, UnfoldError, combined, sequences, unfold
from amalthea_uros.timing.dataflow.events import UnresolvedError
from amalthea_uros.timing.dataflow.links import GAPS, LinkKind
from amalthea_uros.timing.dataflow.routes import Route, routes


@dataclass(slots=True)
class Evaluation:
    """Evaluates the chains of a system."""

    solution: Solution
    timing: StageTiming = field(init=False)
    controllers: Mapping[str, str] = field(init=False)

    @property
    def context(self) -> TimingContext:
        """The system."""
        return self.solution.context

    def __post_init__(self) -> None:
        self.timing = StageTiming(self.solution)
        self.controllers = controller_of_core(self.context.system)

    def chain(self, chain: EventChain) -> ChainResult:
        """One chain."""
        known_events = self.context.system.events_by_name
        try:
            unfolded, left_out = unfold(chain, self.context.system)
            ways = {
                events: routes([known_events[name] for name in events], self.context.dataflow) for events in sequences(unfolded)
            }
        except (UnfoldError, UnresolvedError) as error:
            self.context.notes.warning("CHN001", f"the chain {chain.name!r} is not evaluated: {error}", chain)
            return ChainResult(name=chain.name, communication="", reason=str(error))
        every = [route for found in ways.values() for route in found]
        self._note(chain, left_out, every)
        found = self._evaluated(ways)
        everything = _combine(unfolded, found.values)
        tightest = _tightest(everything)
        has_bound = any(value.quantity is Quantity.MAX_REACTION_TIME for value in tightest)
        reason = found.reason or ("" if has_bound else found.why_unbounded)
        if reason:
            self.context.notes.warning("CHN003", f"the chain {chain.name!r} has no finite bound: {reason}", chain)
        return ChainResult(
            name=chain.name,
            communication=communication_of(stage for route in every for stage in self._stages(route)),
            routes=tuple(map(_route_text, every)),
            values=tightest,
            everything=tuple(everything),
            why=found.why,
            reason=reason,
        )

    def _evaluated(self, ways: Mapping[tuple[str, ...], Sequence[Route]]) -> _Evaluated:
        """The values of each way through a chain, and why they are what they are."""
        found = _Evaluated()
        for events, found_routes in ways.items():
            try:
                methods = [self._methods(route) for route in found_routes]
            except UnboundedStageError as error:
                found.reason = str(error)
                found.values[events] = []
                continue
            found.values[events] = _worst_of([list(method.values()) for method in methods])
            found.why = found.why or methods[0].why
            found.why_unbounded = found.why_unbounded or next((m.why_unbounded for m in methods if m.why_unbounded), "")
        return found

    def pair(self, first: Event, then: Event) -> tuple[Value, ...]:
        """The tightest values from one event to another, whether there is a chain between them or not.

        Raises
        ------
        UnresolvedError, UnboundedStageError : nothing is known of them.
        """
        found = routes([first, then], self.context.dataflow)
        return _tightest(_worst_of([list(self._methods(route).values()) for route in found]))

    def _note(self, chain: EventChain, left_out: Iterable[str], found: Sequence[Route]) -> None:
        """What had to be assumed of a chain."""
        notes = self.context.notes
        for event in left_out:
            message = f"the chain {chain.name!r} does not start or end with {event!r}, as a part of it does; that is left out"
            notes.warning("CHN005", message, chain)
        for event, guess in self.context.dataflow.events.guesses.items():
            message = f"nothing in the model makes the event {event!r} occur; it is taken to do so {guess}"
            notes.warning("CHN004", message, self.context.system.events_by_name[event])
        for route in found:
            for link, first, then in zip(route.links, route.events, route.events[1:], strict=False):
                if link.kind in GAPS:
                    message = (
                        f"in the chain {chain.name!r} nothing carries the effect from {first!r} to {then!r}; "
                        "it is evaluated as if there were a variable between them"
                    )
                    notes.warning("CHN002", message, chain)

    def _stages(self, route: Route) -> list[Stage]:
        return stages(route, self.context.settings.communication)

    def _methods(self, route: Route) -> Methods:
        for link in route.links:
            if link.kind is LinkKind.TOPIC:
                raise UnboundedStageError(
                    f"the message {link.names[0]!r} leaves the system and comes back, and nobody stated how long that takes"
                )
        parts: list[list[TimedStage]] = []
        before = None
        for group, follower in _with_followers(_groups(self._stages(route))):
            controller = self._controller(group[0])
            if controller != before or not parts:
                parts.append([])
            parts[-1].append(self.timing.group(group, follower))
            before = controller
        return Methods(parts, self.timing.unit, is_certain=route.is_timed)

    def _controller(self, stage: Stage) -> str:
        placed = self.context.scheduled.get(stage.process.name)
        return self.controllers.get(placed.core, "") if placed is not None else ""


@dataclass(slots=True)
class _Evaluated:
    """Values by the events of a way through a chain.

    Attributes
    ----------
    why : why the tightest ones are what they are
    why_unbounded : why some are not there
    reason : why a way has none at all
    """

    values: dict[tuple[str, ...], list[Value]] = field(default_factory=dict)
    why: str = ""
    why_unbounded: str = ""
    reason: str = ""


def _groups(found: Sequence[Stage]) -> list[list[Stage]]:
    """Stages with those that they trigger."""
    groups: list[list[Stage]] = []
    for stage in found:
        if stage.is_triggered:
            groups[-1].append(stage)
        else:
            groups.append([stage])
    return groups


def _with_followers(groups: Sequence[Sequence[Stage]]) -> list[tuple[Sequence[Stage], Stage | None]]:
    followers: list[Stage | None] = [group[0] for group in groups[1:]]
    return list(zip(groups, [*followers, None], strict=True))


def _route_text(route: Route) -> str:
    parts = [route.events[0]]
    for link, event in zip(route.links, route.events[1:], strict=True):
        parts.append(f"-[{hop_text(link)}]-> {event}")
    return " ".join(parts)


def _worst_of(found: Sequence[Sequence[Value]]) -> list[Value]:
    """The values of several ways that one sequence of events can mean: of each method the worst one."""
    if len(found) == 1:
        return list(found[0])
    result = []
    for value in found[0]:
        same = [_same(value, others) for others in found]
        if None not in same and not value.quantity.is_mean:
            worst = max if value.quantity.is_upper else min
            result.append(worst((each for each in same if each is not None), key=lambda each: each.value or 0))
    return result


def _same(value: Value, others: Iterable[Value]) -> Value | None:
    return next((o for o in others if (o.quantity, o.method) == (value.quantity, value.method)), None)


def _combine(unfolded: Unfolded, values: Mapping[tuple[str, ...], list[Value]]) -> list[Value]:
    """The values of a chain from those of the ways through it."""
    if len(values) == 1:
        return next(iter(values.values()))
    (_, first), *_ = values.items()
    found = []
    for value in first:
        each = {events: _same(value, ways) for events, ways in values.items()}
        if None in each.values() or value.quantity.is_mean:
            continue
        times = {events: way.value for events, way in each.items() if way is not None}
        reacts = value.quantity in (Quantity.MAX_REACTION_TIME, Quantity.MAX_REDUCED_REACTION_TIME)
        if reacts:
            time = combined(unfolded, times)
        else:
            known = [time for time in times.values() if time is not None]
            time = (max if value.quantity.is_upper else min)(known)
        found.append(
            Value(
                quantity=value.quantity,
                value=time,
                # The greatest of the smallest is not the smallest of the greatest: of alternatives it is a bound.
                claim=Claim.BOUND
                if reacts or any(way.claim is not Claim.EXACT for way in each.values() if way)
                else Claim.EXACT,
                method=value.method,
                source=value.source,
            )
        )
    return found


def _tightest(values: Sequence[Value]) -> tuple[Value, ...]:
    """Of each quantity the value that is exact, or else the tightest bound."""
    found = {}
    for quantity in Quantity:
        here = [value for value in values if value.quantity is quantity and value.value is not None]
        exact = [value for value in here if value.claim is Claim.EXACT]
        if exact or here:
            found[quantity] = (exact or [_best(here, quantity)])[0]
    return tuple(found.values())


def _best(values: Sequence[Value], quantity: Quantity) -> Value:
    def time(value: Value) -> int:
        return value.value or 0

    return min(values, key=time) if quantity.is_upper else max(values, key=time)
