"""Tasks that trigger each other and wait for events, played unit of time by unit of time; it shares no code with the product."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from random import Random

CORES = (0, 1)


@dataclass(frozen=True)
class PlayedTask:
    """A task of fixed priority.

    Attributes
    ----------
    body : ("run", least, most), ("trigger", task), ("wait", event, is active), ("clear", event), ("set", event, task)
    period : 0: another task triggers it
    """

    name: str
    core: int
    priority: int
    body: tuple[tuple, ...]
    period: int = 0
    offset: int = 0


@dataclass
class PlayedJob:
    """A job that has not ended."""

    task: PlayedTask
    activated: int
    steps: list[tuple]


@dataclass
class Player:
    """The jobs of some tasks, of which each one keeps one activation at most.

    Attributes
    ----------
    found : response times of the jobs of each task
    lost : tasks that have lost activations
    """

    tasks: Sequence[PlayedTask]
    rng: Random
    found: dict[str, list[int]] = field(default_factory=dict)
    lost: set[str] = field(default_factory=set)
    pending: dict[str, PlayedJob] = field(default_factory=dict)
    events: set[tuple[str, str]] = field(default_factory=set)
    now: int = 0

    def play(self, until: int) -> Player:
        """Play up to a time; execution times are drawn, often the least or the most."""
        while self.now < until:
            for task in self.tasks:
                if task.period and self.now >= task.offset and (self.now - task.offset) % task.period == 0:
                    self._activate(task)
            self._settle()
            for job in map(self._running, CORES):
                if job is not None and job.steps[0][0] == "run":
                    job.steps[0] = ("run", job.steps[0][1] - 1)
            self.now += 1
            # What a job does once it has executed precedes what is activated at that time.
            self._settle()
        return self

    def _settle(self) -> None:
        """Do everything that takes no time, on all cores."""
        while sum(map(self._step, CORES)):
            pass

    def _activate(self, task: PlayedTask) -> None:
        if task.name in self.pending:
            self.lost.add(task.name)
            return
        steps = []
        for step in task.body:
            if step[0] == "run":
                low, high = step[1:]
                step = ("run", self.rng.choice((low, high, high, self.rng.randint(low, high))))
            steps.append(step)
        self.pending[task.name] = PlayedJob(task, self.now, steps)

    def _is_waiting(self, job: PlayedJob) -> bool:
        step = job.steps[0] if job.steps else ("end",)
        return step[0] == "wait" and (job.task.name, step[1]) not in self.events

    def _running(self, core: int) -> PlayedJob | None:
        here = [job for job in self.pending.values() if job.task.core == core]
        ready = [job for job in here if not self._is_waiting(job) or job.steps[0][2]]
        return max(ready, key=lambda job: job.task.priority, default=None)

    def _step(self, core: int) -> bool:
        """Do what takes no time; whether something was done."""
        job = self._running(core)
        if job is None or self._is_waiting(job):
            return False
        if not job.steps:
            del self.pending[job.task.name]
            self.found.setdefault(job.task.name, []).append(self.now - job.activated)
            return True
        kind, *rest = job.steps[0]
        if kind == "run" and rest[0] > 0:
            return False
        job.steps.pop(0)
        match kind:
            case "trigger":
                self._activate(next(task for task in self.tasks if task.name == rest[0]))
            case "clear":
                self.events.discard((job.task.name, rest[0]))
            case "set":
                self.events.add((rest[1], rest[0]))
        return True
