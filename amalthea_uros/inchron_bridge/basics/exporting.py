"""The state of one run of making a project."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import WriteError
from amalthea_uros.inchron.objects import ProjectObject
from amalthea_uros.inchron_bridge.basics import values
from amalthea_uros.inchron_bridge.basics.comments import keep_fields
from amalthea_uros.perf.system import System
from amalthea_uros.units import Time


class Exporting:
    """System -> project.

    Attributes
    ----------
    units : as a model spells quantities, by the name of the object and the value; none for descriptions
    iterations : the shortest and the longest time between two iterations of executors, by the stimuli that stand for them
    entry : number of the next entry of a call graph
    condition : number of the next condition or schedule point
    holder : name of the object whose references are being resolved
    graphs : of each event chain; several if it begins with several events
    """

    def __init__(
        self,
        system: System,
        units: Mapping[tuple[str, int], str],
        iterations: Mapping[str, tuple[Time, Time]] = MappingProxyType({}),
    ) -> None:
        self.system = system
        self.units = units
        self.iterations = iterations
        self.model = ProjectObject("Model")
        self.entry = 0
        self.condition = 0
        self.holder = ""
        self.graphs: dict[str, list[ProjectObject]] = {}
        self._objects: dict[tuple[str, str], ProjectObject] = {}
        self._lost: dict[tuple[str, str, str], list[Any]] = {}
        self._errors: list[Finding] = []

    def register(self, kind: str, name: str, item: ProjectObject) -> ProjectObject:
        """Register an object as a target of references by a name that is unique within a kind."""
        if (kind, name) in self._objects:
            self._errors.append(
                Finding("INC003", Severity.ERROR, f"duplicate name {name!r}: two objects of kind {kind} have it")
            )
        self._objects[kind, name] = item
        return item

    def find(self, kind: str, name: str | None) -> ProjectObject | None:
        """The object of a name; None if there is none."""
        return self._objects.get((kind, name or ""))

    def need(self, kind: str, name: str, holder: str) -> ProjectObject:
        """The object of a name; an error if there is none."""
        result = self.find(kind, name)
        if result is None:
            message = f"{holder} refers to an undefined {kind} {name!r}"
            self._errors.append(Finding("INC003", Severity.ERROR, message, None, "Define it.", holder))
            return ProjectObject(kind if kind != "DataObject" else "memory.DataObject", name=name)
        return result

    def trace_event(self, kind: str, name: str | None, event: str) -> ProjectObject | None:
        """The trace event of a process, function or data object."""
        holder = self.find(kind, name)
        events = holder["traceEvents"] if holder else []
        return next((each for each in events if each.name == event), None)

    def time(self, value: int | None, holder: str = "") -> ProjectObject | None:
        """A time, in the unit in which the model has it for an object."""
        return None if value is None else values.time(value, self.units.get((holder, value)))

    def size(self, bits: int | None, holder: str) -> ProjectObject | None:
        """A data size."""
        return None if bits is None else values.size(bits, self.units.get((holder, bits)))

    def keep(self, item: ProjectObject, source: Any, *names: str) -> None:
        """Keep fields in the comment that the project has no feature for, and report them."""
        for name in keep_fields(item, source, names):
            self.lost(source, f"{type(source).__name__}.{name}")

    def lost(self, source: Any, what: str, how: str = "only amuros reads it, in a comment") -> None:
        """Report something that has no place in a project; equal things are one finding, with the first place."""
        self._lost.setdefault((what, how, "INC004"), []).append(source)

    def changed(self, source: Any, what: str, how: str) -> None:
        """Report something that a project can only hold in another form."""
        self._lost.setdefault((what, how, "INC005"), []).append(source)

    def finish(self) -> tuple[Finding, ...]:
        """The findings.

        Raises
        ------
        WriteError : references lead nowhere, or names are not unique.
        """
        if self._errors:
            raise WriteError(dict.fromkeys(self._errors))
        return tuple(_finding(rule, what, how, sources) for (what, how, rule), sources in self._lost.items())


def _finding(rule: str, what: str, how: str, sources: list[Any]) -> Finding:
    name = next(filter(None, map(_name, sources)), "")
    subject, times = f"{name}: " if name else "", f" ({len(sources)} times)" if len(sources) > 1 else ""
    if rule == "INC004":
        message = f"{subject}{what} has no place in an INCHRON project{times}: {how}"
        return Finding("INC004", Severity.WARNING, message, _place(sources), "", name)
    return Finding("INC005", Severity.INFO, f"{subject}{what}, written {how}{times}", _place(sources), "", name)


def _name(source: Any) -> str:
    return getattr(source, "name", "") or ""


def _place(sources: list[Any]) -> Location | None:
    for source in sources:
        if (origin := getattr(source, "origin", None)) is not None:
            result: Location = origin
            return result
        if (locate := getattr(source, "locate", None)) is not None:
            return locate()  # type: ignore[no-any-return]
    return None
