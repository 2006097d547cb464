"""Which executor serves a callback, and whether the callback runs in it or in a task of its own."""

from __future__ import annotations

from collections.abc import Iterable

from amalthea_uros._internal.records import dataclass
from amalthea_uros.spec.application import CallbackSection, NodeSection
from amalthea_uros.spec.description import Description
from amalthea_uros.spec.executors import ExecutorSection
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.uros.application.notes import Notes

_OWN_TASK, _FIRST = "own-task", "executor"


def is_in_executor_by_default(executor: ExecutorSection) -> bool:
    """Whether callbacks that do not say where they run do so in the executor."""
    if executor.loop is not None and not executor.states("callbacks"):
        return True
    return executor.callbacks == "in-executor"


def placement(description: Description, platform: str | None) -> str:
    """Where callbacks run that do not say so, and who decided it.

    Parameters
    ----------
    platform : whose file may state it, too
    """
    executor = description.middleware.stated_executors[0]
    inside = is_in_executor_by_default(executor)
    place = "in the executor" if inside else "in their own tasks"
    if not executor.states("callbacks"):
        return f"callbacks run {place}" + (", as rclc does" if inside else " by default")
    location, own = executor.location("callbacks"), description.location()
    is_of_file = location is not None and own is not None and location.path != own.path
    if is_of_file or executor.inherits("callbacks"):
        return f"the platform {platform or ''} runs callbacks {place}"
    return f"callbacks run {place}: set in app.yaml"


@dataclass(frozen=True, slots=True)
class Serving:
    """The executors of a description."""

    executors: tuple[ExecutorSection, ...]
    notes: Notes

    @classmethod
    def of(cls, middleware: Middleware, notes: Notes) -> Serving:
        """Those of a middleware, with a finding if they are described twice."""
        # A platform may describe one executor for applications that describe none.
        if middleware.executors and middleware.states("executor") and _same_file(*middleware.executors, middleware.executor):
            message = "'executor' and 'executors' exclude each other"
            advice = "Move what is under 'executor' to the first item of 'executors'."
            notes.error("APP003", message, middleware.location("executor"), advice)
        return cls(middleware.stated_executors, notes)

    def place(self, section: CallbackSection, node: NodeSection, *, is_of_middleware: bool) -> tuple[ExecutorSection, bool]:
        """The executor that has the handle of a callback, and whether it runs the callback.

        Parameters
        ----------
        is_of_middleware : whether the callback belongs to the middleware, which has no tasks of its own for it
        """
        first = self.executors[0]
        of_node = None if node.runs_in is None else self._named(node.runs_in, node)
        own = None if section.runs_in is None else self._named(section.runs_in, section)
        default = (first, is_in_executor_by_default(first))
        executor, inside = own or of_node or default
        if section.runs_in == _OWN_TASK and of_node is not None:
            executor = of_node[0]
        if is_of_middleware and not inside:
            if section.runs_in is not None:
                message = f"{section.name!r} belongs to the middleware, which has no task for it"
                advice = f"Use the name of an executor, e.g. 'runs_in: {executor.name}'."
                self.notes.error("APP003", message, section.location("runs_in"), advice)
            inside = True
        return executor, inside

    def _named(self, name: str, section: CallbackSection | NodeSection) -> tuple[ExecutorSection, bool]:
        """What `runs_in` says."""
        named = next((executor for executor in self.executors if executor.name == name), None)
        if named is not None:
            return named, True
        if name not in (_OWN_TASK, _FIRST):
            self.notes.undefined("executor", name, self._choices(), section.location("runs_in"))
        return self.executors[0], name != _OWN_TASK

    def _choices(self) -> Iterable[str]:
        return (_OWN_TASK, _FIRST, *(executor.name for executor in self.executors))


def _same_file(*executors: ExecutorSection) -> bool:
    return len({location.path for each in executors if (location := each.location()) is not None}) <= 1
