"""Event chains of a model, and their latencies in a play, after Guenzel, Chen, Ueter, Chen (ECRTS 2023).

A stimulus is answered by the first response at or after it that is based on it or on a newer one. A stimulus without a response up to
the end of the play has waited at least until then.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise, product
from typing import Any
from xml.etree import ElementTree

from opponent.models.player import Job, Player
from opponent.models.reading import Played, kind_of, reference
from opponent.models.variants import items_of_process

#: A process and what happens to its job: activate, start, terminate; or that and the name of a runnable, or of the label it accesses.
Event = tuple[str, str]
#: Jobs and the times at which they do something.
Times = list[tuple[int, int]]


@dataclass(frozen=True, slots=True)
class Chain:
    """A chain of processes from an event to another one; between two of them is one of several links, a label or a trigger ("").

    Attributes
    ----------
    branches : chains between the same events that are parallel, instead of processes
    completed : how many of them have to lead to a response
    is_whole : whether no data lead from one of its processes to the next one but those of the links
    """

    name: str
    stimulus: str
    response: str
    processes: tuple[str, ...]
    links: tuple[tuple[str, ...], ...]
    branches: tuple[Chain, ...] = ()
    completed: int = 1
    is_whole: bool = True


#: One link for each step, of each branch.
Reading = tuple[Any, ...]


def events_of(root: ElementTree.Element) -> dict[str, Event]:
    """The events of processes, and those of runnables and labels in a process."""
    found: dict[str, Event] = {}
    for e in root.iter("events"):
        name, entity, change = e.get("name", ""), reference(e.get("entity")), e.get("eventType", "")
        if kind_of(e) == "ProcessEvent" and change in ("activate", "start", "terminate"):
            found[name] = (entity, change)
        elif kind_of(e) in ("RunnableEvent", "LabelEvent") and e.get("process") and not e.get("runnable"):
            found[name] = (reference(e.get("process")), f"{change} {entity}")
    return found


def chains_of(text: str | bytes, played: Played) -> Iterator[Chain]:
    """The chains of which every step is understood."""
    root = ElementTree.fromstring(text)
    events = events_of(root)
    chains = {chain.get("name", ""): chain for chain in root.iter("eventChains")}
    for name, chain in chains.items():
        if chain.get("itemType") == "parallel":
            found = [
                _chain_of(_events_of_chain(part, chains), name, events, played) for part in chain.iterfind("items/eventChain")
            ]
            branches = tuple(branch for branch in found if branch is not None)
            if len(branches) == len(found) > 1:
                completed = int(chain.get("minItemsCompleted", "1"))
                is_whole = all(branch.is_whole for branch in branches)
                yield Chain(name, branches[0].stimulus, branches[0].response, (), (), branches, completed, is_whole)
        elif single := _chain_of(_events_of_chain(chain, chains), name, events, played):
            yield single


def _chain_of(names: list[str], name: str, events: dict[str, Event], played: Played) -> Chain | None:
    """The chain of some events, if every step is understood."""
    steps = [events[each] for each in names if each in events]
    if not names or len(steps) != len(names) or any(map(_is_against_order, steps, steps[1:])):
        return None
    processes = [steps[0][0]]
    processes += [b[0] for a, b in pairwise(steps) if a[0] != b[0]]
    links = tuple(tuple(_links_of_step(played, a, b)) for a, b in pairwise(steps) if a[0] != b[0])
    is_whole = all(_shared(played, a, b) <= set(found) for (a, b), found in zip(pairwise(processes), links, strict=True))
    return Chain(name, steps[0][1], steps[-1][1], tuple(processes), links, is_whole=is_whole) if links and all(links) else None


def _is_against_order(first: Event, then: Event) -> bool:
    """Whether two events of a process are stated against their order in a job, so that it is open which job the second one is of."""
    order = {"activate": 0, "start": 1, "terminate": 3}
    return first[0] == then[0] and order.get(then[1], 2) < order.get(first[1], 2)


def _events_of_chain(chain: ElementTree.Element, chains: dict[str, ElementTree.Element]) -> list[str]:
    """The events of a chain in order, of chains that it refers to, too; none if parts are parallel."""
    items = chain.findall("items")
    if chain.get("itemType") == "parallel":
        return []
    names = [reference(chain.get("stimulus"))]
    for item in items:
        part = chains.get(reference(item.get("eventChain"))) if item.get("eventChain") else item.find("eventChain")
        inner = [] if part is None else _events_of_chain(part, chains)
        if not inner:
            return []
        names += inner[1:]
    return names if items else [*names, reference(chain.get("response"))]


def _links_of_step(played: Played, first: Event, then: Event) -> Iterator[str]:
    """What leads from an event to one of another process: if both access the same data, that."""
    written, read = first[1].partition(" "), then[1].partition(" ")
    if (written[0], read[0]) == ("write", "read") and written[2] == read[2]:
        yield written[2]
    else:
        yield from _links(played, first[0], then[0])


def _links(played: Played, source: str, target: str) -> Iterator[str]:
    """What leads from a process to another one; nothing if it is not clear."""
    accesses = {process.name: _accesses(played, process.name) for process in played.processes}
    for name in sorted(_named("write", accesses[source]) & _named("read", accesses[target])):
        writers = [process for process, found in accesses.items() if ("write", name) in found]
        if writers == [source]:
            yield name
    stimuli = {item[1] for item in items_of_process(played, source) if item[0] == "trigger"}
    events = {item[1] for item in items_of_process(played, source) if item[0] == "event"}
    stimuli |= {stimulus for event in events for stimulus in played.listeners.get(event, ())}
    of_target = next(process.stimuli for process in played.processes if process.name == target)
    if stimuli & set(of_target):
        yield ""


def _shared(played: Played, source: str, target: str) -> set[str]:
    """The data that one process writes and another one reads, or compares with something, whoever writes them, too."""
    items = items_of_process(played, target)
    compared = {
        each.name
        for item in items
        if item[0] == "switch"
        for condition, _ in item[1]
        for all_of in condition
        for each in all_of
    }
    return _named("write", _accesses(played, source)) & (_named("read", _accesses(played, target)) | compared)


def _named(kind: str, accesses: set[tuple[str, str]]) -> set[str]:
    return {name for each, name in accesses if each == kind}


def _accesses(played: Played, process: str) -> set[tuple[str, str]]:
    items = list(items_of_process(played, process))
    of_modes = {("read" if item[2] == "read" else "write", str(item[1])) for item in items if item[0] == "mode"}
    return of_modes | {(str(item[0]), str(item[1])) for item in items if item[0] in ("read", "write")}


def readings(chain: Chain) -> Iterator[Reading]:
    """One link for each step."""
    yield from product(*map(readings, chain.branches)) if chain.branches else product(*chain.links)


def latencies(played: Played, play: Player, chain: Chain, links: Reading, until: int) -> Iterator[tuple[str, int]]:
    """All values of each quantity, over one link a step; none if it is not clear which data a job is based on."""
    if chain.branches:
        yield from _reactions(answers(played, play, chain, links), _known(played, play, chain, until))
        return
    found = _found(played, play, chain, links)
    if found is None:
        return
    hops, stimuli, responses = found
    yield from _reactions(list(_answers(hops, stimuli, responses)), _known(played, play, chain, until))
    yield from _backward(hops, stimuli, responses)


def _known(played: Played, play: Player, chain: Chain, until: int) -> int:
    """Up to when all responses are known: of a job that has not ended, it is not known yet what it reads."""
    if chain.branches:
        return min(_known(played, play, branch, until) for branch in chain.branches)
    last = next(n for n, process in enumerate(played.processes) if process.name == chain.processes[-1])
    open_jobs = (_time(job, chain.response) for job in play.jobs[last] if job.end is None)
    return min([until, *(time for time in open_jobs if time is not None)])


def answers(played: Played, play: Player, chain: Chain, links: Reading) -> list[tuple[int, int | None]]:
    """Each stimulus with its first response, if there was one; nothing if it is not clear which data a job is based on."""
    if chain.branches:
        each = [answers(played, play, branch, own) for branch, own in zip(chain.branches, links, strict=True)]
        if not all(each):
            return []
        return [(group[0][0], _completed([end for _, end in group], chain.completed)) for group in zip(*each, strict=True)]
    found = _found(played, play, chain, links)
    return [] if found is None else list(_answers(*found))


def _found(played: Played, play: Player, chain: Chain, links: Reading) -> tuple[list[_Hop], list[int], list[int]] | None:
    """The hops, stimuli and responses of a chain without branches; None if it is not clear which data a job is based on."""
    index = {process.name: number for number, process in enumerate(played.processes)}
    stages = [play.jobs[index[name]] for name in chain.processes]
    hops = [
        _Hop.of(*pair, link, index[name]) for pair, link, name in zip(pairwise(stages), links, chain.processes, strict=False)
    ]
    if not all(hop.is_clear for hop in hops) or not _is_clear(stages, hops, chain):
        return None
    if not all(
        _writes_after(jobs, ("read", label), then) for jobs, (label, then) in zip(stages[1:], pairwise(links), strict=False)
    ):
        return None
    if " " in chain.stimulus and not _writes_after(stages[0], tuple(chain.stimulus.split(" ", 1)), links[0]):
        return None
    response = tuple(chain.response.split(" ", 1))
    if " " in chain.response and not all(_is_in_order(job, ("read", links[-1]), response) for job in stages[-1]):
        return None
    # Only jobs that write take part: that others do not is documented.
    if not hops[0].is_trigger and len(hops[0].writes) < sum(job.end is not None for job in stages[0]):
        return None
    stimuli = [time for job in stages[0] if (time := _time(job, chain.stimulus)) is not None]
    responses = [time for job in stages[-1] if (time := _time(job, chain.response)) is not None]
    return hops, stimuli, responses


def _writes_after(jobs: list[Job], event: tuple[str, ...], label: str) -> bool:
    """Whether no job writes a label explicitly before an event on which that is to be based, also at the same instant."""
    explicit = [job for job in jobs if label not in (*job.copies, *job.timed)]
    return all(_is_in_order(job, event, ("write", label)) for job in explicit)


def _is_in_order(job: Job, first: tuple[str, ...], then: tuple[str, ...]) -> bool:
    """Whether one thing that a job does comes before another one; true if it does not do both."""
    places: dict[tuple[str, ...], int] = {(mark.change, mark.name): number for number, mark in enumerate(job.marks)}
    return first not in places or then not in places or places[first] <= places[then]


def _is_clear(stages: list[list[Job]], hops: list[_Hop], chain: Chain) -> bool:
    """Whether each job has its event once, before it writes and after it has read."""
    for jobs, change, accesses, is_late in (
        (stages[0], chain.stimulus, hops[0].writes, True),
        (stages[-1], chain.response, hops[-1].reads, False),
    ):
        if " " not in change:
            continue
        times = {job.number: _time(job, change) for job in jobs}
        if any(times[job.number] is None for job in jobs if job.end is not None):
            return False
        if not hops[0 if is_late else -1].is_trigger:
            for time, number in accesses:
                own = times[number]
                if own is not None and (own > time if is_late else own < time):
                    return False
        elif is_late:
            return False
    return True


def _answers(hops: list[_Hop], stimuli: list[int], responses: list[int]) -> Iterator[tuple[int, int | None]]:
    for number, stimulus in enumerate(stimuli):
        reached: int | None = number
        for hop in hops:
            reached = None if reached is None else hop.after(reached)
        while reached is not None and reached < len(responses) and responses[reached] < stimulus:
            reached += 1
        yield stimulus, responses[reached] if reached is not None and reached < len(responses) else None


def _completed(ends: list[int | None], number: int) -> int | None:
    """When a number of parallel parts have led to a response."""
    known = sorted(end for end in ends if end is not None)
    return known[number - 1] if len(known) >= number else None


def _reactions(found: list[tuple[int, int | None]], until: int) -> Iterator[tuple[str, int]]:
    before: int | None = None
    for stimulus, answer in found:
        if answer is None and stimulus >= until:
            return
        end = until if answer is None else answer
        yield "max_reduced_reaction_time", end - stimulus
        if before is not None:
            yield "max_reaction_time", end - before
        if answer is not None:
            yield "min_first_to_first", end - stimulus
        before = stimulus


def _backward(hops: list[_Hop], stimuli: list[int], responses: list[int]) -> Iterator[tuple[str, int]]:
    for number, response in enumerate(responses):
        source: int | None = number
        for hop in reversed(hops):
            source = None if source is None else hop.before(source)
        while source is not None and source >= 0 and (source >= len(stimuli) or stimuli[source] > response):
            source -= 1
        if source is None or source < 0:
            continue
        yield "max_reduced_data_age", response - stimuli[source]
        yield "min_last_to_last", response - stimuli[source]
        if number + 1 < len(responses):
            yield "max_data_age", responses[number + 1] - stimuli[source]


@dataclass(slots=True)
class _Hop:
    """From jobs that write to jobs that read, or from jobs that trigger to those that they activate."""

    writes: Times
    reads: Times
    is_trigger: bool
    is_clear: bool

    @classmethod
    def of(cls, source: list[Job], target: list[Job], label: str, index: int) -> _Hop:
        if not label:
            caused = [(job.cause[1], job.number) for job in target if job.cause is not None and job.cause[0] == index]
            return cls(caused, [], True, len(caused) == len(target))
        writes = [(times[-1], job.number) for job in source if (times := job.accesses.get(("write", label)))]
        reads = [(times[0], job.number) for job in target if (times := job.accesses.get(("read", label)))]
        single = all(
            len(times) == 1 for job in (*source, *target) for access, times in job.accesses.items() if access[1] == label
        )
        single &= not any(job.is_late for job in (*source, *target))
        ended = sum(job.end is not None for job in target)
        return cls(writes, reads, False, single and len(reads) >= ended)

    def after(self, number: int) -> int | None:
        """The first job that is based on a job or a later one."""
        if self.is_trigger:
            return next((target for source, target in self.writes if source >= number), None)
        write = next((time for time, job in self.writes if job >= number), None)
        if write is None:
            return None
        found = bisect_left(self.reads, (write, -1))
        return self.reads[found][1] if found < len(self.reads) else None

    def before(self, number: int) -> int | None:
        """The latest job that a job is based on."""
        if self.is_trigger:
            return next((source for source, target in self.writes if target == number), None)
        read = next((time for time, job in self.reads if job == number), None)
        if read is None:
            return None
        found = bisect_right(self.writes, (read, 10**9)) - 1
        return self.writes[found][1] if found >= 0 else None


def _time(job: Job, event: str) -> int | None:
    change, _, name = event.partition(" ")
    if not name:
        return {"activate": job.activated, "start": job.start, "terminate": job.end}[change]
    times = [mark.time for mark in job.marks if (mark.change, mark.name) == (change, name)]
    return times[0] if len(times) == 1 else None
