"""Whose jobs make up the interference in a worst-case response time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from amalthea_uros.analyze.response_times import schedule
from amalthea_uros.analyze.response_times.core import released_on
from amalthea_uros.analyze.response_times.task import Claim, Response
from amalthea_uros.analyze.system import prepare, respond
from amalthea_uros.perf.system import System
from amalthea_uros.timing.context import Known
from amalthea_uros.timing.multiframe import Cost
from amalthea_uros.timing.scheduling import Placed
from amalthea_uros.timing.settings import Settings
from amalthea_uros.units import Time


@dataclass(frozen=True, slots=True)
class Share:
    """The part of one process in the interference: how many of its jobs, and how much time, in picoseconds."""

    name: str
    jobs: int
    time: Time


def shares(system: System, settings: Settings, name: str) -> list[Share]:
    """The parts of all processes, the greatest first; nothing where they are not known one by one."""
    known = prepare(system, settings)
    response = respond(known).get(name)
    placed = known.placed.get(name)
    if response is None or response.worst is None or placed is None:
        return []
    found = _in_schedule(known, placed) if response.claim is Claim.EXACT else _in_window(known, placed, response)
    return sorted(found, key=lambda share: -share.time)


def _in_schedule(known: Known, placed: Placed) -> list[Share]:
    """What others execute between the release and the end of the worst job."""
    tasks = released_on(placed.core, known)
    until = schedule.settled(tasks) + 2 * schedule.hyperperiod(tasks)
    jobs = schedule.schedule(tasks, until, Cost.worst_of, [True] * len(tasks))
    own = jobs[[task.name for task in tasks].index(placed.name)]
    worst = int((own.ends - own.releases).argmax())
    begin, end = own.releases[worst], own.ends[worst]
    grains = known.demands.grains(placed.core)
    found = []
    for task, each in zip(tasks, jobs, strict=True):
        inside = np.minimum(each.pieces[:, 2], end) - np.maximum(each.pieces[:, 1], begin)
        if task.name != placed.name and (inside > 0).any():
            count = len(set(each.pieces[inside > 0, 0].tolist()))
            found.append(Share(task.name, count, int(inside[inside > 0].sum()) // grains))
    return found


def _in_window(known: Known, placed: Placed, response: Response) -> list[Share]:
    """What arrives of higher priorities in the busy window, if that is all that there is."""
    grains = known.demands.grains(placed.core)
    above = [other for other in known.on_core(placed.core) if other.name != placed.name and other.rank >= placed.rank]
    found = []
    for other in above:
        if other.server != placed.server or other.name not in known.arrivals:
            return []
        count = known.arrivals[other.name].most(response.window)
        found.append(Share(other.name, count, known.costs[other.name].most(count) // grains))
    return found if _adds_up(found, response) else []


def _adds_up(found: Sequence[Share], response: Response) -> bool:
    """Whether the shares are the interference, but for a rounded picosecond each."""
    return abs(sum(share.time for share in found) - response.terms.get("interference", 0)) <= len(found) + 1
