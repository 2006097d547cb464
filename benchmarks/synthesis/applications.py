"""The applications of a synthetic model: a process with its stimulus, runnables, labels, allocation, events and constraints."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from synthesis.plan import title
from synthesis.platform import CORES, Controller, Platform, add_controller, data_type
from synthesis.stimuli import new_stimulus

if TYPE_CHECKING:
    from synthesis.objects import Object
    from synthesis.plan import Plan

#: No application (with the controller that it may need) has more elements.
LARGEST = 700

_PER_CONTROLLER = 24
_SIZES = (8, 8, 16, 16, 32, 64, 128, 1024)


@dataclass(frozen=True)
class Application:
    """What later applications need of one."""

    graph: Object
    labels: list[Object]
    chain: Object


@dataclass(frozen=True)
class _Data:
    """The labels of one application; only some of them are written."""

    number: int
    labels: list[Object]
    variables: list[Object]


def add_applications(plan: Plan, platform: Platform, elements: int) -> None:
    """Adds applications while the model stays below `elements`, in turn to all files but the first."""
    applications: list[Application] = []
    while elements - plan.count >= LARGEST:
        if len(applications) % _PER_CONTROLLER == 0:
            plan.document = 0
            add_controller(plan, platform)
        plan.document = len(applications) % (len(plan.roots) - 1) + 1 if len(plan.roots) > 1 else 0
        applications.append(_application(plan, platform, applications))


def add_constants(plan: Plan, platform: Platform, elements: int) -> None:
    """Fills the model up to `elements` with labels that nothing accesses, as models have them for calibration."""
    number = 0
    while elements - plan.count >= 2:
        label = plan.new("Label", name=title("Parameter", number), size=plan.size(16, "bit"), constant=True)
        label.values["section"] = platform.sections[0]
        plan.place("swModel", "labels", label)
        number += 1
    if elements > plan.count:
        plan.place("swModel", "labels", plan.new("Label", name="Parameter without size", constant=True))


def _application(plan: Plan, platform: Platform, others: list[Application]) -> Application:
    number = len(others)
    controller = platform.controllers[-1]
    labels = [_label(plan, platform, 100 * number + index) for index in range(plan.random.randint(24, 44))]
    plan.place("swModel", "labels", *labels)
    variables = labels[::3]
    _map_labels(plan, controller, variables, number)
    runnables = _runnables(plan, platform, controller, _Data(number, labels, variables), others)
    plan.place("swModel", "runnables", *runnables)
    stimulus = _stimulus(plan, number, others)
    process, graph = _process(plan, platform, number, runnables, stimulus)
    _allocate(plan, controller, number, process)
    chain = _events_and_chains(plan, number, process, runnables, labels, others)
    _constraints(plan, number, process, runnables, labels, chain)
    return Application(graph, labels, chain)


# Labels


def _label(plan: Plan, platform: Platform, number: int) -> Object:
    namespaces = [plan.random.choice(platform.namespaces)] if number % 12 == 4 else []
    label = plan.new("Label", *namespaces, name=title("Label", number), size=plan.size(plan.random.choice(_SIZES), "bit"))
    label.add("namespace", *namespaces)
    if number % 6 == 2:
        label.values["displayName"] = f"Value {number} [°C]"
        label.values["tags"] = [plan.random.choice(platform.tags)]
    if number % 9 == 3:
        label.values["dataType"] = data_type(plan, plan.random.choice(platform.types))
        label.values["dataStability"] = "automaticProtection"
    if number % 4 == 1:
        label.add(
            "customProperties",
            plan.custom_property("unit", "StringObject", "1/min"),
            plan.custom_property("resolution", "DoubleObject", 0.25),
            plan.custom_property("offset", "IntegerObject", -40),
        )
    return label


def _map_labels(plan: Plan, controller: Controller, labels: list[Object], number: int) -> None:
    """Every fourth application maps its labels one by one, the others by one section of their own."""
    memory = controller.memories[number % 2]
    if number % 4:
        section = plan.new("Section", name=title("Section", number))
        plan.place("swModel", "sections", section)
        for label in labels:
            label.values["section"] = section
        mapping = plan.new("PhysicalSectionMapping", name=f"{section.name} in {memory.name}", origin=[section], memory=memory)
        plan.place("mappingModel", "physicalSectionMapping", mapping)
        return
    for index, label in enumerate(labels):
        address = hex(0x100 * number + 8 * index)
        mapping = plan.new("MemoryMapping", abstractElement=label, memory=memory, memoryPositionAddress=address)
        plan.place("mappingModel", "memoryMapping", mapping)


# Runnables


def _runnables(plan: Plan, platform: Platform, controller: Controller, data: _Data, others: list[Application]) -> list[Object]:
    """Runnables that share the writing of the variables, so that each of them has one writer."""
    count = plan.random.randint(6, 11)
    readable = [*data.labels, *(label for other in others[-6:] for label in other.labels)]
    found = []
    for index in range(count):
        reads = plan.random.sample(readable, plan.random.randint(2, 6))
        items = [_read(plan, label) for label in reads]
        items += _execution(plan, platform, controller, index)
        items += [plan.new("LabelAccess", data=label, access="write") for label in data.variables[index::count]]
        graph = plan.new("ActivityGraph", items=items)
        runnable = plan.new("Runnable", name=title("Runnable", 20 * data.number + index), activityGraph=graph)
        runnable.values["size"] = plan.size(plan.random.randrange(200, 5000), "B")
        if index % 3 == 0:
            runnable.values["asilLevel"] = plan.random.choice("ABCD")
            runnable.add("customProperties", *_properties(plan, data.labels[0]))
        found.append(runnable)
    return found


def _read(plan: Plan, label: Object) -> Object:
    access = plan.new("LabelAccess", data=label, access="read")
    match plan.random.randrange(10):
        case 0:
            access.values["dataStability"] = "inherited"
        case 1 | 2 | 3:
            access.values["statistic"] = plan.new(
                "LabelAccessStatistic",
                value=plan.new("MinAvgMaxStatistic", min=1, avg=2.5, max=4),
                cacheMisses=plan.new("SingleValueStatistic", value=0.5),
            )
        case _:
            count = plan.new("SingleValueStatistic", value=float(plan.random.randint(2, 5)))
            access.values["statistic"] = plan.new("LabelAccessStatistic", value=count)
    return access


def _execution(plan: Plan, platform: Platform, controller: Controller, index: int) -> list[Object]:
    lower = plan.random.randrange(200, 2000)
    if index % 8 == 7:
        need = plan.new("NeedEntry", key="Instructions", value=_demand(plan, index, lower))
        return [plan.new("ExecutionNeed", needs=[need])]
    ticks = plan.new("Ticks", default=_demand(plan, index, lower))
    if index % 5 == 4:
        slower = plan.new("DiscreteValueBoundaries", lowerBound=lower, upperBound=3 * lower, samplingType="BestCase")
        ticks.add("extended", plan.new("TicksEntry", key=platform.hardware["small"], value=slower))
    if index % 8 != 6:
        return [ticks]
    semaphore = plan.random.choice(controller.semaphores)
    request = plan.new("SemaphoreAccess", semaphore=semaphore, access="request", waitingBehaviour="active")
    return [request, ticks, plan.new("SemaphoreAccess", semaphore=semaphore, access="release")]


def _demand(plan: Plan, index: int, lower: int) -> Object:
    bounds = {"lowerBound": lower, "upperBound": 2 * lower}
    average = 1.4 * lower
    match index % 6:
        case 0 | 1 | 2:
            return plan.new(
                "DiscreteValueWeibullEstimatorsDistribution", **bounds, average=round(average, 1), pRemainPromille="5.0E-4"
            )
        case 3:
            return plan.new("DiscreteValueStatistics", **bounds, average=round(average, 1))
        case 4:
            return plan.new("DiscreteValueGaussDistribution", **bounds, mean=round(average, 1), sd=50.0)
    return plan.new("DiscreteValueBoundaries", **bounds, samplingType="WorstCase")


def _properties(plan: Plan, output: Object) -> list[Object]:
    versions = [plan.new("IntegerObject", value=plan.random.randrange(100)) for _ in range(3)]
    return [
        plan.custom_property("source", "StringObject", "ctrl/main.c"),
        plan.custom_property("main output", "ReferenceObject", output),
        plan.new("CustomProperty", key="versions", value=plan.new("ListObject", values=versions)),
    ]


# Processes


def _stimulus(plan: Plan, number: int, others: list[Application]) -> Object:
    """The stimulus of the process; every ninth is fired by the process before."""
    name = title("Stimulus", number)
    if number % 9 != 8:
        return new_stimulus(plan, number, name)
    if number % 2:
        event = plan.new("CustomEvent", name=f"Request {number}", eventType="request")
        plan.place("eventModel", "events", event)
        stimulus = plan.new("EventStimulus", name=name, triggeringEvents=[event], counter=plan.new("Counter", prescaler=2))
        trigger = {"CustomEventTrigger": {"event": event}}
    else:
        stimulus = plan.new("InterProcessStimulus", name=name)
        trigger = {"InterProcessTrigger": {"stimulus": stimulus}}
    plan.place("stimuliModel", "stimuli", stimulus)
    graph = others[-1].graph
    with plan.at(graph.document):
        graph.add("items", *(plan.new(cls, **values) for cls, values in trigger.items()))
    return stimulus


def _process(plan: Plan, platform: Platform, number: int, runnables: list[Object], stimulus: Object) -> tuple[Object, Object]:
    """The process and its activity graph."""
    calls = [_call(plan, runnable, index) for index, runnable in enumerate(runnables)]
    cut = len(calls) // 2
    items = [plan.new("Group", name=title("Sequence", number), items=calls[:cut])]
    match number % 6:
        case 0:
            items.append(_mode_switch(plan, platform, calls[cut:]))
        case 3:
            items.append(_probability_switch(plan, calls[cut:]))
        case 4:
            items += [plan.new("SchedulePoint"), plan.new("Group", interruptible=False, items=calls[cut:])]
        case _:
            items.append(plan.new("Group", items=calls[cut:]))
    graph = plan.new("ActivityGraph", items=items)
    if _is_isr(number):
        process = plan.new("ISR", name=title("ISR", number), category="CATEGORY_2")
        plan.place("swModel", "isrs", process)
    else:
        preemption = "cooperative" if number % 6 == 4 else "preemptive"
        process = plan.new("Task", name=title("Task", number), preemption=preemption, multipleTaskActivationLimit=1)
        plan.place("swModel", "tasks", process)
    process.values.update(activityGraph=graph, stimuli=[stimulus])
    return process, graph


def _is_isr(number: int) -> bool:
    return number % 7 == 1


def _call(plan: Plan, runnable: Object, index: int) -> Object:
    call = plan.new("RunnableCall", runnable=runnable)
    if index % 4 == 3:
        call.values["statistic"] = plan.new(
            "RunEntityCallStatistic", statistic=plan.new("SingleValueStatistic", value=float(1 + index % 3))
        )
    return call


def _mode_switch(plan: Plan, platform: Platform, calls: list[Object]) -> Object:
    driving = plan.new("ModeValueCondition", label=platform.mode_label, value="driving", relation="EQUAL")
    entry = plan.new(
        "SwitchEntry", name="while driving", condition=plan.new("ConditionDisjunction", entries=[driving]), items=calls[:-1]
    )
    return plan.new("Switch", entries=[entry], defaultEntry=plan.new("SwitchDefault", items=calls[-1:]))


def _probability_switch(plan: Plan, calls: list[Object]) -> Object:
    entries = [
        plan.new("ProbabilitySwitchEntry", probability=probability, items=items)
        for probability, items in ((0.75, calls[:-1]), (0.25, calls[-1:]))
    ]
    return plan.new("ProbabilitySwitch", entries=entries)


def _allocate(plan: Plan, controller: Controller, number: int, process: Object) -> None:
    if process.cls == "ISR":
        allocation = plan.new("ISRAllocation", isr=process, controller=controller.interrupts, priority=1 + number % 20)
        plan.place("mappingModel", "isrAllocation", allocation)
        return
    core = number % CORES
    scheduler = controller.schedulers[core]
    allocation = plan.new("TaskAllocation", task=process, scheduler=scheduler, affinity=[controller.cores[core]])
    (definition,) = scheduler.objects("definition")
    for key in definition.objects("processParameters"):
        allocation.add("schedulingParameters", _parameter(plan, key, number))
    plan.place("mappingModel", "taskAllocation", allocation)


def _parameter(plan: Plan, key: Object, number: int) -> Object:
    match key.name:
        case "deadline":
            value = plan.time(5 + number % 90, "ms")
        case "taskGroup":
            value = plan.new("IntegerObject", value=number % 3)
        case _:
            value = plan.new("IntegerObject", value=1 + number % 30)
    return plan.new("SchedulingParameter", key=key, value=value)


# Events, chains, constraints


def _events_and_chains(
    plan: Plan, number: int, process: Object, runnables: list[Object], labels: list[Object], others: list[Application]
) -> Object:
    """The chain through the process; every third application also has one through the process before and itself."""
    start, middle, end = (
        plan.new("RunnableEvent", name=f"{runnable.name} {kind}", eventType=kind, entity=runnable, process=process)
        for runnable, kind in ((runnables[0], "start"), (runnables[1], "start"), (runnables[-1], "terminate"))
    )
    plan.place(
        "eventModel",
        "events",
        start,
        middle,
        end,
        plan.new("ProcessEvent", name=f"{process.name} activate", eventType="activate", entity=process),
        plan.new("LabelEvent", name=f"{labels[0].name} write", eventType="write", entity=labels[0], runnable=runnables[0]),
    )
    steps = [_step(plan, start, middle), _step(plan, middle, end)]
    chain = plan.new("EventChain", name=title("Chain", number), stimulus=start, response=end, items=steps, itemType="sequence")
    plan.place("constraintsModel", "eventChains", chain)
    if number % 3 == 2:
        plan.place("constraintsModel", "eventChains", _joined(plan, number, others[-1].chain, chain))
    return chain


def _step(plan: Plan, stimulus: Object, response: Object) -> Object:
    part = plan.new("SubEventChain", name=f"to {response.name}", stimulus=stimulus, response=response)
    return plan.new("EventChainContainer", eventChain=part)


def _joined(plan: Plan, number: int, first: Object, second: Object) -> Object:
    """A chain of two chains with the step between them."""
    (stimulus,), (handover,) = first.objects("stimulus"), first.objects("response")
    (entry,), (response,) = second.objects("stimulus"), second.objects("response")
    items = [
        plan.new("EventChainReference", eventChain=first),
        _step(plan, handover, entry),
        plan.new("EventChainReference", eventChain=second),
    ]
    name = title("Joined chain", number)
    return plan.new("EventChain", name=name, stimulus=stimulus, response=response, items=items, itemType="sequence")


def _constraints(
    plan: Plan, number: int, process: Object, runnables: list[Object], labels: list[Object], chain: Object
) -> None:
    latency = plan.new(
        "EventChainLatencyConstraint",
        name=title("Latency", number),
        scope=chain,
        type="Age" if number % 2 else "Reaction",
        minimum=plan.time(10, "us"),
        maximum=plan.time(20 + number % 200, "ms"),
    )
    plan.place("constraintsModel", "timingConstraints", latency)
    if number % 4 == 1:
        age = plan.new("DataAgeTime", minimumTime=plan.time(0, "ms"), maximumTime=plan.time(100, "ms"))
        plan.place(
            "constraintsModel",
            "dataAgeConstraints",
            plan.new("DataAgeConstraint", name=title("Age", number), runnable=runnables[0], label=labels[0], dataAge=age),
        )
    limits = [
        ("ProcessRequirement", {"process": process}, "ResponseTime"),
        ("RunnableRequirement", {"runnable": runnables[0]}, "NetExecutionTime"),
    ]
    for cls, target, metric in limits:
        limit = plan.new(
            "TimeRequirementLimit", limitType="UpperLimit", metric=metric, limitValue=plan.time(5 + number % 95, "ms")
        )
        name = f"{metric} of {title('application', number)}"
        plan.place("constraintsModel", "requirements", plan.new(cls, name=name, severity="Critical", limit=limit, **target))
