"""Evaluates event chains: routes, read and write times, all valid methods, and the tightest value of each quantity."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import zip_longest

import numpy as np

from amalthea_uros._internal.failures import failure
from amalthea_uros._internal.records import dataclass, field, replace
from amalthea_uros.analyze.chains.job_chains import TOO_MANY_JOBS, JobBudget
from amalthea_uros.analyze.chains.read_write_times import TimedStage
from amalthea_uros.analyze.chains.route_latencies import RouteLatencies
from amalthea_uros.analyze.chains.stage_timing import StageTiming
from amalthea_uros.analyze.response_times.solution import Solution
from amalthea_uros.analyze.results.chains import ChainResult, LatencyQuantity, LatencyValue
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.events import EventChain
from amalthea_uros.timing.activation.releases import ExternalInput, unknown_phases
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.dataflow.chains import Unfolded, combined, empty_sets, is_decided_by_one_path, sequences, unfold
from amalthea_uros.timing.dataflow.events import UnraisedError
from amalthea_uros.timing.dataflow.links import LinkKind
from amalthea_uros.timing.dataflow.routes import Route, UnlinkedError, route_text, routes_of_paths
from amalthea_uros.timing.dataflow.stages import Stage, common_communication, stages
from amalthea_uros.timing.dataflow.untyped_events import ASSUMPTION, is_untyped
from amalthea_uros.timing.response import Claim
from amalthea_uros.timing.scheduling.allocation import controller_of_core


@dataclass(slots=True)
class ChainEvaluator:
    """Evaluates the chains of a system."""

    solution: Solution
    budget: JobBudget = field(default_factory=JobBudget)
    timing: StageTiming = field(init=False)
    controllers: Mapping[str, str] = field(init=False)
    _unknown_phases: Mapping[ExternalInput, int] = field(init=False)

    @property
    def context(self) -> TimingContext:
        """The timing context of the system."""
        return self.solution.context

    def __post_init__(self) -> None:
        self.timing = StageTiming(self.solution)
        self.controllers = controller_of_core(self.context.system)
        self._unknown_phases = {each: number for number, each in enumerate(unknown_phases(self.context.system))}

    def chain(self, chain: EventChain) -> ChainResult:
        """The latencies of a chain. If its evaluation fails, that is a finding, and the chain is unknown."""
        try:
            return self._chain(chain)
        except Exception as error:
            reason = f"the evaluation failed: {failure(error)}"
            self.context.notes.error("CHN006", f"the chain {chain.name!r} is unknown: {reason}", chain)
            return ChainResult(name=chain.name, communication="", reason=reason)

    def _chain(self, chain: EventChain) -> ChainResult:
        try:
            unfolded, left_out = unfold(chain, self.context.system)
            paths = routes_of_paths(unfolded, self.context.dataflow, with_readings=True)
        except UnknownError as error:
            self._note_unknown(chain, error)
            return ChainResult(name=chain.name, communication="", reason=str(error))
        passed = {events: [(route, self._stages(route)) for route in of_path] for events, of_path in paths.items()}
        every = [each for of_path in passed.values() for each in of_path]
        self._note_left_out(chain, left_out)
        self._note_ends(chain, tuple(paths))
        values: dict[tuple[str, ...], list[LatencyValue]] = {}
        why = why_unbounded = reason = ""
        for events, of_path in passed.items():
            try:
                methods = [self._latencies(route, through) for route, through in of_path]
                of_methods = [list(method.values()) for method in methods]
            except UnknownError as error:
                reason, values[events] = str(error), []
                continue
            values[events] = _worst_of(of_methods)
            whys = [method.why(own) for method, own in zip(methods, of_methods, strict=True)]
            # As soon as one of the routes has only bounds, because of that.
            why = why or next((each for each in whys if each.startswith("bounds")), whys[0])
            why_unbounded = why_unbounded or next((m.why_unbounded for m in methods if m.why_unbounded), "")
        if self.budget.is_exceeded:
            self.context.notes.assume(f"{TOO_MANY_JOBS}; the chains without them have bounds of other methods")
        all_values = _combine(unfolded, values)
        if any(is_untyped(self.context.system.events_by_name[name]) for path in paths for name in path):
            self.context.notes.assume(ASSUMPTION)
            all_values = [replace(each, claim=Claim.BOUND) for each in all_values if each.quantity.is_upper]
            why = "bounds: events of the chain have no type"
        tightest = _tightest(all_values)
        has_bound = any(value.quantity is LatencyQuantity.MAX_REDUCED_REACTION_TIME for value in tightest)
        reason = reason or ("" if has_bound else why_unbounded)
        if reason:
            self.context.notes.warning("CHN003", f"the chain {chain.name!r} has no finite bound: {reason}", chain)
        return ChainResult(
            name=chain.name,
            communication=common_communication(stage for _, through in every for stage in through),
            routes=tuple(route_text(route) for route, _ in every),
            values=tightest,
            all_values=tuple(all_values),
            why=why,
            reason=reason,
        )

    def occurrences(self, chain: EventChain) -> tuple[ExternalInput, ...]:
        """What comes from outside with an unknown phase and is taken by the jobs of a chain; nothing if it cannot be evaluated."""
        unknown = self._unknown_phases
        if not unknown:
            return ()
        found = {
            ExternalInput.of(stage.process.name, counter)
            for stage in self.stages(chain)
            if (counter := stage.counter) is not None
        }
        return tuple(sorted(filter(unknown.__contains__, found), key=unknown.__getitem__))

    def stages(self, chain: EventChain) -> list[Stage]:
        """The stages of all paths through a chain; nothing if it cannot be evaluated."""
        return [stage for route in self.routes(chain) for stage in self._stages(route)]

    def routes(self, chain: EventChain) -> list[Route]:
        """The routes of all paths through a chain; nothing if it cannot be evaluated."""
        try:
            unfolded = unfold(chain, self.context.system)[0]
            paths = routes_of_paths(unfolded, self.context.dataflow, with_readings=True)
        except UnknownError:
            return []
        return [route for found in paths.values() for route in found]

    def is_one_run(self, chain: EventChain) -> bool:
        """Whether jobs that a chain passes can only run in one way: with known phases, and best cases that are the worst ones."""
        if self.occurrences(chain):
            return False
        for stage in self.stages(chain):
            name = stage.process.name
            core = self.context.scheduled[name].core
            found = self.solution.schedule(core)
            if found is None or name not in found.tasks or not np.array_equal(found.best[name].ends, found.worst[name].ends):
                return False
        return True

    def processes(self, chain: EventChain) -> list[str]:
        """The processes in which the events of a chain occur, in its order; nothing if these cannot be located."""
        system, events = self.context.system, self.context.dataflow.events
        try:
            paths = sequences(unfold(chain, system)[0])
            found = (each.process.name for path in paths for name in path for each in events.of(system.events_by_name[name]))
            return list(dict.fromkeys(found))
        except UnknownError:
            return []

    def worst(self, found: Iterable[Route]) -> tuple[LatencyValue, ...]:
        """The tightest values over routes from one event to another, which need not be part of a chain.

        Raises
        ------
        UnknownError : there are no values.
        """
        return _tightest(_worst_of([list(self.latencies(route).values()) for route in found]))

    def _note_ends(self, chain: EventChain, paths: Sequence[tuple[str, ...]]) -> None:
        """Report ends of a chain that it does not state itself."""
        notes = self.context.notes
        for end, stated, index in (("stimulus", chain.stimulus, 0), ("response", chain.response, -1)):
            if stated is None:
                events = " and ".join(repr(event) for event in dict.fromkeys(path[index] for path in paths))
                verb = "starts" if index == 0 else "ends"
                notes.warning("CHN007", f"the chain {chain.name!r} has no {end} of its own; it {verb} with {events}", chain)
        for name in empty_sets(chain, self.context.system):
            message = f"the event set {name!r} of the chain {chain.name!r} is empty and is skipped"
            notes.warning("CHN008", message, chain)

    def _note_unknown(self, chain: EventChain, error: UnknownError) -> None:
        """Report why a chain is not evaluated."""
        notes = self.context.notes
        match error:
            case UnlinkedError(gaps=gaps):
                for first, then in gaps:
                    message = f"in the chain {chain.name!r} no data flow or trigger connects {first!r} to {then!r}; it is not evaluated"
                    notes.warning("CHN002", message, chain)
            case UnraisedError():
                notes.warning("CHN004", f"the chain {chain.name!r} is not evaluated: {error}", chain)
            case _:
                notes.warning("CHN001", f"the chain {chain.name!r} is not evaluated: {error}", chain)

    def _note_left_out(self, chain: EventChain, left_out: Iterable[str]) -> None:
        """Report events at which parts of a chain start or end, but not the chain."""
        for event in left_out:
            message = (
                f"the chain {chain.name!r} does not start or end with {event!r}, but a part of it does; {event!r} is ignored"
            )
            self.context.notes.warning("CHN005", message, chain)

    def _stages(self, route: Route) -> list[Stage]:
        return stages(route, self.context.settings.communication)

    def groups(self, route: Route) -> list[Sequence[Stage]]:
        """The stages of a route, each together with those that it triggers."""
        return self.timing.after_ends(_groups(self._stages(route)))

    def latencies(self, route: Route) -> RouteLatencies:
        """The latencies of a route.

        Raises
        ------
        UnknownError : there is no bound.
        """
        return self._latencies(route, self._stages(route))

    def _latencies(self, route: Route, through: Sequence[Stage]) -> RouteLatencies:
        """The same, by the stages of the route."""
        for link in route.links:
            if link.kind is LinkKind.MESSAGE:
                raise UnknownError(
                    f"the message {link.names[0]!r} leaves the system and comes back, and nobody stated how long that takes"
                )
            if link.kind is LinkKind.DATA:
                self._require_known_writers(link.names)
        parts: list[list[TimedStage]] = []
        groups = self.timing.after_ends(_groups(through))
        followers, writers = [after[0] for after in groups[1:]], [before[-1] for before in groups[:-1]]
        controllers = [self.controller(group[0].process.name) for group in groups]
        for number, (group, follower, writer) in enumerate(zip_longest(groups, followers, [None, *writers])):
            if not number or controllers[number] != controllers[number - 1]:
                parts.append([])
            parts[-1].append(self.timing.group(group, follower, writer))
        return RouteLatencies(parts, self.timing.unit, is_certain=route.is_timed, budget=self.budget)

    def _require_known_writers(self, labels: Iterable[str]) -> None:
        """Refuse data that an unknown process writes, too: what a job reads can be of that one; raises as `latencies`."""
        for label in labels:
            for name in self.context.touching.writers(label):
                if name in self.solution.reasons:
                    raise UnknownError(f"{name!r}, which could not be analysed, writes {label!r}")

    def controller(self, process: str) -> str:
        """The controller of a process; "" if it is unknown."""
        scheduled = self.context.scheduled.get(process)
        return self.controllers.get(scheduled.core, "") if scheduled is not None else ""


def _groups(found: Sequence[Stage]) -> list[list[Stage]]:
    """Each stage together with those that it triggers."""
    groups: list[list[Stage]] = []
    for stage in found:
        if stage.is_triggered:
            groups[-1].append(stage)
        else:
            groups.append([stage])
    return groups


def _worst_of(found: Sequence[Sequence[LatencyValue]]) -> list[LatencyValue]:
    """The worst values over the routes of one sequence of events: of each method that all of them have, and of the tightest ones."""
    if len(found) == 1:
        return list(found[0])
    result = []
    for value in found[0]:
        same = [_same(value, others) for others in found]
        if None not in same:
            result += _worst([each for each in same if each is not None])
    tightest = [{value.quantity: value for value in _tightest(values)} for values in found]
    for quantity in tightest[0]:
        if all(quantity in own for own in tightest):
            # The methods of the routes can differ.
            result += [value for value in _worst([own[quantity] for own in tightest]) if value not in result]
    return result


def _worst(values: Sequence[LatencyValue]) -> list[LatencyValue]:
    """The worst of some values of a quantity; there is no mean if they differ."""
    if values[0].quantity.is_mean:
        return [values[0]] if all(value == values[0] for value in values) else []
    worst = (max if values[0].quantity.is_upper else min)(value.value or 0 for value in values)
    here = [value for value in values if value.value == worst]
    return [next((value for value in here if value.claim is Claim.EXACT), here[0])]


def _same(value: LatencyValue, others: Iterable[LatencyValue]) -> LatencyValue | None:
    return next((o for o in others if (o.quantity, o.method) == (value.quantity, value.method)), None)


def _combine(unfolded: Unfolded, values: Mapping[tuple[str, ...], list[LatencyValue]]) -> list[LatencyValue]:
    """The values of a chain from those of all paths through it."""
    if len(values) == 1:
        return next(iter(values.values()))
    (_, first), *_ = values.items()
    found = []
    for value in first:
        each = {events: _same(value, paths) for events, paths in values.items()}
        if None in each.values() or value.quantity.is_mean:
            continue
        times = {events: path.value for events, path in each.items() if path is not None}
        if value.quantity.is_reaction:
            time = combined(unfolded, times)
        else:
            finite = [time for time in times.values() if time is not None]
            time = (max if value.quantity.is_upper else min)(finite)
        is_exact = _can_be_exact(value.quantity, unfolded) and all(path and path.claim is Claim.EXACT for path in each.values())
        found.append(
            LatencyValue(
                quantity=value.quantity,
                value=time,
                claim=Claim.EXACT if is_exact else Claim.BOUND,
                method=value.method,
                source=value.source,
            )
        )
    return found


def _can_be_exact(quantity: LatencyQuantity, unfolded: Unfolded) -> bool:
    """Whether exact values of the paths make that of their chain exact: a join can always take longer than its fastest path."""
    if quantity is LatencyQuantity.MIN_FIRST_TO_FIRST:
        return is_decided_by_one_path(unfolded, is_upper=False)
    # The maximum of minima is not the minimum of maxima: for alternatives it is a bound.
    return not quantity.is_reaction


def _tightest(values: Sequence[LatencyValue]) -> tuple[LatencyValue, ...]:
    """For each quantity the exact value, or else the tightest bound."""
    found = {}
    for quantity in LatencyQuantity:
        here = [value for value in values if value.quantity is quantity and value.value is not None]
        exact = [value for value in here if value.claim is Claim.EXACT]
        if here:
            tightest = (min if quantity.is_upper else max)(here, key=lambda value: value.value or 0)
            found[quantity] = exact[0] if exact else tightest
    return tuple(found.values())
