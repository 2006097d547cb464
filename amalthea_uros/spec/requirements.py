"""Requirements: event chains with limits on their latency, and limits on processes."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from amalthea_uros.spec.fields import Limits, entry, examines
from amalthea_uros.spec.section import DescriptionSection, Shorthand
from amalthea_uros.spec.values import Count, Duration, Name, described, problem

Moment = Annotated[
    Literal["activation", "start", "finish"],
    described(
        activation="A job is activated.",
        start="A job starts to execute.",
        finish="A job ends.",
    ),
]


class LimitsSection(Shorthand):
    """A maximum, or a mapping with minimum and maximum."""

    shorthand = ("max",)
    plain_value = "Maximum that is allowed."

    min: Duration | None = None
    """Minimum that is allowed."""
    max: Duration | None = None
    """Maximum that is allowed."""

    @examines
    def _is_something(self) -> Self:
        if self.min is None and self.max is None:
            raise problem("neither 'max' nor 'min' is given")
        if self.min is not None and self.max is not None and self.min > self.max:
            raise problem("'min' is greater than 'max'")
        return self


class ChainJitter(Shorthand):
    """A limit on the jitter of a chain, maximum minus minimum: of its reaction, or a mapping that names the latency."""

    shorthand = ("max",)
    plain_value = "Maximum of the jitter of the reaction."

    of: Annotated[
        Literal["reaction", "age"],
        described(reaction="Of what `reaction` limits.", age="Of what `age` limits."),
    ] = "reaction"
    """Latency whose jitter is limited."""
    max: Duration
    """Maximum that is allowed."""


class Chain(DescriptionSection):
    """A cause-effect chain: a `path`, a `sequence` of chains, or `parallel` paths."""

    name: Name
    """Name of the chain."""
    path: list[Name] | None = entry(None, min_length=1)
    """Topics, executor, callbacks, tasks, interrupt service routines and functions, with labels after those that write
    them, from cause to effect."""
    sequence: list[Name] | None = entry(None, min_length=1)
    """Chains that follow each other; each starts with the last event of the previous one."""
    parallel: list[Annotated[list[Name], Limits(min_length=1)]] | None = entry(None, min_length=2)
    """Paths from the same start to the same end."""
    completed: Count = 1
    """Number of parallel paths that must complete: 1 for alternatives, all of them for a join."""
    start: Moment = entry("start", alias="from")
    """Event of the first member that starts the chain."""
    end: Moment = entry("finish", alias="to")
    """Event of the last member that ends the chain."""
    reaction: LimitsSection | None = None
    """Limits on the reaction: from the start event to the end of the first job whose output is based on it."""
    age: LimitsSection | None = None
    """Limits on the data age: from the start event on which an output is based to that output."""
    jitter: ChainJitter | None = None
    """Limit on the jitter: the maximum minus the minimum of the reaction, or of the age."""

    @examines
    def _is_one_of_three(self) -> Self:
        stated = [key for key in ("path", "sequence", "parallel") if getattr(self, key) is not None]
        if len(stated) != 1:
            raise problem(
                f"a chain needs exactly one of 'path', 'sequence' and 'parallel', found {' and '.join(map(repr, stated)) or 'none'}"
            )
        return self


_JITTERS = described(
    response_time="Maximum minus minimum of the response time.",
    start_delay="Maximum minus minimum of the time from activation to start.",
    net_execution_time="Maximum minus minimum of the time that a job executes, without preemption.",
    gross_execution_time="Maximum minus minimum of the time from start to end.",
    start_to_start="Largest deviation of the time between two starts from the period.",
    end_to_end="Largest deviation of the time between two ends from the period.",
)


class Jitter(Shorthand):
    """A limit on a jitter: of the response time, or a mapping that names the time."""

    shorthand = ("max",)
    plain_value = "Maximum of the jitter of the response time: of its maximum minus its minimum."

    of: Annotated[
        Literal["response_time", "start_delay", "net_execution_time", "gross_execution_time", "start_to_start", "end_to_end"],
        _JITTERS,
    ] = "response_time"
    """Time whose jitter is limited."""
    max: Duration
    """Maximum that is allowed."""


class RequirementSection(DescriptionSection):
    """Limits that every job of a process must meet."""

    process: Name
    """Executor, callback, task, interrupt service routine or function."""
    name: Name | None = None
    """Name of the requirement; default: made from the process and the limited quantity."""
    severity: Literal["cosmetic", "minor", "major", "critical"] | None = None
    """Severity of a violation."""
    response_time: LimitsSection | None = None
    """Limits on the time from activation to end."""
    net_execution_time: LimitsSection | None = None
    """Limits on the time that a job executes, without preemption."""
    gross_execution_time: LimitsSection | None = None
    """Limits on the time from start to end, including preemption."""
    start_delay: LimitsSection | None = None
    """Limits on the time from activation to start."""
    start_to_start: LimitsSection | None = None
    """Limits on the time from one start to the next."""
    end_to_end: LimitsSection | None = None
    """Limits on the time from one end to the next."""
    jitter: Jitter | None = None
    """Limit on the jitter of the response time, or of another time."""

    @examines
    def _is_something(self) -> Self:
        if not any(isinstance(getattr(self, key), LimitsSection | Jitter) for key in type(self).model_fields):
            raise problem("the requirement has no limit; add one, e.g. response_time: 1 ms")
        return self
