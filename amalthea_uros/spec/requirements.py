"""What is demanded: event chains with limits of their latency, and requirements on processes."""

from __future__ import annotations

from typing import Literal, Self

from pydantic import Field, model_validator

from amalthea_uros.spec.section import Section, Shorthand
from amalthea_uros.spec.values import Count, Duration, Name, problem

Moment = Literal["activation", "start", "finish"]


class Limits(Shorthand):
    """A greatest value, or a mapping with a least and a greatest one."""

    shorthand = ("max",)

    min: Duration | None = None
    """Least value that is allowed."""
    max: Duration | None = None
    """Greatest value that is allowed."""

    @model_validator(mode="after")
    def _is_something(self) -> Self:
        if self.min is None and self.max is None:
            raise problem("give 'max' or 'min'")
        if self.min is not None and self.max is not None and self.min > self.max:
            raise problem("'min' is greater than 'max'")
        return self


class Chain(Section):
    """A cause-effect chain: a `path`, a `sequence` of chains, or `parallel` paths."""

    name: Name
    """Name of the chain."""
    path: list[Name] | None = Field(None, min_length=1)
    """Executor, callbacks, tasks, interrupt service routines, functions, and labels between them, from cause to effect."""
    sequence: list[Name] | None = Field(None, min_length=1)
    """Chains that follow each other; each starts with the event with which the one before it ends."""
    parallel: list[list[Name]] | None = Field(None, min_length=2)
    """Paths from the same start to the same end."""
    completed: Count = 1
    """How many of the parallel paths have to complete: 1 for alternatives, all for a join."""
    start: Moment = Field("start", alias="from")
    """The moment of the first member with which the chain starts."""
    end: Moment = Field("finish", alias="to")
    """The moment of the last member with which the chain ends."""
    reaction: Limits | None = None
    """Limits of the reaction time."""
    age: Limits | None = None
    """Limits of the data age."""

    @model_validator(mode="after")
    def _is_one_of_three(self) -> Self:
        stated = [key for key in ("path", "sequence", "parallel") if getattr(self, key) is not None]
        if len(stated) != 1:
            raise problem(
                f"a chain has one of 'path', 'sequence' and 'parallel', this one has {' and '.join(stated) or 'none'}"
            )
        return self


class Requirement(Section):
    """Limits that every job of a process has to keep."""

    process: Name
    """The executor, a callback, a task, an interrupt service routine, or a function."""
    name: Name | None = None
    """Default: made from the process and what is limited."""
    severity: Literal["cosmetic", "minor", "major", "critical"] | None = None
    """How bad it is if the limit is not kept."""
    response_time: Limits | None = None
    """From activation to end."""
    net_execution_time: Limits | None = None
    """Without preemption."""
    gross_execution_time: Limits | None = None
    """From start to end, with preemption."""
    start_delay: Limits | None = None
    """From activation to start."""
    start_to_start: Limits | None = None
    """From one start to the next."""
    end_to_end: Limits | None = None
    """From one end to the next."""

    @model_validator(mode="after")
    def _is_something(self) -> Self:
        if not any(isinstance(getattr(self, key), Limits) for key in type(self).model_fields):
            raise problem("a requirement limits something, such as response_time: 1 ms")
        return self
