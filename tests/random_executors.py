"""Random applications of executors, with what is needed to play them, and what their analysis may say of what was played."""

from dataclasses import dataclass, replace
from random import Random

from hand_made_systems import Proc, system
from looping_executors import combined, guard, message, timer
from played_executors import Spans, play

from amalthea_uros.analyze.response_times.propagation import solve
from amalthea_uros.executors.bounds.evaluate import evaluate_executors
from amalthea_uros.executors.semantics.loops import timing_context
from amalthea_uros.perf.activities import Call, Chance, Demand, Execute, ProbabilitySwitch
from amalthea_uros.perf.distributions import Boundaries, Constant
from amalthea_uros.perf.executors import (
    Executor,
    HandleKind,
    LoopKind,
    Publication,
    ThreadLoop,
    ThreadPlace,
    TriggerCondition,
    TriggerKind,
    WaitBehaviour,
)
from amalthea_uros.perf.network import Span
from amalthea_uros.perf.software import Runnable
from amalthea_uros.perf.stimuli import Periodic, RelativePeriodic, Stimuli
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import MILLISECOND as MS

SHAPES = ("message",), ("timer",), ("message", "message", "timer"), ("message", "timer", "guard"), ("timer", "guard")
RECEIVING = HandleKind.SUBSCRIPTION, HandleKind.SUBSCRIPTION, HandleKind.SERVICE, HandleKind.CLIENT
#: Of messages and timers, in milliseconds: fast, usual and slow.
RATES = (3, 7, 20), (20, 40, 90, 250), (90, 250, 400)


@dataclass
class Application:
    """A system with all that a player needs besides."""

    system: object
    costs: dict
    spins: dict
    sending: dict
    delays: dict
    preempting: list
    priorities: dict

    def results(self):
        solution = solve(timing_context(self.system))
        sending = {name: Span(least=least, most=most) for name, (least, most) in self.sending.items()}
        return evaluate_executors(solution, sending=sending, extra_jitter=self.delays)

    def play(self, random, horizon):
        draw = random.choice((_least, _most, random.randint, _either(random), random.randint))
        spans = Spans(costs=self.costs, spins=self.spins, sending=self.sending, draw=draw)
        return play(
            self.system.executors,
            spans,
            horizon,
            random=random,
            preempting=self.preempting,
            priorities=self.priorities,
            delays=self.delays,
        )


def _least(least, most):
    return least


def _most(least, most):
    return most


def _either(random):
    return lambda least, most: random.choice((least, most))


def _span(random, values, varying):
    """An execution time in microseconds."""
    most = random.choice(values)
    return (random.randint(0, most) if varying else most, most)


