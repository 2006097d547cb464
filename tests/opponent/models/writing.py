"""The text of a model from its parts."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

DEFINITIONS = {
    "FixedPriorityPreemptive": ("priority",),
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
