"""0.9.5 -> 0.9.6 -> 0.9.7: items of event chains, conditions about modes, activity graphs, and interfaces of components."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.xmi.tree.model_set import ModelSet, Step
from amalthea_uros.xmi.tree.node import Node
from amalthea_uros.xmi.tree.notes import StepNotes

# 0.9.5 -> 0.9.6

#: Elements that hold a condition about modes.
CONDITIONS = ("condition", "executionCondition")

#: What the parts of a chain are called until 0.9.5, and how they are related.
_ITEM_TYPES = {"segments": "sequence", "strands": "parallel"}


def change_0_9_5(models: ModelSet, notes: StepNotes) -> None:
    """Change the content of the files of AMALTHEA 0.9.5."""
    for chain in models.nodes("eventChains", "eventChain"):
        for end in ("stimulus", "response"):
            if not (chain.references.get(end) or chain.get(end)):
                notes.to_check(chain, f"event chain without {end}, which is mandatory")
    convert_event_chains(models, notes)
    convert_mode_conditions(models, notes)


def convert_event_chains(models: ModelSet, notes: StepNotes) -> None:
    """Make one list of items of the segments and strands of every event chain."""
    constrained = _constrained_chains(models)
    for chain in models.nodes("eventChains", "eventChain"):
        segments, strands = chain.all("segments"), chain.all("strands")
        if segments and strands:
            _nest_strands(chain, strands)
            _name_items(chain, "segments")
            notes.converted(
                chain,
                "event chain with segments and strands: now a sequence, of which a chain with the strands is the last item",
            )
        elif segments or strands:
            kind = "segments" if segments else "strands"
            _name_items(chain, kind)
            notes.converted(chain, f"{kind} of the event chain are now items of type {_ITEM_TYPES[kind]}")
        if strands and not constrained.isdisjoint((chain, chain.enclosing("eventChains") or chain)):
            notes.to_check(
                chain,
                "parallel event chain with a latency constraint: one completed item is enough unless minItemsCompleted is set",
                f"{len(strands)} items",
            )


def _constrained_chains(models: ModelSet) -> set[Node]:
    """The chains with a latency constraint, and those that are parts of them by reference."""
    waiting = [
        chain
        for constraint in models.nodes("timingConstraints")
        if constraint.type == "EventChainLatencyConstraint"
        for chain in constraint.references.get("scope", ())
    ]
    found: set[Node] = set()
    while waiting:
        chain = waiting.pop()
        if chain not in found:
            found.add(chain)
            waiting += [
                part
                for item in chain.walk()
                if item.type == "EventChainReference"
                for part in item.references.get("eventChain", ())
            ]
    return found


def _name_items(chain: Node, kind: str) -> None:
    for part in chain.all(kind):
        part.tag = "items"
    chain.attributes.setdefault("itemType", _ITEM_TYPES[kind])


def _nest_strands(chain: Node, strands: list[Node]) -> None:
    """Put the strands into a chain of their own, from the same stimulus to the same response: each of them covers the whole chain."""
    inner = chain.add("segments", "EventChainContainer", like=strands[0]).add("eventChain", like=strands[0])
    for end in ("stimulus", "response"):
        inner.refer(end, *chain.references.get(end, ()))
    inner.references = {end: targets for end, targets in inner.references.items() if targets}
    inner.take(strands)
    _name_items(inner, "strands")


def convert_mode_conditions(models: ModelSet, notes: StepNotes) -> None:
    """State the class of every comparison of a mode label with a value: there is a second kind of comparisons now."""
    for holder in models.nodes(*CONDITIONS):
        for condition in conditions_below(holder):
            # Within a conjunction the class was not written: there was only one.
            if condition.type == "ModeCondition" or not (condition.type or condition.children):
                condition.type = "ModeValueCondition"
                notes.renamed(condition, "condition about a mode label: class is now ModeValueCondition")


def conditions_below(holder: Node) -> Iterator[Node]:
    """Every condition in a disjunction, also those in its conjunctions."""
    for entry in holder.all("entries"):
        yield entry
        yield from conditions_below(entry)


STEP_0_9_6 = Step("0.9.5", "0.9.6", change_0_9_5, frozenset({"segments", "strands", "ModeCondition"}))


# 0.9.6 -> 0.9.7

#: The classes of ports until 0.9.6. There is only one now, so that it is not written any more.
_PORTS = {"InterfacePort": "ComponentPort", "FInterfacePort": "ComponentPort"}

#: Parts and references that became mandatory, by tag and class.
_MANDATORY: dict[tuple[str, str], tuple[str, ...]] = {
    ("stimuli", "PeriodicStimulus"): ("recurrence",),
    ("stimuli", "PeriodicSyntheticStimulus"): ("recurrence",),
    ("stimuli", "PeriodicBurstStimulus"): ("recurrence",),
    ("stimuli", "RelativePeriodicStimulus"): ("nextOccurrence",),
    ("stimuli", "VariableRateStimulus"): ("occurrencesPerStep",),
    ("activations", "SingleActivation"): ("min", "max"),
    ("sourcePort", ""): ("port",),
    ("targetPort", ""): ("port",),
    ("groundedPorts", ""): ("port",),
}


def change_0_9_6(models: ModelSet, notes: StepNotes) -> None:
    """Change the content of the files of AMALTHEA 0.9.6."""
    # The known files of 0.9.6 have neither chains nor conditions: they may be written as in 0.9.5.
    convert_event_chains(models, notes)
    convert_mode_conditions(models, notes)
    _rename_call_graphs(models, notes)
    _rename_processes(models, notes)
    _convert_ports(models, notes)
    _check_mandatory(models, notes)


def _rename_call_graphs(models: ModelSet, notes: StepNotes) -> None:
    for graph in models.nodes("callGraph"):
        present = graph.parent.child("activityGraph") if graph.parent is not None else None
        if present is None:
            graph.tag = "activityGraph"
        else:
            present.take(graph.children)
            graph.remove()
        notes.renamed(graph, "call graph is now the activity graph")


def _rename_processes(models: ModelSet, notes: StepNotes) -> None:
    for component in models.nodes("components"):
        tasks = component.references.pop("tasks", None)
        if tasks is not None:
            component.refer("processes", *tasks)
            notes.renamed(component, "tasks of the component are now its processes", "", "tasks")


def _convert_ports(models: ModelSet, notes: StepNotes) -> None:
    """Make a port of every interface port, and an interface of what it names."""
    interfaces: dict[str, Node] = {}
    for tree in models.trees:
        for interface in tree.root.find("componentsModel", "interfaces"):
            interfaces.setdefault(interface.name, interface)
    for port in models.rename_classes(_PORTS):
        port.type, port.target_class = "", "ComponentPort"
        notes.renamed(port, "interface port is now a component port")
        name = port.attributes.pop("interfaceName", "")
        if not name:
            continue
        if name not in interfaces:
            interfaces[name] = port.root.child_or_new("componentsModel").add("interfaces", like=port, name=name)
        port.refer("interface", interfaces[name])
        notes.converted(port, "name of the interface is now a reference to an interface", name, "interfaceName")


def _check_mandatory(models: ModelSet, notes: StepNotes) -> None:
    for tag in dict.fromkeys(tag for tag, _ in _MANDATORY):
        for node in models.nodes(tag):
            for name in _MANDATORY.get((tag, node.type), ()):
                if node.child(name) is None and not node.references.get(name) and not node.get(name):
                    notes.to_check(node, f"{node.type or tag} without {name}, which is mandatory now")


STEP_0_9_7 = Step("0.9.6", "0.9.7", change_0_9_6, frozenset({"callGraph", "InterfacePort", "FInterfacePort"}))
