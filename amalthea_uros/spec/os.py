"""The operating system: what it costs to activate and end tasks and interrupt service routines."""

from __future__ import annotations

from typing import Annotated, Any, Literal, Self

from amalthea_uros.spec.execution_time import ExecutionTimeSection
from amalthea_uros.spec.fields import Examples, entry, examines
from amalthea_uros.spec.section import DescriptionSection, Shorthand
from amalthea_uros.spec.values import CountOrNone, Duration, Name, OffsetOrNumberZero, PriorityNumber, described, problem


class OverheadTime(ExecutionTimeSection):
    """A time that the operating system needs: as an execution time, which can also be zero."""

    min: OffsetOrNumberZero | None = None
    """Best-case time."""
    avg: OffsetOrNumberZero | None = None
    """Mean time."""
    max: OffsetOrNumberZero | None = None
    """Worst-case time."""


class OverheadSection(Shorthand):
    """What the operating system adds to each job: a time, or a mapping with the parts before and after what the job does itself."""

    shorthand = ("activation",)
    plain_value = "All of it, before the first function of the job; `0` for none."
    nested = OverheadTime

    activation: OverheadTime | None = None
    """Time before the first function of the job."""
    termination: OverheadTime | None = None
    """Time after the last function of the job."""

    @classmethod
    def _of_plain_value(cls, value: Any) -> Any:
        return value if cls._is_whole(value) else {"activation": value, "termination": 0}


_LEVELS = described(
    task="In the task itself, at its priority: it delays no task of higher priority.",
    interrupt="In an interrupt at the time of the activation: it delays all tasks.",
)


class OsOverhead(DescriptionSection):
    """Overhead of all tasks and interrupt service routines that state no other one."""

    activation: OverheadTime | None = None
    """Time per activation of a task, before its first function."""
    termination: OverheadTime | None = None
    """Time per job of a task, after its last function."""
    activations_run_in: Annotated[Literal["task", "interrupt"], _LEVELS] = "task"
    """Where the work for the activation of a task is executed."""
    isr: OverheadSection = entry(default_factory=OverheadSection.model_construct)
    """Time per execution of an interrupt service routine."""


_STACKS = described(per_task="Each task has its own.", shared="All tasks of a core share one.")
_DIRECTIONS = described(
    higher_is_more_urgent="The highest number is the most urgent priority: FreeRTOS, NuttX, OSEK, POSIX.",
    lower_is_more_urgent="The lowest number is the most urgent priority: Zephyr.",
)


class PriorityRange(DescriptionSection):
    """The numbers that priorities of tasks can have."""

    lowest: PriorityNumber
    """Lowest number."""
    highest: PriorityNumber
    """Highest number."""

    @examines
    def _is_ordered(self) -> Self:
        if self.lowest > self.highest:
            raise problem("'lowest' is greater than 'highest'")
        return self


class SleepTicks(DescriptionSection):
    """How exactly a task sleeps: the time is rounded up to ticks, and the sleep ends at a tick before or after that."""

    early: CountOrNone = 0
    """Number of ticks by which a sleep can be shorter than the ticks it is rounded up to."""
    late: CountOrNone = 0
    """Number of ticks by which a sleep can be longer than the ticks it is rounded up to."""


class OsSection(DescriptionSection):
    """The operating system."""

    rtos: Annotated[Name, Examples(["freertos", "zephyr", "nuttx", "bare-metal", "osek", "posix-fifo", "posix-rr"])] | None = (
        None
    )
    """The operating system by name, or a file that describes it; default: that of the platform."""
    tick: Duration | None = None
    """Its tick, in which delays and timeouts are counted; default: that of the operating system."""
    stack: Annotated[Literal["per-task", "shared"], _STACKS] | None = None
    """Whether tasks have stacks of their own; default: that of the operating system."""
    priorities: Annotated[Literal["higher-is-more-urgent", "lower-is-more-urgent"], _DIRECTIONS] | None = None
    """What priorities in this file mean; default: that of the operating system, else `higher-is-more-urgent`."""
    priority_range: PriorityRange | None = None
    """Numbers that priorities of tasks can have; default: those of the operating system."""
    time_slice: OffsetOrNumberZero | None = None
    """Time after which ready tasks of the same priority take turns; `0`: they do not; default: that of the operating system."""
    sleep_ticks: SleepTicks | None = None
    """How exactly a task sleeps; default: as the operating system does; without a tick, exactly as long as asked."""
    overhead: OsOverhead = entry(default_factory=OsOverhead.model_construct)
    """What it costs to activate and end tasks and interrupt service routines; default: nothing."""

    @property
    def title(self) -> str:
        """How messages name it."""
        return "the operating system" if self.rtos is None else repr(self.rtos)