def _loop(random, with_sleep=False):
    timeout = random.choice((0, 1, 10, 20, 100)) * MS + random.choice((0, 0, 0, 300 * US))
    kind = random.choice(("sleep", "sleep", "early", "bare", "period", "spin")[: 3 if with_sleep else 6])
    sleep = random.choice((1, 5, 10, 50)) * MS
    match kind:
        case "sleep":
            return ThreadLoop(kind=LoopKind.SLEEPING, timeout=timeout, sleep=sleep)
        case "early":
            tick = random.choice((1, 5, 10)) * MS
            ticks = -(-sleep // tick)
            exact = random.random() < 0.3
            sleep, early = (ticks + exact) * tick, tick
            return ThreadLoop(kind=LoopKind.SLEEPING, timeout=timeout, sleep=sleep, sleep_early=early, pace=ticks * tick)
        case "bare":
            return ThreadLoop(kind=LoopKind.SLEEPING, timeout=timeout)
        case "period":
            return ThreadLoop(kind=LoopKind.PERIODIC, period=random.choice((2, 5, 20, 25)) * MS, timeout=max(timeout, MS))
    return ThreadLoop(kind=LoopKind.CONTINUOUS, timeout=random.choice((1, 20, 100, 1000)) * MS)


def _handles(random, prefix, varying, sending, delays, shape):
    found, rates = [], random.randrange(len(RATES))
    for number in range(random.choice((1, 1, 2, 2, 3, 4, 5))):
        name, kind = f"{prefix}{number}", random.choice(shape)
        interval = random.choice(RATES[rates]) * 1000 + random.choice((0, 0, 137))
        low, most = _span(random, (0, 1, 130, 999, 2500), varying)
        phase = random.choice((None, random.randint(0, interval) * US))
        publications = []
        for _ in range(random.choice((0, 0, 0, 1, 1, 2)) if random.random() < 0.5 else 0):
            transmission = f"{name}_{len(sending)}"
            timeout = random.choice((5, 60)) * MS
            upper = random.choice((100 * US, 2 * MS, timeout))
            sending[transmission] = (random.randint(0, upper // US) * US, upper) if varying else (upper, upper)
            waits = random.random() < 0.8
            publications.append(
                Publication(
                    topic="t", transmission=transmission, reliable=waits, waits=waits, timeout=timeout if waits else None
                )
            )
        parts = {"phase": phase, "publications": tuple(publications)}
        if kind == "timer":
            handle, _ = timer(name, interval, **parts)
        elif kind == "guard":
            handle, _ = guard(name, interval, jitter=random.choice((0, 0, 10)) * MS, is_periodic=random.random() < 0.5, **parts)
        else:
            handle, _ = message(
                name,
                interval,
                jitter=random.choice((0, 0, 10, 100)) * MS,
                is_periodic=random.random() < 0.6,
                depth=random.choice((1, 2, 10)),
                overwrites=random.random() < 0.7,
                always=random.random() < 0.15,
                take=f"Take_{name}" if random.random() < 0.3 else None,
                **parts,
            )
            handle = replace(handle, kind=random.choice(RECEIVING))
            delays[name] = random.choice((0, 0, 0, 3 * MS))
        found.append((handle, (low, most)))
    return found


def _with_items(random, models, varying, sending, costs):
    """Have the thread of the last executor also send itself: what does so, and what its task calls."""
    spinning = models.pop()
    name, loop = f"{spinning.name}_sends", replace(spinning.loop, pace=0)
    handles = []
    for number in range(random.choice((1, 1, 2))):
        (handle, span), *_ = _handles(random, f"{name}{number}_", varying, sending, {}, ("timer",))
        interval = random.choice((None, None, 30 * MS, 137_000 * US))
        handles.append(replace(handle, kind=HandleKind.LOOP_ITEM, interval=interval, phase=None))
        costs[handle.runnable] = span
    sleeps = ThreadPlace(thread=spinning.name, sleep=loop.sleep, sleep_early=loop.sleep_early)
    places = [sleeps, ThreadPlace(thread=spinning.name)]
    random.shuffle(places)
    item = replace(
        spinning,
        name=name,
        task=name,
        spin=f"{name}_Spin",
        loop=replace(loop, timeout=0),
        handles=tuple(handles),
        trigger=TriggerCondition(kind=TriggerKind.ALWAYS),
        takes_first=False,
        place=places[1],
    )
    models += [replace(spinning, loop=loop, place=places[0]), item]
    calls = [
        ProbabilitySwitch(
            branches=(Chance(weight=1.0, activities=(Call(runnable=each.runnable),)), Chance(weight=1.0, activities=()))
        )
        for each in handles
    ]
    return item, calls


def _trigger(random, names):
    kind = random.choice(("any",) * 12 + ("all", "one", "always", "always", "custom"))
    match kind:
        case "any":
            return TriggerCondition()
        case "one":
            return combined(TriggerKind.ONE, {random.choice(names)})
        case "custom":
            return combined(TriggerKind.CUSTOM, *({*random.sample(names, random.randint(1, len(names)))} for _ in range(2)))
    return TriggerCondition(kind=TriggerKind(kind))


def _execute(span):
    low, most = span
    return Execute(demand=Demand(Constant(most) if low == most else Boundaries(lower=low, upper=most)))


def application(random: Random, executors=None) -> Application:
    """Anything; all times but those of handles are drawn for this application, and are constant in half of them."""
    varying = random.random() < 0.6
    count = executors or (2 if random.random() < 0.15 else 1)
    shape = random.choice(SHAPES)
    waiting = WaitBehaviour(slots=random.choice((1, 2, 4, None)))
    if random.random() < 0.2:
        waiting = replace(
            waiting,
            messages_per_wait=random.choice((1, None)),
            resolution=random.choice((0, MS)),
            stored_data_ends_wait=random.random() < 0.5,
            guard_conditions_end_wait=random.random() < 0.5,
            polls_without_messages=random.random() < 0.5,
        )
    session = random.choice((None, "s")) if count > 1 else None
    costs, spins, sending, delays, models, processes, runnables, stimuli, priorities = {}, {}, {}, {}, [], [], [], [], {}
    for number in range(count):
        name = f"E{number}"
        loop = _loop(random, with_sleep=count > 1)
        handles = _handles(random, f"h{number}_", varying, sending, delays, shape)
        spin = _span(random, (0, 1, 50, 500) if loop.sleep else (100, 500), varying)
        spin = (max(spin[0], 0 if loop.sleep else 50), spin[1])
        for handle, span in handles:
            costs[handle.runnable] = span
            if handle.take:
                costs[handle.take] = _span(random, (5, 100), varying)
        names = [handle.name for handle, _ in handles]
        models.append(
            Executor(
                name=name,
                task=name,
                spin=f"{name}_Spin",
                loop=loop,
                handles=tuple(handle for handle, _ in handles),
                trigger=_trigger(random, names),
                takes_first=random.random() < 0.3,
                waiting=waiting,
                session=session,
            )
        )
        runnables.append(Runnable(name=f"{name}_Spin", activities=(_execute(spin),)))
        spins[name] = spin
        body = [Call(runnable=f"{name}_Spin")]
        for handle, _ in handles:
            calls = tuple(Call(runnable=each) for each in (handle.take, handle.runnable) if each)
            body.append(ProbabilitySwitch(branches=(Chance(weight=1.0, activities=calls), Chance(weight=1.0, activities=()))))
        if loop.kind is LoopKind.PERIODIC:
            stimuli.append(Periodic(name=f"{name}_loop", period=loop.period))
        else:
            least = max(loop.sleep - loop.sleep_early, loop.pace if loop.sleep else 0) + spin[0] * US
            stimuli.append(RelativePeriodic(name=f"{name}_loop", distance=Constant(max(least, MS)), has_maximum=False))
        priorities[name] = 5 - number
        if loop.kind is LoopKind.SLEEPING and loop.sleep and random.random() < 0.3:
            item, calls = _with_items(random, models, varying, sending, costs)
            spins[item.name], priorities[item.name] = (0, 0), priorities[name]
            runnables.append(Runnable(name=item.spin, activities=(_execute((0, 0)),)))
            sends = (Call(runnable=item.spin), *calls)
            processes.append(Proc(item.name, sends, stimuli=(f"{name}_loop",), priority=priorities[name]))
        processes.append(Proc(name, tuple(body), stimuli=(f"{name}_loop",), priority=priorities[name]))
    runnables += [Runnable(name=name, callback=True, activities=(_execute(span),)) for name, span in costs.items()]
    preempting = []
    for number in range(random.choice((0, 0, 0, 1, 2))):
        period = random.choice((2, 7, 10, 100)) * 1000
        span = _span(random, (100, 500, 1500 if period > 2000 else 300), varying)
        offset = random.randint(0, period)
        # One of equal priority runs when an executor is suspended, with all of its jobs that wait.
        priority = random.choice((8 + number, 8 + number, 5))
        preempting.append((priority, period * US, offset * US, span[0] * US, span[1] * US))
        task = {"activation_limit": 1000}
        processes.append(Proc(f"P{number}", (_execute(span),), period=period, offset=offset, priority=priority, task=task))
    found = system(*processes, runnables=tuple(runnables))
    found = replace(found, executors=tuple(models), stimuli=Stimuli(stimuli=(*found.stimuli.stimuli, *stimuli)))
    scaled = {name: (low * US, most * US) for name, (low, most) in costs.items()}
    return Application(
        found,
        scaled,
        {name: (low * US, most * US) for name, (low, most) in spins.items()},
        sending,
        delays,
        preempting,
        priorities,
    )


def violations(played, results):
    """What was seen and must not be, in words."""
    found = []
    for one, result in zip(played, results, strict=True):
        for loop in one.seen.loops:
            if result.reason and result.loop.most is None:
                break
            if loop < result.loop.least or (result.loop.most is not None and loop > result.loop.most):
                found.append(f"{result.name}: loop {loop} not in {result.loop}")
                break
        longest = max(one.seen.rounds, default=0)
        if result.round.most is not None and longest > result.round.most:
            found.append(f"{result.name}: round {longest} > {result.round.most}")
        for entity, handle in zip(one.entities, result.handles, strict=True):
            found += _of_handle(entity.seen, handle)
    return found


def _of_handle(seen, handle):
    found, name, response = [], handle.name, handle.response
    worst, best = max(seen.responses, default=0), min(seen.responses, default=None)
    if response.worst is not None and worst > response.worst:
        found.append(f"{name}: response {worst} > {response.worst}")
    if best is not None and best < response.best:
        found.append(f"{name}: response {best} < best {response.best}")
    if response.worst is not None and max(seen.waiting, default=0) > response.worst:
        found.append(f"{name}: waits {max(seen.waiting)} > {response.worst}")
    if handle.lateness is not None:
        if handle.lateness.most is not None and max(seen.lateness, default=0) > handle.lateness.most:
            found.append(f"{name}: lateness {max(seen.lateness)} > {handle.lateness.most}")
        if min(seen.lateness, default=handle.lateness.least) < handle.lateness.least:
            found.append(f"{name}: lateness {min(seen.lateness)} < {handle.lateness.least}")
    if handle.terms and (
        sum(term.most for term in handle.terms) != response.worst or min(term.most for term in handle.terms) <= 0
    ):
        found.append(f"{name}: terms are not positive, or do not add up to {response.worst}")
    if seen.lost:
        if handle.lost is None and not response.reason:
            found.append(f"{name}: lost {max(seen.lost)} untold")
        elif handle.lost is not None and handle.lost.most is not None and max(seen.lost) > handle.lost.most:
            found.append(f"{name}: lost {max(seen.lost)} in one go > {handle.lost.most}")
    return found
