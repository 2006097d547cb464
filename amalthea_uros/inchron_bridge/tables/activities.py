"""Activities of processes and functions: the entries of their call graphs."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from amalthea_uros.inchron.objects import ProjectObject
from amalthea_uros.inchron_bridge.basics.comments import keep_whole, note
from amalthea_uros.inchron_bridge.basics.exporting import Exporting
from amalthea_uros.inchron_bridge.tables.conditions import build_condition, numbered, whole_number
from amalthea_uros.inchron_bridge.tables.demand import of_every_core_type
from amalthea_uros.inchron_bridge.tables.distributions import build_demand
from amalthea_uros.inchron_bridge.tables.rows import Row, choice, refers, refers_to_several
from amalthea_uros.perf import activities as perf
from amalthea_uros.perf.stimuli import Counter

#: What an activity is called that comes as a whole from a comment.
ACTIVITY = "activity"
#: And a group, in the comment of the first of the entries that stand for it.
GROUP = "group"

ACCESSES = {perf.AccessKind.READ: "Read", perf.AccessKind.WRITE: "Write"}
MODIFICATIONS = {perf.ModeOperation(name.lower()): name for name in ("Set", "Increment", "Decrement")}
_OPERATIONS = ("Request", "Exclusive", "Release")
_DATA_ACCESS = "memory.ExplicitDataAccess"


def data_access(label: str, kind: perf.AccessKind, context: Exporting) -> ProjectObject:
    """An access to a variable."""
    target = context.need("DataObject", label, context.holder)
    rate = ProjectObject("DataRate", value=0)
    return ProjectObject(_DATA_ACCESS, accessType=ACCESSES[kind], dataObject=target, bandwidth=rate)


#: Activities that are one item of a call sequence each, with the beginnings of their names.
ROWS: dict[type[Any], tuple[str, Row]] = {
    row.item: (prefix, row)
    for prefix, row in {
        "Call_{runnable}": Row(perf.Call, "FunctionCall", ("times",), runnable=refers("function", "Function")),
        "InterProcessTrigger_{stimulus}": Row(
            perf.Trigger, "ActivationItem", stimulus=refers("connection", "ActivationConnection")
        ),
        "SemaphoreAccess_{semaphore}": Row(
            perf.SemaphoreAccess,
            "SemaphoreAccess",
            ("waiting",),
            semaphore=refers("semaphore", "Semaphore"),
            operation=choice("type", {perf.SemaphoreOperation(name.lower()): name for name in _OPERATIONS}),
        ),
        "SchedulePoint": Row(perf.SchedulePoint, "SchedulePoint"),
    }.items()
}
_SERVER = refers("serverFunction", "Function")
_RESULT = refers("resultFunction", "Function")
_WAITING = choice("waitingBehavior", {perf.Waiting.ACTIVE: "Active", perf.Waiting.PASSIVE: "Passive"})
_BLOCKING = choice("blockingType", {perf.Waiting.ACTIVE: "ActiveWait", perf.Waiting.PASSIVE: "PassiveWait"})
_CALL, _KEPT = perf.ServerCall, ("waits", "waiting")
#: Server calls have a class for each kind.
SERVER_CALLS: dict[perf.ServerCallKind, tuple[str, Row]] = {
    kind: (f"{prefix}ServerCall_{{runnable}}", row)
    for kind, prefix, row in (
        (
            perf.ServerCallKind.SYNCHRONOUS,
            "Sync",
            Row(_CALL, "SynchronousServerCall", _KEPT, runnable=_SERVER, waiting=_WAITING),
        ),
        (
            perf.ServerCallKind.ASYNCHRONOUS,
            "Async",
            Row(_CALL, "AsynchronousServerCall", _KEPT, runnable=_SERVER, result=_RESULT),
        ),
        (perf.ServerCallKind.GET_RESULT, "GetResult", Row(_CALL, "GetResultServerCall", runnable=_SERVER, waiting=_BLOCKING)),
    )
}
_NOTIFIED = refers_to_several("notifiedFunctions", "Function")


def build_graph(activities: tuple[perf.Activity, ...], context: Exporting) -> ProjectObject:
    """The call graph of a process or a function."""
    if not activities:
        return ProjectObject("CallGraph")
    context.entry = 0
    return ProjectObject("CallGraph", graphEntries=_Graph(context).entries(activities))


def next_entry(kind: str, context: Exporting) -> ProjectObject:
    """An entry with the next number in its name."""
    made = ProjectObject(kind, name=f"{kind}_{context.entry}")
    context.entry += 1
    return made


class _Graph:
    """One call graph.

    Attributes
    ----------
    number : of the next item of a call sequence
    """

    def __init__(self, context: Exporting) -> None:
        self.context = context
        self.number = 0

    def entries(self, activities: tuple[perf.Activity, ...]) -> list[ProjectObject]:
        """The entries for activities."""
        result = self.parts(activities, next_entry("CallSequence", self.context))
        return result[:-1] if _is_unused(result[-1]) else result

    def parts(self, activities: tuple[perf.Activity, ...], first: ProjectObject) -> list[ProjectObject]:
        """The entries for activities; sequences are cut where there is a branch, a loop or a group, as the importer of INCHRON does.

        Parameters
        ----------
        first : the sequence that they begin with
        """
        result = [first]
        for activity in activities:
            match activity:
                case perf.Group():
                    made = self.group(activity)
                case perf.Switch():
                    made = [self.switch(activity)]
                case perf.ProbabilitySwitch():
                    made = [self.probability_switch(activity)]
                case perf.Loop():
                    made = [self.loop(activity)]
                case _:
                    for item in self.items(activity):
                        result[-1].add("calls", item)
                    continue
            if _is_unused(result[-1]):
                result.pop()
            result += [*made, next_entry("CallSequence", self.context)]
        return result

    def group(self, group: perf.Group) -> list[ProjectObject]:
        """A sequence with the name of the group, and beside it what follows a branch in the group, as sequences cannot be nested."""
        context = self.context
        if not group.ordered:
            context.lost(group, "a group without an order", "its activities are in the order in which they are stated")
        first = ProjectObject("CallSequence", name=group.name)
        if not group.interruptible:
            first.add("calls", ProjectObject("SuspendAllInterrupts", name=f"ImplicitSuspend_{group.name}"))
        result = self.parts(group.activities, first)
        if not group.interruptible:
            result[-1].add("calls", ProjectObject("ResumeAllInterrupts", name=f"ImplicitResume_{group.name}"))
        if result != [first]:
            context.changed(group, "a group with branches, loops or groups in it", "as the entries in it, one after the other")
        if not (result == [first] and group.ordered and group.name):
            keep_whole(result[0], GROUP, group)
            note(result[0], span=len(result))
        return result

    def switch(self, switch: perf.Switch) -> ProjectObject:
        """The first case whose condition holds; the conditions are numbered after those in their branches."""
        made = next_entry("Switch", self.context)
        made["evaluateConditionsOnEntry"] = True
        for number, case in enumerate(switch.cases):
            entry = ProjectObject("SwitchEntry", name=f"SwitchEntry_{number}", graphEntries=self.entries(case.activities))
            entry["condition"] = build_condition(case.condition, self.context, case)
            if case.name:
                note(entry, name=case.name)
            made.add("entries", entry)
        if switch.default is not None:
            made["defaultEntry"] = ProjectObject("SwitchDefault", graphEntries=self.entries(switch.default))
        return made

    def probability_switch(self, switch: perf.ProbabilitySwitch) -> ProjectObject:
        """One of the branches, by chance."""
        made = next_entry("ProbabilitySwitch", self.context)
        for number, branch in enumerate(switch.branches):
            name = f"ProbabilitySwitchEntry_{number}"
            entry = ProjectObject("ProbabilitySwitchEntry", name=name, probability=float(branch.weight))
            made.add("entries", entry)
            entry["graphEntries"] = self.entries(branch.activities)
        return made

    def loop(self, loop: perf.Loop) -> ProjectObject:
        """Repeated while the condition holds; the importer of INCHRON gives no name to its first sequence."""
        first = ProjectObject("CallSequence")
        result = self.parts(loop.activities, first)
        made = ProjectObject("WhileLoop", name="WhileLoop")
        made["graphEntries"] = (result[:-1] if _is_unused(result[-1]) else result) or [first]
        if loop.condition is not None:
            made["condition"] = build_condition(loop.condition, self.context, loop)
        return made

    def items(self, activity: perf.Activity) -> Iterator[ProjectObject]:
        """The items of a call sequence for an activity."""
        for item in self._items(activity):
            counter = getattr(activity, "counter", None)
            if counter is not None:
                item["period"], item["offset"] = max(1, counter.prescaler), counter.offset
                if counter != Counter(prescaler=max(1, counter.prescaler), offset=counter.offset):
                    keep_whole(item, "counter", counter)
            yield item

    def named(self, pattern: str, activity: perf.Activity) -> str:
        """The name of the next item."""
        name = pattern.format(
            **{
                name: getattr(activity, name)
                for name in ("runnable", "stimulus", "semaphore", "label")
                if hasattr(activity, name)
            }
        )
        self.number += 1
        return f"{name}_{self.number - 1}"

    def _items(self, activity: perf.Activity) -> Iterator[ProjectObject]:
        context = self.context
        if type(activity) in ROWS:
            pattern, row = ROWS[type(activity)]
            is_counted = isinstance(activity, perf.SchedulePoint)
            yield row.build(activity, context, name=numbered(pattern, context) if is_counted else self.named(pattern, activity))
            return
        match activity:
            case perf.Execute(demand=demand):
                distribution, is_exact = of_every_core_type(demand, context)
                made = build_demand(distribution, context, activity)
                item = ProjectObject("ResourceConsumption", name=self.named("Tick", activity), timeDistribution=made)
                if not is_exact:
                    keep_whole(item, ACTIVITY, activity)
                yield item
            case perf.LabelAccess(label=label, kind=kind):
                item = ProjectObject("ResourceConsumption", name=self.named("LabelAccess_{label}", activity))
                item.add("dataAccess", data_access(label, kind, context))
                context.keep(item, activity, "communication", "protection", "times")
                yield item
            case perf.Incomplete(label=str(label)) if context.find("DataObject", label) is not None:
                context.changed(activity, "an access of unknown kind", "as a read, as the importer of INCHRON takes it")
                item = ProjectObject("ResourceConsumption", name=self.named("LabelAccess_{label}", activity))
                item.add("dataAccess", data_access(label, perf.AccessKind.READ, context))
                keep_whole(item, ACTIVITY, activity)
                yield item
            case perf.ServerCall(kind=call):
                pattern, row = SERVER_CALLS[call]
                more = {"blockingType": "NonBlocking"} if call is perf.ServerCallKind.GET_RESULT and not activity.waits else {}
                item = row.build(activity, context, name=self.named(pattern, activity), **more)
                if activity.waiting is None:
                    note(item, waiting=None)  # a project always says how a client waits
                yield item
            case perf.SenderReceiverAccess():
                yield self._communication(activity)
            case perf.SetEvent(events=events) | perf.ClearEvent(events=events) | perf.WaitEvent(events=events):
                yield from self._events(activity, events)
            case perf.ModeAccess():
                yield from self._mode(activity)
            case _:
                yield self._whole(activity)

    def _communication(self, activity: perf.SenderReceiverAccess) -> ProjectObject:
        is_read = activity.kind is perf.AccessKind.READ
        kind = "VariableReadAccess" if is_read else "VariableWriteAccess"
        item = ProjectObject(kind, name=self.named(kind + "_{label}", activity))
        item["dataAccess"] = data_access(activity.label, activity.kind, self.context)
        if activity.notifies and not is_read:
            item["notifiedFunctions"] = _NOTIFIED.build(activity.notifies, self.context)
        self.context.keep(item, activity, "buffered")
        return item

    def _events(self, activity: Any, events: tuple[str, ...]) -> Iterator[ProjectObject]:
        kind = "WaitEvent" if isinstance(activity, perf.WaitEvent) else "SetEvent"
        if isinstance(activity, perf.WaitEvent) and len(events) > 1 and not activity.all_of_them:
            yield self._whole(activity)
            return
        for number, event in enumerate(events):
            item = ProjectObject(kind, name=kind, event=self.context.need("Event", event, self.context.holder))
            if isinstance(activity, perf.ClearEvent):
                item["reset"] = True
            kept = {perf.SetEvent: ("process",), perf.WaitEvent: ("waiting",)}.get(type(activity), ())
            self.context.keep(item, replace(activity, events=(event,)), *kept)
            if number:
                self.context.changed(activity, f"a {type(activity).__name__} with several events", "as one for each event")
            yield item

    def _mode(self, activity: perf.ModeAccess) -> Iterator[ProjectObject]:
        context, label = self.context, activity.label
        group, counter = context.find("ModeGroup", label), context.find("Counter", label)
        if group is not None and activity.operation is perf.ModeOperation.SET:
            mode = next((mode for mode in group["modes"] if mode.name == activity.value), None)
            if mode is not None:
                yield ProjectObject("ModeSwitchPoint", name=self.named("EnumModeLabelAccess", activity), mode=mode)
                return
        kind = MODIFICATIONS.get(activity.operation)
        value = whole_number(activity.value) if kind == "Set" else activity.step
        if counter is not None and kind and value is not None:
            name = self.named("NumericModeLabelAccess", activity)
            yield ProjectObject("CounterModification", name=name, type=kind, counter=counter, value=value)
            return
        yield self._whole(activity)

    def _whole(self, activity: perf.Activity) -> ProjectObject:
        """An item that only says that there is something; it takes no time there."""
        kind = type(activity).__name__
        item = ProjectObject("ResourceConsumption", name=kind)
        keep_whole(item, ACTIVITY, activity)
        self.context.lost(activity, kind)
        return item


def _is_unused(entry: ProjectObject) -> bool:
    """Whether it is a sequence without content, which what follows replaces, also if it is that of a group."""
    return entry.kind == "CallSequence" and not entry["calls"]
