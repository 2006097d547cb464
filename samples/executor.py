"""Build the timing model of a micro-ROS application on one core with the library, and write it as `executor.amxmi`.

The application is the test case of S. R. Bappanadu, "Modeling and Timing Analysis of Micro-ROS Application on an Off-Road Vehicle
Control Unit", University of Stuttgart, 2022, section 6.1: an executor task serves the middleware, a subscription callback takes a
factor, a control function multiplies an input by it. One core at 1 MHz, so that a tick is a microsecond.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass

import amalthea_uros as amuros
from amalthea_uros.am import (
    ActivityGraph,
    Amalthea,
    DataSize,
    DiscreteValueConstant,
    EventChain,
    EventChainContainer,
    EventChainItemType,
    EventChainLatencyConstraint,
    EventModel,
    Frequency,
    FrequencyDomain,
    HWModel,
    HwStructure,
    IntegerObject,
    Label,
    LabelAccess,
    LabelAccessEnum,
    LatencyType,
    MappingModel,
    OperatingSystem,
    OSModel,
    ParameterType,
    PeriodicStimulus,
    Preemption,
    ProcessEvent,
    ProcessEventType,
    ProcessingUnit,
    ProcessingUnitDefinition,
    PuType,
    Runnable,
    RunnableCall,
    SchedulerAllocation,
    SchedulerDefinition,
    SchedulingParameter,
    SchedulingParameterDefinition,
    StimuliModel,
    StructureType,
    SubEventChain,
    SWModel,
    Task,
    TaskAllocation,
    TaskScheduler,
    Ticks,
    Time,
)


@dataclass(frozen=True)
class Function:
    """A task with one runnable: period in ms, execution time in us, a higher number is a higher priority."""

    name: str
    period: int
    execution_time: int
    priority: int
    reads: tuple[str, ...]
    writes: tuple[str, ...]


FUNCTIONS = (
    Function("Executor_Task", 1, 12, 3, (), ("memory_1",)),
    Function("Control_Function", 1, 4, 2, ("memory_2", "input"), ("output",)),
    Function("Message_Factor", 20, 2, 1, ("memory_1",), ("memory_2",)),
)


def build() -> amuros.Model:
    """The model, AMALTHEA 3.3.0."""
    labels = {name: Label(name=name, size=DataSize(4, "B")) for name in ("memory_1", "memory_2", "input", "output")}
    stimuli = {
        period: PeriodicStimulus(name=f"every_{period}_ms", recurrence=Time(period, "ms"), offset=Time(0, "ms"))
        for period in (1, 20)
    }
    runnables = {function.name: runnable(function, labels) for function in FUNCTIONS}
    tasks = {
        function.name: Task(
            name=function.name,
            stimuli=[stimuli[function.period]],
            preemption=Preemption.PREEMPTIVE,
            multiple_task_activation_limit=1,
            activity_graph=ActivityGraph(items=[RunnableCall(runnable=runnables[function.name])]),
        )
        for function in FUNCTIONS
    }
    core, hardware = single_core()
    priority = SchedulingParameterDefinition(name="priority", type=ParameterType.INTEGER, mandatory=True)
    osek = SchedulerDefinition(name="OSEK", process_parameters=[priority])
    scheduler = TaskScheduler(name="Scheduler", definition=osek)
    events, chains, constraint = factor_to_output(tasks)
    return amuros.Model.of(
        Amalthea(
            sw_model=SWModel(tasks=list(tasks.values()), runnables=list(runnables.values()), labels=list(labels.values())),
            hw_model=hardware,
            os_model=OSModel(
                scheduler_definitions=[osek],
                scheduling_parameter_definitions=[priority],
                operating_systems=[OperatingSystem(name="OS", task_schedulers=[scheduler])],
            ),
            stimuli_model=StimuliModel(stimuli=list(stimuli.values())),
            event_model=EventModel(events=[*events]),
            constraints_model=amuros.am.ConstraintsModel(event_chains=chains, timing_constraints=[constraint]),
            mapping_model=MappingModel(
                scheduler_allocation=[SchedulerAllocation(scheduler=scheduler, responsibility=[core], executing_pu=core)],
                task_allocation=[
                    TaskAllocation(
                        task=tasks[function.name],
                        scheduler=scheduler,
                        scheduling_parameters=[SchedulingParameter(key=priority, value=IntegerObject(value=function.priority))],
                    )
                    for function in FUNCTIONS
                ],
            ),
        )
    )


def runnable(function: Function, labels: dict[str, Label]) -> Runnable:
    """Reads, computes, writes."""
    reads = [LabelAccess(data=labels[name], access=LabelAccessEnum.READ) for name in function.reads]
    writes = [LabelAccess(data=labels[name], access=LabelAccessEnum.WRITE) for name in function.writes]
    ticks = Ticks(default=DiscreteValueConstant(value=function.execution_time))
    return Runnable(name=f"{function.name}_Runnable", activity_graph=ActivityGraph(items=[*reads, ticks, *writes]))


def single_core() -> tuple[ProcessingUnit, HWModel]:
    """One core at 1 MHz."""
    definition = ProcessingUnitDefinition(name="TriCore", pu_type=PuType.CPU)
    domain = FrequencyDomain(name="Clock", default_value=Frequency(1.0, "MHz"))
    core = ProcessingUnit(name="Core_0", definition=definition, frequency_domain=domain)
    controller = HwStructure(name="TC389", structure_type=StructureType.MICROCONTROLLER, modules=[core])
    return core, HWModel(definitions=[definition], domains=[domain], structures=[controller])


def factor_to_output(
    tasks: dict[str, Task],
) -> tuple[list[ProcessEvent], list[EventChain], EventChainLatencyConstraint]:
    """The chain from the executor that took a message to the first control function that uses it."""
    names = ("Executor_Task", "Message_Factor", "Control_Function")
    started = ProcessEvent(name="executor_started", event_type=ProcessEventType.START, entity=tasks[names[0]])
    done = [ProcessEvent(name=f"{name}_done", event_type=ProcessEventType.TERMINATE, entity=tasks[name]) for name in names[1:]]
    hops = zip((started, *done), done, strict=False)
    items = [EventChainContainer(event_chain=SubEventChain(stimulus=first, response=then)) for first, then in hops]
    chain = EventChain(
        name="factor_to_output", stimulus=started, response=done[-1], items=[*items], item_type=EventChainItemType.SEQUENCE
    )
    constraint = EventChainLatencyConstraint(
        name="factor_in_time", scope=chain, type=LatencyType.REACTION, maximum=Time(25, "ms")
    )
    return [started, *done], [chain], constraint


if __name__ == "__main__":
    amuros.save(build(), sys.argv[1])
