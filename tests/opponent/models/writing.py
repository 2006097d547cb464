"""The text of a model from its parts."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

DEFINITIONS = {
    "FixedPriorityPreemptive": ("priority",),
    "OSEK": ("priority",),
    "EarliestDeadlineFirst": ("deadline",),
    "DeadlineMonotonic": ("deadline",),
    "PriorityBasedRoundRobin": ("priority", "timeSliceLength"),
    "DeferrableServer": ("priority", "capacity", "period"),
    "PollingPeriodicServer": ("priority", "capacity", "period"),
    "PriorityBased": (),
}
PARAMETERS = {"priority": "Integer", "deadline": "Time", "timeSliceLength": "Time", "capacity": "Time", "period": "Time"}


@dataclass(slots=True)
class Parts:
    """Elements by the sections of a model, as text."""

    tasks: list[str] = field(default_factory=list)
    isrs: list[str] = field(default_factory=list)
    runnables: list[str] = field(default_factory=list)
    data: list[str] = field(default_factory=list)
    cores: dict[str, str] = field(default_factory=dict)
    schedulers: list[str] = field(default_factory=list)
    overheads: list[str] = field(default_factory=list)
    semaphores: list[str] = field(default_factory=list)
    stimuli: list[str] = field(default_factory=list)
    events: list[str] = field(default_factory=list)
    chains: list[str] = field(default_factory=list)
    allocations: list[str] = field(default_factory=list)

    def text(self) -> str:
        """The file."""
        with_overhead = ' overhead="ov?type=OsOverhead"' if self.overheads else ""
        controllers = [
            f'<interruptControllers xmi:id="I{core}?type=InterruptController" name="I{core}" '
            'definition="PriorityBased?type=SchedulerDefinition"/>'
            for core in self.cores
        ]
        controlled = [
            f'<schedulerAllocation scheduler="I{core}?type=InterruptController" responsibility="{core}?type=ProcessingUnit"/>'
            for core in self.cores
        ]
        return "\n".join(
            [
                '<?xml version="1.0" encoding="UTF-8"?>',
                '<am:Amalthea xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" '
                'xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns:am="http://app4mc.eclipse.org/amalthea/3.3.0">',
                *_section("swModel", [*self.tasks, *self.isrs, *self.runnables, *self.data]),
                "<hwModel>",
                '<structures xmi:id="ECU?type=HwStructure" name="ECU" structureType="ECU">',
                *(
                    f'<modules xsi:type="am:ProcessingUnit" xmi:id="{core}?type=ProcessingUnit" name="{core}" '
                    f'frequencyDomain="k{core}?type=FrequencyDomain"/>'
                    for core in self.cores
                ),
                "</structures>",
                *(
                    f'<domains xsi:type="am:FrequencyDomain" xmi:id="k{core}?type=FrequencyDomain" name="k{core}" clockGating="false">'
                    f'<defaultValue value="{frequency}" unit="MHz"/></domains>'
                    for core, frequency in self.cores.items()
                ),
                "</hwModel>",
                "<osModel>",
                f'<operatingSystems name="OS"{with_overhead}>',
                *self.schedulers,
                *controllers,
                "</operatingSystems>",
                *self.semaphores,
                *self.overheads,
                *map(_definition, DEFINITIONS),
                *(
                    f'<schedulingParameterDefinitions xmi:id="{name}?type=SchedulingParameterDefinition" name="{name}" '
                    f'type="{kind}" many="false" mandatory="true"/>'
                    for name, kind in PARAMETERS.items()
                ),
                "</osModel>",
                *_section("stimuliModel", self.stimuli),
                *_section("eventModel", self.events),
                *_section("constraintsModel", self.chains),
                *_section("mappingModel", [*controlled, *self.allocations]),
                "</am:Amalthea>\n",
            ]
        )


def _section(name: str, parts: Iterable[str]) -> list[str]:
    return [f"<{name}>", *parts, f"</{name}>"]


def _definition(name: str) -> str:
    given = " ".join(f"{parameter}?type=SchedulingParameterDefinition" for parameter in DEFINITIONS[name])
    is_server = "true" if "Server" in name else "false"
    parameters = f' processParameters="{given}"' if given else ""
    return (
        f'<schedulerDefinitions xmi:id="{name}?type=SchedulerDefinition" name="{name}"{parameters} '
        f'requiresParentScheduler="{is_server}" passesParametersUpwards="false" hasExactlyOneChild="false"/>'
    )


def scheduler(name: str, policy: str, content: str = "") -> str:
    """A scheduler of tasks."""
    return (
        f'<taskSchedulers xmi:id="{name}?type=TaskScheduler" name="{name}" definition="{policy}?type=SchedulerDefinition">'
        f"{content}</taskSchedulers>"
    )


def parameter(name: str, value: int) -> str:
    """A scheduling parameter; times in microseconds."""
    kind = "am:Time" if PARAMETERS[name] == "Time" else "am:IntegerObject"
    unit = ' unit="us"' if PARAMETERS[name] == "Time" else ""
    return (
        f'<schedulingParameters key="{name}?type=SchedulingParameterDefinition">'
        f'<value xsi:type="{kind}" value="{value}"{unit}/></schedulingParameters>'
    )


def item(kind: str, attributes: str = "", content: str = "") -> str:
    """An item of a graph."""
    return (
        f'<items xsi:type="am:{kind}" {attributes}>{content}</items>'
        if content
        else f'<items xsi:type="am:{kind}" {attributes}/>'
    )


def ticks(least: int, most: int) -> str:
    """An execution."""
    if least == most:
        return item("Ticks", content=f'<default xsi:type="am:DiscreteValueConstant" value="{least}"/>')
    return item("Ticks", content=f'<default xsi:type="am:DiscreteValueBoundaries" lowerBound="{least}" upperBound="{most}"/>')


def time(tag: str, value: int) -> str:
    """A time in microseconds."""
    return f'<{tag} value="{value}" unit="us"/>'


def stimulus(kind: str, name: str, attributes: str = "", content: str = "") -> str:
    """A stimulus."""
    return f'<stimuli xsi:type="am:{kind}Stimulus" xmi:id="{name}?type={kind}Stimulus" name="{name}" {attributes}>{content}</stimuli>'


def times(tag: str, least: int, most: int) -> str:
    """A time between two others in microseconds, each as likely."""
    if least == most:
        return f'<{tag} xsi:type="am:TimeConstant">{time("value", least)}</{tag}>'
    return f'<{tag} xsi:type="am:TimeUniformDistribution">{time("lowerBound", least)}{time("upperBound", most)}</{tag}>'


def counter(prescaler: int, offset: int) -> str:
    """What lets only some occurrences take effect."""
    return f'<counter prescaler="{prescaler}" offset="{offset}"/>'


def group(content: str, *, is_ordered: bool = True, is_interruptible: bool = True) -> str:
    """A group of items."""
    return item("Group", f'ordered="{str(is_ordered).lower()}" interruptible="{str(is_interruptible).lower()}"', content)


def chance(branches: Iterable[tuple[float, str]]) -> str:
    """One of several branches, by their weights."""
    entries = (f'<entries probability="{float(weight)}">{content}</entries>' for weight, content in branches)
    return item("ProbabilitySwitch", content="".join(entries))


def label_access(label: str, access: str, implementation: str) -> str:
    """A read or write access."""
    return item("LabelAccess", f'data="{label}?type=Label" access="{access}" implementation="{implementation}"')


def semaphore_access(semaphore: str, access: str) -> str:
    """A request or a release."""
    return item("SemaphoreAccess", f'semaphore="{semaphore}?type=Semaphore" access="{access}" waitingBehaviour="passive"')


def semaphore(name: str, *, has_ceiling: bool) -> str:
    """A semaphore for one."""
    protocol = f'priorityCeilingProtocol="{str(has_ceiling).lower()}"'
    return f'<semaphores xmi:id="{name}?type=Semaphore" name="{name}" initialValue="0" maxValue="1" {protocol}/>'


def label(name: str) -> str:
    """A label."""
    return f'<labels xmi:id="{name}?type=Label" name="{name}" constant="false" bVolatile="false"/>'


def runnable(name: str, body: str, condition: str = "") -> str:
    """A runnable."""
    return (
        f'<runnables xmi:id="{name}?type=Runnable" name="{name}" callback="false" service="false">{condition}'
        f"<activityGraph>{body}</activityGraph></runnables>"
    )


def task(name: str, stimuli: str, body: str, preemption: str = "preemptive", limit: int = 99) -> str:
    """A task."""
    return (
        f'<tasks xmi:id="{name}?type=Task" name="{name}" stimuli="{stimuli}" preemption="{preemption}" '
        f'multipleTaskActivationLimit="{limit}"><activityGraph>{body}</activityGraph></tasks>'
    )


def isr(name: str, stimuli: str, body: str) -> str:
    """An interrupt service routine."""
    return (
        f'<isrs xmi:id="{name}?type=ISR" name="{name}" stimuli="{stimuli}" category="CATEGORY_2">'
        f"<activityGraph>{body}</activityGraph></isrs>"
    )


def scheduler_allocation(name: str, core: str) -> str:
    """The core of a scheduler of tasks."""
    return f'<schedulerAllocation scheduler="{name}?type=TaskScheduler" responsibility="{core}?type=ProcessingUnit"/>'


def task_allocation(name: str, where: str, given: dict[str, int]) -> str:
    """The scheduler of a task, with parameters."""
    parameters = "".join(parameter(key, value) for key, value in given.items())
    return f'<taskAllocation task="{name}?type=Task" scheduler="{where}?type=TaskScheduler">{parameters}</taskAllocation>'


def isr_allocation(name: str, core: str, priority: int) -> str:
    """The interrupt controller of an interrupt service routine."""
    return f'<isrAllocation isr="{name}?type=ISR" controller="I{core}?type=InterruptController" priority="{priority}"/>'


def process_event(name: str, process: str, kind: str, change: str) -> str:
    """Something that happens to a task or interrupt service routine."""
    identity = f"{name.replace(' ', '+')}?type=ProcessEvent"
    return f'<events xsi:type="am:ProcessEvent" xmi:id="{identity}" name="{name}" eventType="{change}" entity="{process}?type={kind}"/>'


def chain(name: str, stimulus: str, response: str, items: Iterable[str]) -> str:
    """An event chain of parts one after the other."""
    identity = f"{name.replace(' ', '+')}?type=EventChain"
    return (
        f'<eventChains xmi:id="{identity}" name="{name}" stimulus="{stimulus}" response="{response}" itemType="sequence" '
        f'minItemsCompleted="1">{"".join(items)}</eventChains>'
    )


def step(stimulus: str, response: str) -> str:
    """A part of a chain from an event to the next one."""
    return (
        f'<items xsi:type="am:EventChainContainer"><eventChain name="" stimulus="{stimulus}" response="{response}" '
        f'minItemsCompleted="1"/></items>'
    )
