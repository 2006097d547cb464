"""The platform of a synthetic model: definitions, controllers with their hardware and operating systems, data types."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from amalthea_uros.metamodel.factfile import FeatureKind
from synthesis.plan import title

if TYPE_CHECKING:
    from synthesis.objects import Object
    from synthesis.plan import Plan

CORES = 4

_PARAMETER_TYPES = {"priority": "Integer", "taskGroup": "Integer", "deadline": "Time"}
_SCHEDULERS = {
    "OSEK": ["priority", "taskGroup"],
    "FixedPriorityPreemptive": ["priority"],
    "EarliestDeadlineFirst": ["deadline"],
    "PriorityBased": ["priority"],
}
_SCHEDULER_OF_CORE = ["OSEK", "FixedPriorityPreemptive", "OSEK", "EarliestDeadlineFirst"]


@dataclass(frozen=True)
class Controller:
    """What applications need of one controller."""

    cores: list[Object]
    memories: list[Object]
    schedulers: list[Object]
    interrupts: Object
    semaphores: list[Object]


@dataclass(frozen=True)
class Platform:
    """What the applications share; controllers are added as they are needed."""

    hardware: dict[str, Object]
    scheduler_definitions: dict[str, Object]
    overhead: Object
    sections: list[Object]
    types: list[Object]
    tags: list[Object]
    namespaces: list[Object]
    mode_label: Object
    controllers: list[Controller] = field(default_factory=list)


def new_platform(plan: Plan) -> Platform:
    """The platform without controllers."""
    plan.roots[0].add("customProperties", plan.custom_property("generator", "StringObject", 'the "synthetic" one'))
    return Platform(
        hardware=_hardware_definitions(plan),
        scheduler_definitions=_scheduler_definitions(plan, _parameters(plan)),
        overhead=_overhead(plan),
        sections=_placed(plan, "swModel", "sections", [plan.new("Section", name=f".data {n}") for n in range(4)]),
        types=_types(plan),
        tags=_placed(plan, "commonElements", "tags", [plan.new("Tag", name=f"Release {n}") for n in range(3)]),
        namespaces=_placed(
            plan, "commonElements", "namespaces", [plan.new("Namespace", name=n) for n in ("engine", "body control")]
        ),
        mode_label=_mode_label(plan),
    )


def _placed(plan: Plan, submodel: str, feature: str, objects: list[Object]) -> list[Object]:
    plan.place(submodel, feature, *objects)
    return objects


def _hardware_definitions(plan: Plan) -> dict[str, Object]:
    category = plan.new("HwFeatureCategory", name="Instructions", featureType="performance", description="per cycle\nand core")
    slow, fast = (plan.new("HwFeature", category, name=f"IPC_{value}", value=value) for value in (0.8, 1.2))
    category.add("features", slow, fast)
    found = {
        "big": plan.new("ProcessingUnitDefinition", name="Big core", puType="CPU", features=[fast]),
        "small": plan.new("ProcessingUnitDefinition", name="Small core", puType="CPU", features=[slow]),
        "crossbar": plan.new("ConnectionHandlerDefinition", name="Crossbar", policy="RoundRobin", readLatency=plan.constant(1)),
        "ram": plan.new(
            "MemoryDefinition", name="RAM", size=plan.size(512, "KiB"), accessLatency=plan.constant(9), memoryType="SRAM"
        ),
        "flash": plan.new(
            "MemoryDefinition",
            name="Flash",
            size=plan.size(4, "MiB"),
            accessLatency=plan.new("DiscreteValueBoundaries", lowerBound=4, upperBound=16, samplingType="WorstCase"),
            dataRate=plan.new("DataRate", value=800, unit="MBPerSecond"),
            memoryType="FLASH",
        ),
        "cache": plan.new(
            "CacheDefinition", name="L1", size=plan.size(32, "KiB"), cacheType="data", writeStrategy="writeback", hitRate=0.95
        ),
    }
    plan.place("hwModel", "definitions", *found.values())
    plan.place("hwModel", "featureCategories", category)
    return found


def _parameters(plan: Plan) -> dict[str, Object]:
    found = {
        name: plan.new("SchedulingParameterDefinition", name=name, type=kind, mandatory=name != "taskGroup")
        for name, kind in _PARAMETER_TYPES.items()
    }
    found["taskGroup"].values["defaultValue"] = plan.new("IntegerObject", value=0)
    plan.place("osModel", "schedulingParameterDefinitions", *found.values())
    return found


def _scheduler_definitions(plan: Plan, parameters: dict[str, Object]) -> dict[str, Object]:
    found = {
        name: plan.new("SchedulerDefinition", name=name, processParameters=[parameters[key] for key in keys])
        for name, keys in _SCHEDULERS.items()
    }
    plan.place("osModel", "schedulerDefinitions", *found.values())
    return found


def _overhead(plan: Plan) -> Object:
    calls = {call: _ticks(plan, 100) for call in ("apiTerminateTask", "apiSetEvent", "apiActivateTask")}
    entry = plan.new("OsISROverhead", preExecutionOverhead=_ticks(plan, 60), postExecutionOverhead=_ticks(plan, 40))
    overhead = plan.new(
        "OsOverhead", name="Overhead", apiOverhead=plan.new("OsAPIOverhead", **calls), isrCategory2Overhead=entry
    )
    plan.place("osModel", "osOverheads", overhead)
    return overhead


def _ticks(plan: Plan, value: int) -> Object:
    return plan.new("Ticks", default=plan.constant(value))


def _types(plan: Plan) -> list[Object]:
    types = [plan.new("BaseTypeDefinition", name=f"uint{bits}", size=plan.size(bits, "bit")) for bits in (8, 16, 32, 64)]
    aliases = [plan.new("Alias", target="C", alias="unsigned char"), plan.new("Alias", target="AUTOSAR", alias="uint8")]
    types[0].add("aliases", *aliases)
    plan.place("swModel", "typeDefinitions", *types)
    return types


def _mode_label(plan: Plan) -> Object:
    mode = plan.new("EnumMode", name="Vehicle mode")
    mode.add("literals", *(plan.new("ModeLiteral", mode, name=name) for name in ("off", "driving", "limp home")))
    label = plan.new("ModeLabel", name="Current mode", displayName="mode", mode=mode, initialValue="off")
    plan.place("swModel", "modes", mode)
    plan.place("swModel", "modeLabels", label)
    return label


def data_type(plan: Plan, definition: Object) -> Object:
    """The data type of a label: the definition itself, or an object that refers to it where the version demands that."""
    feature = plan.facts.feature("Label", "dataType")
    if feature is not None and feature.kind is FeatureKind.REFERENCE:
        return definition
    return plan.new("TypeRef", typeDef=definition)


def add_controller(plan: Plan, platform: Platform) -> None:
    """Adds a controller with its hardware, operating system and scheduler allocations."""
    number = len(platform.controllers)
    domain = plan.new(
        "FrequencyDomain", name=title("Clock", number), defaultValue=plan.new("Frequency", value=300.0, unit="MHz")
    )
    power = plan.new("PowerDomain", name=title("Supply", number), defaultValue=plan.new("Voltage", value=1.8, unit="V"))
    plan.place("hwModel", "domains", domain, power)
    memories = [
        plan.new("Memory", name=f"{name} {number}", frequencyDomain=domain, definition=platform.hardware[kind])
        for name, kind in (("RAM", "ram"), ("Local RAM", "ram"), ("Flash", "flash"))
    ]
    cores = [_core(plan, platform, f"Core {number}.{core}", domain, power) for core in range(CORES)]
    _connect(plan, platform, title("ECU", number), cores, memories)
    schedulers = [_scheduler(plan, platform, core, kind) for core, kind in zip(cores, _SCHEDULER_OF_CORE, strict=True)]
    interrupts = plan.new(
        "InterruptController",
        name=title("Interrupts", number),
        definition=platform.scheduler_definitions["PriorityBased"],
    )
    plan.place(
        "mappingModel",
        "schedulerAllocation",
        plan.new("SchedulerAllocation", scheduler=interrupts, responsibility=cores, executingPU=cores[0]),
    )
    plan.place("osModel", "operatingSystems", _operating_system(plan, platform, number, schedulers, interrupts))
    semaphores = [
        plan.new("Semaphore", name=f"Resource {number}.{n}", semaphoreType="Resource", priorityCeilingProtocol=True)
        for n in range(2)
    ]
    plan.place("osModel", "semaphores", *semaphores)
    platform.controllers.append(Controller(cores, memories, schedulers, interrupts, semaphores))


def _core(plan: Plan, platform: Platform, name: str, frequency: Object, power: Object) -> Object:
    return plan.new(
        "ProcessingUnit",
        name=name,
        powerDomain=power,
        frequencyDomain=frequency,
        definition=platform.hardware["small" if name.endswith("3") else "big"],
        caches=[plan.new("Cache", name=f"L1 of {name}", definition=platform.hardware["cache"])],
    )


def _connect(plan: Plan, platform: Platform, name: str, cores: list[Object], memories: list[Object]) -> None:
    """Puts cores and memories around a crossbar and describes the way of each core to each memory."""
    chip = plan.new("HwStructure", name=f"{name} chip", structureType="Microcontroller")
    crossbar = plan.new("ConnectionHandler", name=f"{name} crossbar", definition=platform.hardware["crossbar"])
    ways = {module.name: _connection(plan, chip, crossbar, module) for module in (*cores, *memories)}
    for core in cores:
        for memory in memories:
            core.add("accessElements", _access(plan, memory, [ways[core.name], crossbar, ways[memory.name]]))
    chip.add("modules", *cores, *memories, crossbar)
    chip.add("connections", *ways.values())
    bus = plan.new("HwPort", chip, name="CAN", bitWidth=1, portType="initiator", portInterface="CAN")
    chip.add("ports", bus)
    plan.place("hwModel", "structures", plan.new("HwStructure", name=name, structureType="ECU", structures=[chip]))


def _connection(plan: Plan, chip: Object, crossbar: Object, module: Object) -> Object:
    initiator, responder = (crossbar, module) if module.cls == "Memory" else (module, crossbar)
    name = f"{initiator.name} to {responder.name}"
    sides = ((initiator, "initiator"), (responder, "responder"))
    ports = [plan.new("HwPort", owner, name=name, bitWidth=32, portType=kind, portInterface="AHB") for owner, kind in sides]
    initiator.add("ports", ports[0])
    responder.add("ports", ports[1])
    rate = plan.new("DataRate", value=1200, unit="MBPerSecond")
    return plan.new("HwConnection", chip, name=name, dataRate=rate, port1=ports[0], port2=ports[1])


def _access(plan: Plan, memory: Object, way: list[Object]) -> Object:
    path = plan.new("HwAccessPath", pathElements=way, endAddress="0x7ffff")
    return plan.new(
        "HwAccessElement",
        name=f"to {memory.name}",
        destination=memory,
        accessPath=path,
        readLatency=plan.constant(9),
        writeLatency=plan.new("DiscreteValueBoundaries", lowerBound=1, upperBound=9),
    )


def _scheduler(plan: Plan, platform: Platform, core: Object, kind: str) -> Object:
    scheduler = plan.new(
        "TaskScheduler",
        name=f"{kind} on {core.name}",
        definition=platform.scheduler_definitions[kind],
        computationItems=[_ticks(plan, 50)],
    )
    allocation = plan.new("SchedulerAllocation", scheduler=scheduler, responsibility=[core], executingPU=core)
    plan.place("mappingModel", "schedulerAllocation", allocation)
    return scheduler


def _operating_system(plan: Plan, platform: Platform, number: int, schedulers: list[Object], interrupts: Object) -> Object:
    return plan.new(
        "OperatingSystem",
        name=title("OS", number),
        overhead=platform.overhead,
        taskSchedulers=schedulers,
        interruptControllers=[interrupts],
        osDataConsistency=plan.new("OsDataConsistency", mode="handledByModelElements"),
    )
