"""What a description can say otherwise about its callbacks: designs whose systems are built anew from the changed text."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from itertools import permutations

from amalthea_uros._internal.records import dataclass, fields
from amalthea_uros.design.changes.change import Change
from amalthea_uros.design.description.origin import DescriptionOrigin
from amalthea_uros.design.optimize.designs import RebuiltStructure
from amalthea_uros.design.optimize.space import Candidate, Choice, DecisionKind
from amalthea_uros.design.optimize.stated_values import Completed, Source
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.perf.system import System
from amalthea_uros.spec.executors import ExecutorSection
from amalthea_uros.uros.application.callbacks import Callback, callbacks_of, registration_order
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.described import Described, describe_text


@dataclass(frozen=True, slots=True)
class DescribedCallbacks:
    """The callbacks of a description, and how they are executed."""

    origin: DescriptionOrigin
    whole: Described

    @classmethod
    def of(cls, origin: Source | None) -> DescribedCallbacks:
        """Those of the text of a description; InvalidArgumentError without one."""
        if not isinstance(origin, DescriptionOrigin):
            raise InvalidArgumentError(
                "only an app.yaml says where callbacks run and in which order; give one, or leave out 'callbacks'"
            )
        return cls(origin, describe_text(origin.text, origin.path))

    @property
    def executor(self) -> ExecutorSection:
        """The first executor."""
        return self.whole.description.middleware.stated_executors[0]

    @property
    def callbacks(self) -> tuple[Callback, ...]:
        """All callbacks, in the order of the file."""
        return callbacks_of(self.whole.description.application, self.whole.description.middleware, Notes())

    @property
    def inside(self) -> list[str]:
        """The callbacks that run in the first executor, in their order."""
        inside = (each for each in self.callbacks if each.in_executor and each.executor == self.executor.name)
        return [callback.name for callback in registration_order(inside, self.executor, Notes())]

    def placements(self) -> Iterator[Choice]:
        """For each callback, a task of its own or the executor."""
        for callback in self.callbacks:
            words = ("executor", "own-task") if callback.in_executor else ("own-task", "executor")
            yield Choice(object=callback.name, key="runs_in", kind=DecisionKind.PLACEMENT, options=words)

    @property
    def targets(self) -> frozenset[str]:
        """What only a description states, as OBJECT.KEY."""
        of_executor = (f"{self.executor.name}.{key}" for key in ("order", "semantics"))
        return frozenset((*of_executor, *(f"{callback.name}.runs_in" for callback in self.callbacks)))

    def orders(self) -> Iterator[Choice]:
        """The orders of the callbacks that run in the executor now."""
        inside = self.inside
        if len(inside) > 1:
            options = tuple(",".join(order) for order in permutations(inside))
            yield Choice(object=self.executor.name, key="order", kind=DecisionKind.ORDER, options=options)

    def semantics(self) -> Iterator[Choice]:
        """When callbacks in the executor take their messages."""
        if self.inside:
            options = tuple(dict.fromkeys((self.executor.semantics, "ROS", "LET")))
            yield Choice(object=self.executor.name, key="semantics", kind=DecisionKind.COMMUNICATION, options=options)

    def built(self, own: Candidate, complete: Completed) -> RebuiltStructure:
        """What is built with some options; InvalidArgumentError if it is impossible."""
        inside = {callback.name: callback.in_executor for callback in self.callbacks}
        moved = {change.object: change.value == "executor" for change in own if change.key == "runs_in"}
        for callback in self.callbacks:
            if moved.get(callback.name) and getattr(callback.section, "deadline", None) is not None:
                raise InvalidArgumentError(f"the deadline of {callback.name!r} has no effect in the executor")
        changes = self._with_order(own, {**inside, **moved})
        rebuilt = describe_text(self.origin.edited(changes), self.origin.path).assembly
        if _demands(rebuilt.system) != _demands(self.whole.assembly.system):
            raise InvalidArgumentError("a requirement of the model has no object there")
        return complete(changes, rebuilt.system, rebuilt)

    def _with_order(self, own: Candidate, inside: Mapping[str, bool]) -> tuple[Change, ...]:
        """The changes, with an order that has only callbacks that run in the executor."""
        chosen = next((change.value.split(",") for change in own if change.key == "order"), list(self.executor.order))
        order = [name for name in chosen if inside[name]]
        others = tuple(change for change in own if change.key != "order")
        return (
            others if order == self.executor.order else (*others, Change(self.executor.name, "order", ",".join(order) or "[]"))
        )


def _demands(system: System) -> list[object]:
    """What is demanded, by names."""
    parts: Iterable[Iterable[object]] = (getattr(system.constraints, field.name) for field in fields(system.constraints))
    return [(type(each).__name__, getattr(each, "name", "")) for part in parts for each in part]
