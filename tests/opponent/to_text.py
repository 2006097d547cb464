"""A system in the plain form as the text of a model."""

from __future__ import annotations

from itertools import pairwise, starmap
from typing import Any

from opponent.models import writing
from opponent.models.writing import Parts
from opponent.systems import Item, PlainSystem, items_of

POLICIES = {
    "FPP": "FixedPriorityPreemptive",
    "OSEK": "OSEK",
    "EDF": "EarliestDeadlineFirst",
    "RR": "PriorityBasedRoundRobin",
}
IMPLEMENTATIONS = {"implicit": "implicit", "explicit": "explicit", "LET": "timed"}


def to_text(plain: PlainSystem) -> str:
    """The file."""
    parts = Parts(cores=dict.fromkeys(plain["cores"], "1.0"))
    for core, policy in plain["cores"].items():
        parts.schedulers.append(writing.scheduler(f"S{core}", POLICIES[policy]))
        parts.allocations.append(writing.scheduler_allocation(f"S{core}", core))
    parts.semaphores += [writing.semaphore(name, has_ceiling=given["ceiling"]) for name, given in plain["semaphores"].items()]
    implementation = IMPLEMENTATIONS[plain["chain"]["communication"]] if "chain" in plain else ""
    for name in sorted({item["read"] for item in items_of(plain) if "read" in item}):
        parts.data.append(writing.label(name))
    for name, body in plain["runnables"].items():
        parts.runnables.append(writing.runnable(name, _text(body, implementation)))
    for process in plain["processes"]:
        _add_process(parts, plain, process, _text(process["body"], implementation))
    if "chain" in plain:
        _add_chain(parts, plain)
    return parts.text()


def _add_process(parts: Parts, plain: PlainSystem, process: dict[str, Any], body: str) -> None:
    name, core = process["name"], process["core"]
    stimulus = _add_stimulus(parts, process)
    if process["kind"] == "isr":
        parts.isrs.append(writing.isr(name, stimulus, body))
        parts.allocations.append(writing.isr_allocation(name, core, process["priority"]))
        return
    parts.tasks.append(writing.task(name, stimulus, body, process["preemption"].replace("-", "_")))
    urgency = {"EDF": ("deadline",), "RR": ("priority", "slice")}.get(plain["cores"][core], ("priority",))
    names = {"slice": "timeSliceLength"}
    given = {names.get(key, key): process[key] for key in urgency if key in process}
    parts.allocations.append(writing.task_allocation(name, f"S{core}", given))


def _add_stimulus(parts: Parts, process: dict[str, Any]) -> str:
    """Add what activates a process, and give the reference to it."""
    (kind, given), *_ = process["arrival"].items()
    if kind == "trigger":
        kind, content = "InterProcess", _counter(given)
    elif kind == "sporadic":
        distance = writing.times("nextOccurrence", given["least"], given["most"])
        kind, content = "RelativePeriodic", writing.time("offset", given["offset"]) + distance
    else:
        kind, content = "Periodic", writing.time("recurrence", given["period"]) + writing.time("offset", given.get("offset", 0))
        content += writing.times("jitter", 0, given["jitter"]) if "jitter" in given else ""
    parts.stimuli.append(writing.stimulus(kind, f"s{process['name']}", "", content))
    return f"s{process['name']}?type={kind}Stimulus"


def _counter(given: dict[str, Any]) -> str:
    return writing.counter(given["prescaler"], given["offset"]) if "prescaler" in given else ""


def _text(body: list[Item], implementation: str) -> str:
    return "".join(_item(item, implementation) for item in body)


def _item(item: Item, implementation: str) -> str:
    match item:
        case {"execute": [least, most]}:
            return writing.ticks(least, most)
        case {"call": runnable}:
            return writing.item("RunnableCall", f'runnable="{runnable}?type=Runnable"', _counter(item))
        case {"group": body}:
            inner = _text(body, implementation)
            return writing.group(inner, is_ordered=item.get("ordered", True), is_interruptible=item.get("interruptible", True))
        case {"switch": branches}:
            return writing.chance((weight, _text(body, implementation)) for weight, body in branches)
        case {"request": semaphore}:
            return writing.semaphore_access(semaphore, "request")
        case {"release": semaphore}:
            return writing.semaphore_access(semaphore, "release")
        case {"point": _}:
            return writing.item("SchedulePoint")
        case {"trigger": process}:
            stimulus = f'stimulus="s{process}?type=InterProcessStimulus"'
            return writing.item("InterProcessTrigger", stimulus, _counter(item))
    access, label = next(iter(item.items()))
    return writing.label_access(label, access, implementation)


def _add_chain(parts: Parts, plain: PlainSystem) -> None:
    """From the start of the first process to the end of the last one, over the ends of those in between."""
    kinds = {process["name"]: "ISR" if process["kind"] == "isr" else "Task" for process in plain["processes"]}
    events = []
    for number, name in enumerate(plain["chain"]["processes"]):
        change = "terminate" if number else "start"
        parts.events.append(writing.process_event(f"{name} {change}", name, kinds[name], change))
        events.append(f"{name}+{change}?type=ProcessEvent")
    parts.chains.append(writing.chain("chain", events[0], events[-1], starmap(writing.step, pairwise(events))))
