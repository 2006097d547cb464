"""Scheduling policies and parameters.

Since 2.0 a policy is a definition with a standard name, and parameters are keyed by definitions; until 1.2 a policy is a class, and
the parameters are priority, budgets and replenishment.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

from amalthea_uros.bridge.basics.codecs import build_time
from amalthea_uros.bridge.basics.context import Building, Extracting
from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.kept_properties import PARENT_PARAMETER, SCHEDULING_PARAMETER
from amalthea_uros.metamodel.magnitudes import picoseconds
from amalthea_uros.perf.named import Named
from amalthea_uros.perf.os import SERVERS, Parameter, ParameterValue, Policy
from amalthea_uros.units import Duration

PRIORITY, DEADLINE = "priority", "deadline"

#: Parameters that standard policies have for each process, and for themselves.
_OF_PROCESSES: dict[str, tuple[str, ...]] = {
    Policy.FIXED_PRIORITY_PREEMPTIVE: (PRIORITY,),
    Policy.OSEK: (PRIORITY, "taskGroup"),
    Policy.FIXED_PRIORITY_WITH_BUDGETS: (PRIORITY, "minBudget", "maxBudget", "replenishment"),
    Policy.DEADLINE_MONOTONIC: (DEADLINE,),
    Policy.RATE_MONOTONIC: ("period",),
    Policy.EARLIEST_DEADLINE_FIRST: (DEADLINE,),
    Policy.PRIORITY_BASED_ROUND_ROBIN: (PRIORITY, "timeSliceLength"),
}
_FAIR = (Policy.PFAIR, Policy.PARTLY_PFAIR, Policy.EARLY_RELEASE_FAIR, Policy.PARTLY_EARLY_RELEASE_FAIR)
_OF_POLICIES: dict[str, tuple[str, ...]] = {
    **dict.fromkeys(SERVERS, ("capacity", "period")),
    **dict.fromkeys(_FAIR, ("quantSize",)),
}

#: Parameters whose type the standard fixes; others have the type of their first value.
_TYPES = {
    PRIORITY: am.ParameterType.INTEGER,
    "taskGroup": am.ParameterType.INTEGER,
    **dict.fromkeys(
        (DEADLINE, "period", "capacity", "minBudget", "maxBudget", "replenishment", "timeSliceLength", "quantSize"),
        am.ParameterType.TIME,
    ),
}
#: The features that budgets have until 1.2.
_BUDGETS = {"minBudget": "min_budget", "maxBudget": "max_budget", "replenishment": "replenishment"}

#: What schedulers may do without.
_OPTIONAL = {"taskGroup", "minBudget"}


class Given(NamedTuple):
    """What one process or scheduler is given."""

    priority: int | None
    deadline: int | None
    parameters: tuple[Parameter, ...]


def _parameters(given: Given) -> Iterable[Parameter]:
    if given.priority is not None:
        yield Parameter(PRIORITY, (given.priority,))
    if given.deadline is not None:
        yield Parameter(DEADLINE, (Duration(given.deadline),))
    yield from given.parameters


def _build_value(value: ParameterValue) -> am.Value:
    match value:
        case bool():
            return am.BooleanObject(value=value)
        case int():
            return am.IntegerObject(value=value) if -(2**31) <= value < 2**31 else am.LongObject(value=value)
        case float():
            return am.DoubleObject(value=value)
        case Duration(time=time):
            found = build_time(time)
            assert found
            return found
    return am.StringObject(value=value)


def _extract_values(value: Any) -> tuple[ParameterValue, ...]:
    match value:
        case am.Time():
            time = picoseconds(value)
            return () if time is None else (Duration(time),)
        case am.ListObject():
            return tuple(inner for item in value.values for inner in _extract_values(item))
        case (
            am.IntegerObject()
            | am.LongObject()
            | am.BigIntegerObject()
            | am.FloatObject()
            | am.DoubleObject()
            | am.BooleanObject()
            | am.StringObject()
        ):
            return () if value.value is None else (value.value,)
    return ()


def _type_of(parameter: Parameter) -> am.ParameterType:
    if parameter.name in _TYPES:
        return _TYPES[parameter.name]
    match parameter.values[0]:
        case bool():
            return am.ParameterType.BOOL
        case int():
            return am.ParameterType.INTEGER
        case float():
            return am.ParameterType.FLOAT
        case Duration():
            return am.ParameterType.TIME
    return am.ParameterType.STRING


class SchedulingDefinitions:
    """Definitions of policies and parameters, as they are needed."""

    def __init__(self, context: Building) -> None:
        self.context = context
        self.schedulers: dict[str, am.SchedulerDefinition] = {}
        self.parameters: dict[str, am.SchedulingParameterDefinition] = {}

    def set_policy(self, element: Any, item: Named, policy: str | None) -> None:
        """Give a scheduler or interrupt controller its policy."""
        if policy is None:
            return
        if self.context.is_at_least(2):
            element.definition = self._scheduler(policy)
            return
        algorithm = getattr(am, policy, None)
        wanted = am.InterruptSchedulingAlgorithm if isinstance(element, am.InterruptController) else am.TaskSchedulingAlgorithm
        if algorithm is None or not issubclass(algorithm, wanted) or algorithm.is_abstract:
            self.context.refuse(item, f"AMALTHEA {self.context.version} has no scheduling policy {policy!r}")
        else:
            element.scheduling_algorithm = algorithm()

    def _scheduler(self, policy: str) -> am.SchedulerDefinition:
        if policy not in self.schedulers:
            self.schedulers[policy] = am.SchedulerDefinition(
                name=policy,
                algorithm_parameters=[self._parameter(name) for name in _OF_POLICIES.get(policy, ())],
                process_parameters=[self._parameter(name) for name in _OF_PROCESSES.get(policy, ())],
            )
        return self.schedulers[policy]

    def _parameter(self, name: str, kind: am.ParameterType | None = None) -> am.SchedulingParameterDefinition:
        if name not in self.parameters:
            self.parameters[name] = am.SchedulingParameterDefinition(
                name=name, type=kind or _TYPES[name], mandatory=name not in _OPTIONAL
            )
        return self.parameters[name]

    def set_parameters(self, element: Any, item: Named, given: Given, policy: str | None, of_process: bool) -> None:
        """Give a process or scheduler its parameters.

        Parameters
        ----------
        policy : of the scheduler that uses them; its definition lists them
        of_process : whether they are those of a process, or of the policy itself
        """
        if not self.context.is_at_least(2):
            self._set_old(element, item, given)
            return
        for parameter in _parameters(given):
            key = self._parameter(parameter.name, _type_of(parameter))
            if len(parameter.values) > 1:
                key.many = True
            values = [_build_value(value) for value in parameter.values]
            value = values[0] if len(values) == 1 else am.ListObject(values=values)
            element.scheduling_parameters.append(am.SchedulingParameter(key=key, value=value))
            self._list(key, policy, of_process)

    def _list(self, key: am.SchedulingParameterDefinition, policy: str | None, of_process: bool) -> None:
        """Let the definition of the policy list a parameter that the standard does not have; others can do without it."""
        if policy is None:
            return
        definition = self._scheduler(policy)
        listed = definition.process_parameters if of_process else definition.algorithm_parameters
        if key not in listed:
            if key not in (*definition.process_parameters, *definition.algorithm_parameters):
                key.mandatory = False
            listed.append(key)

    def _set_old(self, element: Any, item: Named, given: Given) -> None:
        """The parameters of 1.2, as far as there are any."""
        found = am.SchedulingParameters(priority=given.priority)
        is_holder = not isinstance(element, am.Scheduler)
        for parameter in given.parameters:
            value = parameter.values[0] if len(parameter.values) == 1 else None
            if is_holder and parameter.name in _BUDGETS and isinstance(value, Duration):
                setattr(found, _BUDGETS[parameter.name], build_time(value.time))
            elif is_holder and isinstance(value, str):
                element.parameter_extensions.append(am.ParameterExtension(key=parameter.name, value=value))
            else:
                self._refuse_old(item, parameter.name)
        if given.deadline is not None:
            self._refuse_old(item, DEADLINE)
        if given.priority is not None or given.parameters:
            if is_holder:
                element.scheduling_parameters.append(found)
            else:
                self._refuse_old(item, PRIORITY)

    def _refuse_old(self, item: Named, name: str) -> None:
        self.context.refuse(item, f"AMALTHEA {self.context.version} cannot represent the scheduling parameter {name!r}")


def extract_policy(scheduler: Any) -> str | None:
    """The policy of a scheduler, of any version."""
    if scheduler.definition is not None:
        name: str | None = scheduler.definition.name
        return name or None
    algorithm = getattr(scheduler, "scheduling_algorithm", None)
    return None if algorithm is None else type(algorithm).__name__


def extract_parameters(
    element: Any,
    context: Extracting,
    defaults: Iterable[am.SchedulingParameterDefinition] = (),
    kept: Iterable[am.CustomProperty] | None = None,
) -> Given:
    """The parameters of a process or scheduler, of any version.

    Parameters
    ----------
    defaults : definitions whose default values apply where no value is given
    kept : properties of the scheduler whose association with its parent the element is; default: those of the element itself
    """
    priority: int | None = None
    deadline: int | None = None
    others: list[Parameter] = []
    stated = list(_stated(element, context))
    names = {name for name, _ in stated}
    if context.is_older(element, 2, 0, 0):
        besides = _kept(element.custom_properties, SCHEDULING_PARAMETER) if kept is None else _kept(kept, PARENT_PARAMETER)
        stated += [parameter for parameter in besides if parameter[0] not in names]
        names |= {name for name, _ in stated}
    for name, values in (*(default for default in _defaults(defaults) if default[0] not in names), *stated):
        value = values[0]
        if name == PRIORITY and isinstance(value, int) and len(values) == 1:
            priority = value
        elif name == DEADLINE and isinstance(value, Duration) and len(values) == 1:
            deadline = value.time
        else:
            others.append(Parameter(name, values))
    return Given(priority, deadline, tuple(others))


def _defaults(definitions: Iterable[am.SchedulingParameterDefinition]) -> Iterable[tuple[str, tuple[ParameterValue, ...]]]:
    for definition in definitions:
        values = _extract_values(definition.default_value)
        if definition.name and values:
            yield definition.name, values


def _stated(element: Any, context: Extracting) -> Iterable[tuple[str, tuple[ParameterValue, ...]]]:
    for parameter in element.scheduling_parameters:
        if isinstance(parameter, am.SchedulingParameters):
            yield from _stated_before(parameter)
            continue
        key = parameter.key.name if parameter.key is not None else None
        values = _extract_values(parameter.value)
        if key and values:
            yield key, values
        else:
            context.note("EXT004", "SchedulingParameter ignored: it has no key or no value", element)
    for extension in getattr(element, "parameter_extensions", ()):
        if extension.key and extension.value:
            yield extension.key, (extension.value,)


def _kept(properties: Iterable[am.CustomProperty], start: str) -> Iterable[tuple[str, tuple[ParameterValue, ...]]]:
    """Parameters for which 1.2 and older have no feature, where a migration to such a version keeps them."""
    for each in properties:
        values = _extract_values(each.value)
        if each.key and each.key.startswith(start) and values:
            yield each.key.removeprefix(start), values


def _stated_before(stated: am.SchedulingParameters) -> Iterable[tuple[str, tuple[ParameterValue, ...]]]:
    """The parameters of 1.2 and older."""
    if stated.priority is not None:
        yield PRIORITY, (stated.priority,)
    for name, feature in _BUDGETS.items():
        time = picoseconds(getattr(stated, feature))
        if time is not None:
            yield name, (Duration(time),)
