"""A player of periodic tasks on cores, unit of time by unit of time, which knows nothing of the product."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field


@dataclass(frozen=True)
class UnitTask:
    """A task with known releases; the one of the lowest rank is served first.

    Attributes
    ----------
    demand : of each job, or by its number, counted from 1
    deadline : of the jobs of one rank, the one whose deadline is the earliest is served first
    """

    period: int
    demand: int | Callable[[int], int]
    offset: int = 0
    rank: int = 0
    core: str = ""
    is_preemptive: bool = True
    deadline: int = 0


@dataclass(eq=False)
class Job:
    """A job of a task.

    Attributes
    ----------
    reached : when each of its units was executed
    """

    task: int
    number: int
    release: int
    demand: int
    reached: list[int] = field(default_factory=list)

    @property
    def left(self) -> int:
        return self.demand - len(self.reached)

    @property
    def start(self) -> int:
        return self.reached[0] - 1

    @property
    def end(self) -> int:
        return self.reached[-1]

    @property
    def response(self) -> int:
        return self.end - self.release


def play(tasks: Sequence[UnitTask], until: int, *, to_the_end: bool = False) -> list[list[Job]]:
    """The jobs of each task that are released before a time; with some later ones, if all of them are executed to the end."""
    jobs: list[list[Job]] = [[] for _ in tasks]
    pending: list[Job] = []
    running: dict[str, Job] = {}
    now = 0
    while now < until or (to_the_end and any(job.release < until for job in pending)):
        for index, task in enumerate(tasks):
            if now >= task.offset and (now - task.offset) % task.period == 0:
                number = len(jobs[index]) + 1
                job = Job(index, number, now, task.demand if isinstance(task.demand, int) else task.demand(number))
                jobs[index].append(job)
                pending.append(job)
        now += 1
        for core in {tasks[job.task].core for job in pending}:
            current = running.get(core)
            if current is None or not current.left or tasks[current.task].is_preemptive:
                here = [job for job in pending if tasks[job.task].core == core]
                current = running[core] = min(
                    here, key=lambda job: (tasks[job.task].rank, job.release + tasks[job.task].deadline)
                )
            current.reached.append(now)
            if not current.left:
                pending.remove(current)
    return jobs


def longest_responses(tasks: Sequence[UnitTask], until: int) -> list[int]:
    """The longest response time of the jobs of each task that end before a time."""
    return [max((job.response for job in own if not job.left), default=0) for own in play(tasks, until)]
