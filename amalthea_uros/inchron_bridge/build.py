"""A system as an INCHRON project."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.diagnostics import Finding
from amalthea_uros.inchron.objects import ProjectObject
from amalthea_uros.inchron.write import link_opposites
from amalthea_uros.inchron_bridge.amalthea import AmaltheaDetails, add_details
from amalthea_uros.inchron_bridge.basics.comments import keep_list, keep_whole
from amalthea_uros.inchron_bridge.basics.exporting import Exporting
from amalthea_uros.inchron_bridge.basics.importing import Importing
from amalthea_uros.inchron_bridge.basics.orders import keep_orders
from amalthea_uros.inchron_bridge.basics.seals import seal_all
from amalthea_uros.inchron_bridge.imitation import imitate
from amalthea_uros.inchron_bridge.tables.chains import build_chains
from amalthea_uros.inchron_bridge.tables.hardware import build_hardware, connect_hardware, leave_out_memories
from amalthea_uros.inchron_bridge.tables.hardware_back import HARDWARE, extract_hardware
from amalthea_uros.inchron_bridge.tables.os import build_systems
from amalthea_uros.inchron_bridge.tables.requirements import build_requirements
from amalthea_uros.inchron_bridge.tables.software import assign_owners, build_graphs, build_software
from amalthea_uros.inchron_bridge.tables.stimuli import build_stimuli
from amalthea_uros.perf.host import Host
from amalthea_uros.perf.network import Network
from amalthea_uros.perf.system import System
from amalthea_uros.units import Time


@dataclass(frozen=True, slots=True, kw_only=True)
class ProjectBuild:
    """The project of a system.

    Attributes
    ----------
    model : its root
    findings : what has no place in a project, or another form
    """

    model: ProjectObject
    findings: tuple[Finding, ...]


def build_project(
    system: System,
    details: AmaltheaDetails | None = None,
    iterations: Mapping[str, tuple[Time, Time]] = MappingProxyType({}),
    *,
    with_memories: bool = True,
    like_importer_of: str | None = None,
) -> ProjectBuild:
    """The project of a system.

    Parameters
    ----------
    details : what an AMALTHEA model says beyond the system
    iterations : the shortest and the longest time between two iterations of executors, by the stimuli that stand for them
    with_memories : with memories, caches, interconnects and ports, through which accesses would take time
    like_importer_of : the AMALTHEA version whose errors of INCHRON's importer the project has; none if it has to be right

    Raises
    ------
    WriteError : a name is undefined or not unique.
    """
    details = details or AmaltheaDetails()
    context = Exporting(system, details.units, iterations)
    build_hardware(context, details.handlers)
    build_stimuli(context)
    build_software(context)
    build_systems(context)
    build_graphs(context)
    assign_owners(context)
    add_details(context.model, details)
    if not details.handlers:
        connect_hardware(context)
    build_chains(context)
    build_requirements(context)
    _keep_middleware(context)
    if not with_memories:
        leave_out_memories(context.model)
    _keep_lists(context)
    link_opposites(context.model)
    seal_all(context.model)
    findings = context.finish()
    if like_importer_of is not None:
        findings += imitate(context.model, like_importer_of)
    return ProjectBuild(model=context.model, findings=findings)


def _keep_lists(context: Exporting) -> None:
    """Keep the objects that a project has no class for, and the hardware where it says more than a project."""
    system, model = context.system, context.model
    for channel in system.software.channels:
        context.lost(channel, "Channel")
    for overhead in system.os.overheads:
        context.lost(overhead, "Overhead")
    keep_list(model, "channels", system.software.channels)
    keep_list(model, "overheads", system.os.overheads)
    keep_list(model, "modes", system.software.modes)
    modes = {mode.name for mode in system.software.modes}
    keep_list(model, "mode_labels", [label for label in system.software.mode_labels if label.mode not in modes])
    keep_list(model, "clocks", system.stimuli.clocks)
    keep_list(model, "events", system.events.events)
    keep_list(model, "chains", [chain for chain in system.events.chains if context.find("EventGraph", chain.name) is None])
    stored = {item.name for item in model.walk() if item.kind == "memory.DataObject" and item["memory"] is not None}
    placed = [each for each in system.mapping.placements if each.element not in stored or each.address]
    keep_list(model, "placements", placed)
    keep_orders(model, system)
    if extract_hardware(Importing(model), model) != system.hardware:
        keep_whole(model, HARDWARE, system.hardware)


def _keep_middleware(context: Exporting) -> None:
    """Executors, the network and the host: a project has no classes for them."""
    system = context.system
    for executor in system.executors:
        keep_whole(context.need("Process", executor.task, executor.name), "executor", executor)
    for transmission in system.network.transmissions:
        keep_whole(context.need("Process", transmission.name, transmission.name), "transmission", transmission)
    network = replace(system.network, transmissions=())
    if network != Network():
        keep_whole(context.model, "network", network)
    if system.host != Host():
        for each in system.host.executors:
            context.lost(each, "an executor of ROS 2 on the host")
        keep_whole(context.model, "host", system.host)
