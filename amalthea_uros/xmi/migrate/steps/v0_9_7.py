"""0.9.6 -> 0.9.7: activity graphs, and interfaces of components."""

from __future__ import annotations

from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.node import Node
from amalthea_uros.xmi.migrate.notes import Notes
from amalthea_uros.xmi.migrate.step import Step
from amalthea_uros.xmi.migrate.steps.v0_9_6 import convert_event_chains, convert_mode_conditions

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


def change(models: ModelSet, notes: Notes) -> None:
    """Change the content of the files of AMALTHEA 0.9.6."""
    # The known files of 0.9.6 have neither chains nor conditions: they may be written as in 0.9.5.
    convert_event_chains(models, notes)
    convert_mode_conditions(models, notes)
    _rename_call_graphs(models, notes)
    _rename_processes(models, notes)
    _convert_ports(models, notes)
    _check_mandatory(models, notes)


def _rename_call_graphs(models: ModelSet, notes: Notes) -> None:
    for graph in models.nodes("callGraph"):
        present = graph.parent.child("activityGraph") if graph.parent is not None else None
        if present is None:
            graph.tag = "activityGraph"
        else:
            present.take(graph.children)
            graph.remove()
        notes.renamed(graph, "call graph is now the activity graph")


def _rename_processes(models: ModelSet, notes: Notes) -> None:
    for component in models.nodes("components"):
        tasks = component.references.pop("tasks", None)
        if tasks is not None:
            component.refer("processes", *tasks)
            notes.renamed(component, "tasks of the component are now its processes", "", "tasks")


def _convert_ports(models: ModelSet, notes: Notes) -> None:
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


def _check_mandatory(models: ModelSet, notes: Notes) -> None:
    for tag in dict.fromkeys(tag for tag, _ in _MANDATORY):
        for node in models.nodes(tag):
            for name in _MANDATORY.get((tag, node.type), ()):
                if node.child(name) is None and not node.references.get(name) and not node.get(name):
                    notes.to_check(node, f"{node.type or tag} without {name}, which is mandatory now")


STEP = Step("0.9.6", "0.9.7", change, frozenset({"callGraph", "InterfacePort", "FInterfacePort"}))
