"""Which object of an AMALTHEA model became which of a project, as the importer of INCHRON writes it (am2inc, Am2IncMapping.ecore).

What has no counterpart of its own, such as an allocation, is not listed, nor what has not exactly one counterpart of its name.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import quote
from uuid import UUID

from amalthea_uros.inchron.facts import namespace_of, package_of, prefix_of
from amalthea_uros.inchron.ids import intrinsic_ids
from amalthea_uros.inchron.objects import ProjectObject
from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.model import Model
from amalthea_uros.metamodel.versions import facts
from amalthea_uros.xmi.emf.escape import escape

_NAMESPACE = "http://inchron.com/mapping/am2inc/0.2.0"
_HEADER = '<?xml version="1.0" encoding="UTF-8" standalone="no" ?>\n'

#: Classes of AMALTHEA with those of their counterparts; a name that ends with a dot stands for a package.
_COUNTERPARTS: tuple[tuple[type[Element], tuple[str, ...]], ...] = (
    (am.FrequencyDomain, ("Clock",)),
    (am.HwStructure, ("Cpu",)),
    (am.ProcessingUnit, ("CpuCore",)),
    (am.Memory, ("memory.Memory",)),
    (am.Cache, ("memory.CacheMemory",)),
    (am.ConnectionHandler, ("memory.Interconnect",)),
    (am.OperatingSystem, ("GenericSystem",)),
    (am.TaskScheduler, ("Scheduler",)),
    (am.Semaphore, ("Semaphore",)),
    (am.Process, ("Process",)),
    (am.Runnable, ("Function",)),
    (am.Label, ("memory.DataObject",)),
    (am.ModeLabel, ("ModeGroup", "Counter")),
    (am.OsEvent, ("Event",)),
    (am.Stimulus, ("stimulation.", "ActivationConnection")),
    (am.EventChain, ("EventGraph",)),
    (am.TimingConstraint, ("requirement.",)),
    (am.DataAgeConstraint, ("requirement.",)),
    (am.Requirement, ("requirement.",)),
)


def mapping_text(model: Model, project: ProjectObject, ids: UUID, target: Path) -> str:
    """The text of a mapping file.

    Parameters
    ----------
    ids : the namespace of the ids of the project
    target : the file of the project
    """
    names = intrinsic_ids(project, ids)
    packages = {"am": facts(model.documents[0].facts_version).namespace, "am2inc": _NAMESPACE}
    lines = []
    for element, path, item in _pairs(model, project):
        package = package_of(item.kind)
        packages[prefix_of(package)] = namespace_of(package)
        lines += [
            "  <mappings>",
            f'    <amalthea xsi:type="am:{type(element).__name__}" href="{_file(path)}#{escape(element.unique_name)}"/>',
            f'    <inchron xsi:type="{prefix_of(package)}:{item.kind.rpartition(".")[2]}" href="{_file(target)}#{names[item]}"/>',
            "  </mappings>",
        ]
    declared = "".join(f' xmlns:{prefix}="{uri}"' for prefix, uri in sorted(packages.items()))
    xmi = 'xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'
    return "\n".join([f"{_HEADER}<am2inc:Mappings {xmi}{declared}>", *lines, "</am2inc:Mappings>", ""])


def _pairs(model: Model, project: ProjectObject) -> Iterator[tuple[Element, Path, ProjectObject]]:
    objects: dict[tuple[str, str], list[ProjectObject]] = defaultdict(list)
    for item in project.walk():
        for kind in (item.kind, f"{package_of(item.kind)}."):
            objects[kind, item.name].append(item)
    for document in model.documents:
        for element in document.root.walk():
            kinds = next((kinds for source, kinds in _COUNTERPARTS if isinstance(element, source)), ())
            items = [item for kind in kinds for item in objects[kind, getattr(element, "name", None) or ""]]
            if len(items) == 1:
                yield element, document.path or Path("model.amxmi"), items[0]


def _file(path: Path) -> str:
    return escape(quote(path.name))
