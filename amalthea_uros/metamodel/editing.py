"""Adding cores, tasks, labels and chains to a model, each in one line: what they need in other parts of the model is added, too."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from fractions import Fraction
from itertools import pairwise
from math import ceil, floor
from typing import TYPE_CHECKING, Any, Literal, TypeVar

from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.magnitudes import frequency_of, hertz, picoseconds, time_of
from amalthea_uros.units import parse_data_size, parse_frequency, parse_time, ticks_of_time, time_text

if TYPE_CHECKING:
    from amalthea_uros.metamodel.model import Reference

E = TypeVar("E", bound=Element)
Q = TypeVar("Q", int, Fraction)

_POLICY, _PRIORITY = "FixedPriorityPreemptive", "priority"
_PREEMPTION = {
    "preemptive": am.Preemption.PREEMPTIVE,
    "cooperative": am.Preemption.COOPERATIVE,
    "non-preemptive": am.Preemption.NON_PREEMPTIVE,
}


class Editing:
    """The methods of a model that add objects."""

    if TYPE_CHECKING:

        @property
        def root(self) -> am.Amalthea:
            """The content of the only document."""

        def __getitem__(self, key: tuple[type[E], str]) -> E:
            """The object of a class and name."""

        def all(self, cls: type[E]) -> Iterable[E]:
            """Every object of a class."""

        def references_to(self, target: Element) -> list[Reference]:
            """Every use of an object."""

    def add_core(self, name: str, *, frequency: str) -> am.ProcessingUnit:
        """Add a core with its clock, and a scheduler of fixed priorities for its tasks.

        Parameters
        ----------
        frequency : such as "100 MHz"

        Raises
        ------
        InvalidArgumentError : the model already has such a core, or the frequency is wrong.
        """
        clock = frequency_of(_positive(f"{name}: frequency", frequency, parse_frequency))
        if clock is None:
            raise InvalidArgumentError(f"{name}: frequency: {frequency!r} has no exact decimal representation")
        hardware = _part(self.root, "hw_model", am.HWModel)
        _check_new(name, am.ProcessingUnit, self.all(am.ProcessingUnit))
        definition = _first(hardware.definitions, am.ProcessingUnitDefinition)
        if definition is None:
            definition = am.ProcessingUnitDefinition(name="Core", pu_type=am.PuType.CPU)
            hardware.definitions.append(definition)
        domain = am.FrequencyDomain(name=f"{name}_Clock", default_value=clock)
        hardware.domains.append(domain)
        core = am.ProcessingUnit(name=name, definition=definition, frequency_domain=domain)
        if not hardware.structures:
            hardware.structures = [am.HwStructure(name="Controller", structure_type=am.StructureType.MICROCONTROLLER)]
        hardware.structures[0].modules.append(core)
        self._add_scheduler(core)
        return core

    def add_label(self, name: str, *, size: str) -> am.Label:
        """Add a variable that tasks share.

        Parameters
        ----------
        size : such as "4 B"
        """
        bits = _positive(f"{name}: size", size, parse_data_size)
        software = _part(self.root, "sw_model", am.SWModel)
        _check_new(name, am.Label, software.labels)
        amount = am.DataSize(bits // 8, "B") if bits % 8 == 0 else am.DataSize(bits, "bit")
        label = am.Label(name=name, size=amount)
        software.labels.append(label)
        return label

    def add_task(
        self,
        name: str,
        *,
        period: str,
        wcet: str,
        bcet: str = "0 s",
        priority: int | None = None,
        deadline: str | None = None,
        offset: str = "0 s",
        core: str | None = None,
        preemption: Literal["preemptive", "cooperative", "non-preemptive"] = "preemptive",
        reads: Iterable[str] = (),
        writes: Iterable[str] = (),
    ) -> am.Task:
        """Add a periodic task with a runnable that reads labels, computes, and writes labels.

        Parameters
        ----------
        wcet, bcet : execution times on the core, such as "20 us"; in ticks of its clock, they are rounded to the safe side
        priority : higher numbers are served first; None: not stated, so that response times remain unknown
        deadline : becomes a requirement
        core : may be omitted if there is only one
        reads, writes : names of labels of the model

        Raises
        ------
        InvalidArgumentError : the model already has such a task, or a value is wrong.
        KeyError : there is no such core or label; the text lists similar names.
        """
        software = _part(self.root, "sw_model", am.SWModel)
        _check_new(name, am.Task, software.tasks)
        if preemption not in _PREEMPTION:
            raise InvalidArgumentError(f"{name}: unknown preemption {preemption!r}; expected one of {', '.join(_PREEMPTION)}")
        unit = self._core(core)
        scheduler = self._scheduler_of(unit)
        limit = None if deadline is None else _positive(f"{name}: deadline", deadline, parse_time)
        if priority is not None:
            _check_priority(name, priority)
        items: list[Any] = [self._access(label, am.LabelAccessEnum.READ) for label in reads]
        items.append(am.Ticks(default=_ticks(name, bcet, wcet, unit)))
        items += [self._access(label, am.LabelAccessEnum.WRITE) for label in writes]
        stimulus = self._stimulus(name, period, offset)
        runnable = am.Runnable(name=f"{name}_Runnable", activity_graph=am.ActivityGraph(items=items))
        task = am.Task(
            name=name,
            stimuli=[stimulus],
            preemption=_PREEMPTION[preemption],
            multiple_task_activation_limit=1,
            activity_graph=am.ActivityGraph(items=[am.RunnableCall(runnable=runnable)]),
        )
        software.runnables.append(runnable)
        software.tasks.append(task)
        mapping = _part(self.root, "mapping_model", am.MappingModel)
        mapping.task_allocation.append(am.TaskAllocation(task=task, scheduler=scheduler))
        if priority is not None:
            self.set_priority(task, priority)
        if limit is not None:
            _part(self.root, "constraints_model", am.ConstraintsModel).requirements.append(_deadline(task, limit))
        return task

    def add_chain(
        self, name: str, path: Sequence[str], *, reaction: str | None = None, age: str | None = None
    ) -> am.EventChain:
        """Add an event chain from the start of the first task to the end of the last one.

        Parameters
        ----------
        path : names of tasks
        reaction, age : maximum reaction time and data age; they become constraints

        Raises
        ------
        InvalidArgumentError : the model already has such a chain, the path is too short, or a value is wrong.
        KeyError : there is no such task; the text lists similar names.
        """
        constraints = _part(self.root, "constraints_model", am.ConstraintsModel)
        _check_new(name, am.EventChain, constraints.event_chains)
        if isinstance(path, str) or not isinstance(path, Sequence) or len(path) < 2:
            raise InvalidArgumentError(f"{name}: expected the names of at least two tasks, e.g. ['A', 'B'], not {path!r}")
        if len(set(path)) < len(path):
            raise InvalidArgumentError(f"{name}: a task occurs twice, but a chain cannot contain cycles")
        tasks = [self[am.Task, task] for task in path]
        limits = [
            (kind, _positive(f"{name}: {word}", value, parse_time))
            for word, kind, value in (("reaction", am.LatencyType.REACTION, reaction), ("age", am.LatencyType.AGE, age))
            if value is not None
        ]
        first = self._event(tasks[0], am.ProcessEventType.START)
        events = [first, *(self._event(task, am.ProcessEventType.TERMINATE) for task in tasks[1:])]
        chain = am.EventChain(name=name, stimulus=first, response=events[-1])
        if len(events) > 2:
            parts = (am.SubEventChain(stimulus=one, response=then) for one, then in pairwise(events))
            chain.items = [am.EventChainContainer(event_chain=part) for part in parts]
            chain.item_type = am.EventChainItemType.SEQUENCE
        constraints.event_chains.append(chain)
        for kind, limit in limits:
            constraint = am.EventChainLatencyConstraint(
                name=f"{name}_{kind.value.lower()}", scope=chain, type=kind, maximum=time_of(limit)
            )
            constraints.timing_constraints.append(constraint)
        return chain

    def set_period(self, task: am.Task | str, period: str) -> None:
        """Change the period of a task; tasks that share its stimulus keep theirs.

        Raises
        ------
        InvalidArgumentError : the task is not activated by one periodic stimulus, or the period is wrong.
        """
        task = self._task(task)
        match list(task.stimuli):
            case [am.PeriodicStimulus() as old]:
                offset = old.offset
            case _:
                raise InvalidArgumentError(
                    f"{task.name!r} is not activated by exactly one periodic stimulus; change its stimuli"
                )
        if len(self.references_to(old)) == 1:
            old.recurrence = time_of(_positive(f"{task.name}: period", period, parse_time))
            return
        own = am.PeriodicStimulus(name=f"Activation_{task.name}", offset=offset and am.Time(offset.value, offset.unit))
        _check_new(own.name or "", am.Stimulus, self.all(am.Stimulus))
        own.recurrence = time_of(_positive(f"{task.name}: period", period, parse_time))
        _part(self.root, "stimuli_model", am.StimuliModel).stimuli.append(own)
        task.stimuli = [own]

    def set_priority(self, task: am.Task | str, priority: int) -> None:
        """Change the priority of a task; higher numbers are served first.

        Raises
        ------
        InvalidArgumentError : the task is not allocated to exactly one scheduler.
        """
        task = self._task(task)
        _check_priority(str(task.name), priority)
        allocations = [each for each in self.all(am.TaskAllocation) if each.task is task]
        if len(allocations) != 1:
            raise InvalidArgumentError(f"{task.name!r} has {len(allocations)} task allocations, expected one")
        (allocation,) = allocations
        value = am.IntegerObject(value=priority)
        for parameter in allocation.scheduling_parameters:
            if not isinstance(parameter, am.SchedulingParameter):
                parameter.priority = priority
                return
            if parameter.key is not None and parameter.key.name == _PRIORITY:
                parameter.value = value
                return
        allocation.scheduling_parameters.append(am.SchedulingParameter(key=self._priority_definition(), value=value))

    def _task(self, task: am.Task | str) -> am.Task:
        return self[am.Task, task] if isinstance(task, str) else task

    def _core(self, name: str | None) -> am.ProcessingUnit:
        if name is not None:
            return self[am.ProcessingUnit, name]
        cores = list(self.all(am.ProcessingUnit))
        if len(cores) != 1:
            advice = "add one with add_core() first" if not cores else f"state one of {', '.join(str(c.name) for c in cores)}"
            raise InvalidArgumentError(f"the model has {len(cores)} cores; {advice}")
        return cores[0]

    def _access(self, label: str, kind: am.LabelAccessEnum) -> am.LabelAccess:
        return am.LabelAccess(data=self[am.Label, label], access=kind)

    def _stimulus(self, task: str, period: str, offset: str) -> am.PeriodicStimulus:
        """The stimulus of a period and an offset; tasks of the same ones share it."""
        recurrence = _positive(f"{task}: period", period, parse_time)
        first = _parsed(f"{task}: offset", offset, parse_time)
        name = f"every_{time_text(recurrence)}{f'_from_{time_text(first)}' if first else ''}".replace(" ", "_")
        model = _part(self.root, "stimuli_model", am.StimuliModel)
        for stimulus in model.stimuli:
            if isinstance(stimulus, am.PeriodicStimulus) and stimulus.name == name and _is_every(stimulus, recurrence, first):
                return stimulus
        _check_new(name, am.Stimulus, model.stimuli)
        made = am.PeriodicStimulus(name=name, recurrence=time_of(recurrence), offset=time_of(first))
        model.stimuli.append(made)
        return made

    def _event(self, task: am.Task, kind: am.ProcessEventType) -> am.ProcessEvent:
        """The event of a task; chains share it."""
        model = _part(self.root, "event_model", am.EventModel)
        for event in model.events:
            if isinstance(event, am.ProcessEvent) and event.entity is task and event.event_type is kind:
                return event
        made = am.ProcessEvent(name=f"{task.name}_{kind.value}", entity=task, event_type=kind)
        model.events.append(made)
        return made

    def _add_scheduler(self, core: am.ProcessingUnit) -> None:
        os_model = _part(self.root, "os_model", am.OSModel)
        if not os_model.operating_systems:
            os_model.operating_systems = [am.OperatingSystem(name="OS")]
        definition = _first((each for each in os_model.scheduler_definitions if each.name == _POLICY), am.SchedulerDefinition)
        if definition is None:
            definition = am.SchedulerDefinition(name=_POLICY, process_parameters=[self._priority_definition()])
            os_model.scheduler_definitions.append(definition)
        scheduler = am.TaskScheduler(name=f"Scheduler_{core.name}", definition=definition)
        os_model.operating_systems[0].task_schedulers.append(scheduler)
        allocation = am.SchedulerAllocation(scheduler=scheduler, responsibility=[core], executing_pu=core)
        _part(self.root, "mapping_model", am.MappingModel).scheduler_allocation.append(allocation)

    def _priority_definition(self) -> am.SchedulingParameterDefinition:
        definitions = _part(self.root, "os_model", am.OSModel).scheduling_parameter_definitions
        found = next((each for each in definitions if each.name == _PRIORITY), None)
        if found is None:
            found = am.SchedulingParameterDefinition(name=_PRIORITY, type=am.ParameterType.INTEGER, mandatory=True)
            definitions.append(found)
        return found

    def _scheduler_of(self, core: am.ProcessingUnit) -> am.TaskScheduler:
        for allocation in self.all(am.SchedulerAllocation):
            scheduler = allocation.scheduler
            if isinstance(scheduler, am.TaskScheduler) and list(allocation.responsibility) == [core]:
                return scheduler
        raise InvalidArgumentError(
            f"no task scheduler is responsible for the core {core.name!r} alone; allocate the task yourself"
        )


def _part(root: am.Amalthea, feature: str, cls: type[E]) -> E:
    """A sub-model, created if there is none."""
    found: E | None = getattr(root, feature)
    if found is None:
        found = cls()
        setattr(root, feature, found)
    return found


def _is_every(stimulus: am.PeriodicStimulus, period: int, offset: int) -> bool:
    return (
        picoseconds(stimulus.recurrence) == period and (picoseconds(stimulus.offset) or 0) == offset and stimulus.jitter is None
    )


def _check_priority(task: str, priority: object) -> None:
    if not isinstance(priority, int) or isinstance(priority, bool):
        raise InvalidArgumentError(f"{task}: the priority must be a whole number, not {priority!r}")


def _first(items: Iterable[Element], cls: type[E]) -> E | None:
    return next((item for item in items if isinstance(item, cls)), None)


def _check_new(name: str, cls: type[am.INamed], items: Iterable[am.INamed]) -> None:
    if not isinstance(name, str) or not name:
        raise InvalidArgumentError(f"the name of a new {cls.__name__} must be a text, not {name!r}")
    if any(item.name == name for item in items):
        article = "an" if cls.__name__.startswith(("A", "E", "I", "O", "U")) else "a"
        raise InvalidArgumentError(f"the model already has {article} {cls.__name__} {name!r}")


#: A text that each function accepts.
_EXAMPLES: Mapping[Callable[[str], Any], str] = {parse_time: "10 ms", parse_frequency: "100 MHz", parse_data_size: "4 B"}


def _parsed(what: str, text: str, parse: Callable[[str], Q]) -> Q:
    if not isinstance(text, str):
        raise InvalidArgumentError(f"{what}: expected a text with a unit, such as {_EXAMPLES[parse]!r}, not {text!r}")
    try:
        value = parse(text)
    except ValueError as error:
        raise InvalidArgumentError(f"{what}: {error}") from None
    if value < 0:
        raise InvalidArgumentError(f"{what}: {text!r} is negative")
    return value


def _positive(what: str, text: str, parse: Callable[[str], Q]) -> Q:
    value = _parsed(what, text, parse)
    if not value:
        raise InvalidArgumentError(f"{what}: {text!r} is not positive")
    return value


def _ticks(name: str, bcet: str, wcet: str, core: am.ProcessingUnit) -> am.IDiscreteValueDeviation:
    """Execution times in ticks of the clock of a core."""
    frequency = hertz(core.frequency_domain.default_value) if core.frequency_domain is not None else None
    if not frequency:
        raise InvalidArgumentError(f"the core {core.name!r} has no frequency, so that times cannot become ticks")
    best, worst = _parsed(f"{name}: bcet", bcet, parse_time), _parsed(f"{name}: wcet", wcet, parse_time)
    if best > worst:
        raise InvalidArgumentError(f"{name}: the bcet {bcet} exceeds the wcet {wcet}")
    least, most = floor(ticks_of_time(best, frequency)), ceil(ticks_of_time(worst, frequency))
    if least == most:
        return am.DiscreteValueConstant(value=most)
    return am.DiscreteValueBoundaries(lower_bound=least, upper_bound=most)


def _deadline(task: am.Task, limit: int) -> am.ProcessRequirement:
    return am.ProcessRequirement(
        name=f"{task.name}_response_time",
        severity=am.Severity.CRITICAL,
        process=task,
        limit=am.TimeRequirementLimit(
            metric=am.TimeMetric.RESPONSE_TIME, limit_type=am.LimitType.UPPER_LIMIT, limit_value=time_of(limit)
        ),
    )
