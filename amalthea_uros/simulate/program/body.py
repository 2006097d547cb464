"""The programs of processes, activity by activity."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from enum import StrEnum
from fractions import Fraction

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.activities import AccessKind, Activity, Call, Communication, Count, Demand, Trigger
from amalthea_uros.perf.conditions import Condition
from amalthea_uros.perf.events import Event
from amalthea_uros.perf.os import Scheduler
from amalthea_uros.perf.software import Isr, Preemption, Process
from amalthea_uros.perf.stimuli import Counter
from amalthea_uros.simulate.kernel import layout
from amalthea_uros.simulate.program.activities import compile_activity
from amalthea_uros.simulate.program.executors import IterationCompiler, add_activities
from amalthea_uros.simulate.program.host_programs import add_thread
from amalthea_uros.simulate.program.image import Code, JumpLabel, Operation, ProgramHooks
from amalthea_uros.simulate.program.resources import Resources
from amalthea_uros.simulate.program.watches import EventSource
from amalthea_uros.simulate.program.wire_programs import add_end, add_start
from amalthea_uros.simulate.sampling.streams import ValueStream
from amalthea_uros.timing.basics.settings import MemoryModel
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.demand.multiframe import DemandFrame
from amalthea_uros.timing.jobs.counters import flaw_of_activity, reached

#: A program with more operations is not built.
MAX_OPERATIONS = 1_000_000


@dataclass(slots=True)
class Body:
    """The program of one process while it is made.

    Attributes
    ----------
    resources : what the programs of all processes refer to
    process : None for the decision of a scheduler
    in_group : whether it belongs to a group of tasks, which are preempted at schedule points only
    end : where a job goes that terminates itself
    number : of the activity, as in `timing.dataflow.positions`
    above : the runnables that are being called, outermost first
    masks : of groups that cannot be interrupted, around the activity
    executions : the records of executions of runnables that are measured
    iteration : of an executor, if the process executes one in each job
    part : of a message that is acknowledged, the number of the last one that is complete
    """

    resources: Resources
    process: Process | None
    core: str
    hooks: ProgramHooks
    in_group: bool
    code: Code = field(default_factory=Code)
    end: JumpLabel = field(default_factory=JumpLabel)
    number: int = 0
    above: tuple[str, ...] = ()
    masks: int = 0
    executions: dict[str, int] = field(default_factory=dict)
    iteration: IterationCompiler | None = None
    part: int = -1
    _places: dict[int, int] = field(default_factory=dict)

    @property
    def context(self) -> TimingContext:
        """What the system means in time."""
        return self.resources.context

    def place(self) -> str:
        """What draws values here, and nowhere else: the random numbers of a place depend neither on others nor on a trace."""
        name = self.process.name if self.process is not None else f"decision on {self.core}"
        self._places[self.number] = self._places.get(self.number, 0) + 1
        return f"{name} activity {self.number} {self._places[self.number]}"

    # Activities.

    def require_limited(self, activities: tuple[Activity, ...]) -> None:
        """Refuse activities that are too many with all that they call, before they are expanded."""
        if reached(activities, self.context.demand_model.sites.sizes) > MAX_OPERATIONS:
            raise _too_many_activities()

    def activities(self, activities: Sequence[Activity]) -> None:
        """Append activities; they are numbered as in `timing.dataflow.positions`."""
        for activity in activities:
            self.number += 1
            if len(self.code.operations) > MAX_OPERATIONS:
                raise _too_many_activities()
            self._numbered(activity, self.number)

    def _numbered(self, activity: Activity, number: int) -> None:
        # Only the service of the operating system knows whether an occurrence counts.
        is_counted = getattr(activity, "counter", None) is not None
        if is_counted:
            self._services(activity)
        if isinstance(activity, Trigger) and flaw_of_activity(activity):
            # Only of what it activates it is unknown what happens, which is left out.
            return
        skips = self._skips(activity)
        if isinstance(activity, Call):
            # Its hooks are within its repetitions.
            compile_activity(self, activity)
            self._return()
        else:
            self.add_all(self.hooks.before.get(number, ()))
            if not is_counted:
                self._services(activity)
            compile_activity(self, activity)
            self.add_all(self.hooks.after.get(number, ()))
        for label in skips:
            self.mark(label)

    def _services(self, activity: Activity) -> None:
        """The time of the services of the operating system that an activity calls."""
        for demand in self.context.demand_model.overheads.of_activity(activity, self.core):
            self.demand(demand)

    def _return(self) -> None:
        """After a call, other cooperative tasks can go first."""
        if getattr(self.process, "preemption", None) is Preemption.COOPERATIVE and not self.in_group:
            self.code.add(layout.POINT)

    def _skips(self, activity: Activity) -> list[JumpLabel | None]:
        """Labels to which a job goes if an activity does not take effect: then it is no event of a chain, either."""
        labels = [self._counted(activity, getattr(activity, "counter", None))]
        if isinstance(activity, Call) and activity.times is None:
            runnable = self.context.system.runnables.get(activity.runnable)
            labels.append(None if runnable is None else self.tested(runnable.condition))
        return labels

    def _counted(self, owner: Activity, counter: Counter | None) -> JumpLabel | None:
        """A label to which a job goes if a counter does not let this time take effect."""
        name = self.process.name if self.process is not None else ""
        queue = (
            self.resources.queues.get((name, counter.source)) if counter is not None and counter.arrivals is not None else None
        )
        if flaw := flaw_of_activity(owner):
            raise UnknownError(flaw)
        place = queue or self.resources.counter(owner, counter)
        if not place:
            return None
        label = JumpLabel()
        self.code.add(layout.TEST_MESSAGE if queue else layout.COUNT, place, label)
        return label

    # Time.

    def execute(self, stream: ValueStream) -> None:
        """Hold the core for times of a stream."""
        only = stream.constant
        if only is None:
            self.code.add(layout.DRAW, self.resources.stream(stream))
        elif only > 0:
            self.code.add(layout.EXECUTE, only)

    def demand(self, demand: Demand | None) -> None:
        """Hold the core for a demand."""
        if demand is not None:
            ticks = self.context.demand_model.ticks(demand, self.core)
            self.execute(self.resources.ticks(ticks, self.core, Fraction(1), self.place()))

    def frame(self, frame: DemandFrame) -> None:
        """Hold the core for the demand of a frame."""
        self.execute(self.resources.frame(frame, self.core, self.place()))

    def access(self, name: str, kind: AccessKind, times: Count | float | None) -> None:
        """Hold the core for the time of accesses to memory, if they take any."""
        model = self.context.demand_model
        if model.settings.memory is not MemoryModel.NONE:
            self.frame(model.access(self.core, name, kind, times))

    # Places in the program, and what is added to them.

    def add_all(self, operations: Iterable[Operation]) -> None:
        """Append operations."""
        for operation in operations:
            self.code.add(*operation)

    def mark(self, label: JumpLabel | None) -> None:
        """Have a label, if there is one, mean the next operation."""
        if label is not None:
            self.code.mark(label)

    def tested(self, condition: Condition | None) -> JumpLabel | None:
        """A label to which a job goes if a condition is false."""
        if condition is None:
            return None
        label = JumpLabel()
        self.code.add(layout.TEST, self.resources.modes.condition(condition), label)
        return label

    def observe(
        self, kind: type[Event], name: str, change: StrEnum | None = None, communication: Communication | None = None
    ) -> None:
        """Report that an event has occurred here, if it is watched."""
        if self.process is not None:
            source = EventSource(kind, name, change, self.above[-1] if self.above else None, self.process.name, communication)
            number = self.resources.watches.number(source)
            if number is not None:
                self.code.add(layout.OBSERVE, number)


def _too_many_activities() -> UnknownError:
    return UnknownError(f"it executes more than {MAX_OPERATIONS:,} activities")


# Programs of processes.


def process_code(
    resources: Resources, process: Process, core: str, hooks: ProgramHooks, scheduler: Scheduler | None, in_group: bool
) -> Code:
    """The program of a process.

    Parameters
    ----------
    scheduler : whose decision at the end of jobs takes time
    in_group : whether it belongs to a group of tasks, which are preempted at schedule points only

    Raises
    ------
    UnknownError : something in it cannot be simulated.
    """
    return _process_code(Body(resources, process, core, hooks, in_group), process, scheduler)


def _process_code(body: Body, process: Process, scheduler: Scheduler | None) -> Code:
    model = body.context.demand_model
    body.require_limited(process.activities)
    entry, exit_ = model.overheads.of_isr(process, body.core) if isinstance(process, Isr) else (None, None)
    copies = model.copies(process, body.core) if model.settings.memory is MemoryModel.IMPLICIT else []
    add_start(body, process)
    body.demand(entry)
    for kind, frame in copies:
        if kind is AccessKind.READ:
            body.frame(frame)
    if (executor := body.resources.executors.messages.host.executor_of(process.name)) is not None:
        add_thread(body, process, executor)
    else:
        add_activities(body, process)
    body.code.mark(body.end)
    for kind, frame in copies:
        if kind is AccessKind.WRITE:
            body.frame(frame)
    body.demand(exit_)
    if scheduler is not None:
        body.number = 0
        for activity in scheduler.overhead:
            compile_activity(body, activity)
    add_end(body, process)
    body.code.add(layout.END)
    return body.code
