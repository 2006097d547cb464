"""Ports, connections, features, frequencies and structures of hardware."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import Downgraded, model_rule
from amalthea_uros.validate.rules.inchron.importer import amount


@model_rule("INC-HW-CONN-IFACE", am.ConnectionHandler)
def _check_handler(element: am.ConnectionHandler, context: Context) -> Iterator[str]:
    if not element.ports or element.ports[0].port_interface not in ("AXI", "AHB", "APB", "custom"):
        yield f"the connection handler {element.name or ''!r} has no first port with the interface AXI, AHB, APB or custom"


@model_rule("INC-HW-CONN-PORTS", am.HwConnection, am.HwPort)
def _check_ports(element: am.HwConnection | am.HwPort, context: Context) -> Iterator[str]:
    if isinstance(element, am.HwConnection):
        types = {port.port_type for port in (element.port1, element.port2) if port is not None}
        if types != {"initiator", "responder"}:
            yield f"the connection {element.name or ''!r} does not join an initiator and a responder port"
    if (
        isinstance(element, am.HwPort)
        and isinstance(element.container, am.HwModule)
        and element.port_type in (None, "_undefined_")
    ):
        yield f"the port {element.name or ''!r} of {element.container.name or ''!r} has no port type"


@model_rule("INC-HW-FEATURE", am.HwFeature)
def _check_feature(element: am.HwFeature, context: Context) -> Iterator[str]:
    category = element.container
    if isinstance(category, am.HwFeatureCategory) and category.name in context.once(_needed):
        name = element.name or ""
        yield f"the feature {name!r} is ignored by am2inc, although execution needs for {category.name!r} depend on it"


def _needed(context: Context) -> set[str | None]:
    """The names of the feature categories that execution needs use."""
    return {entry.key for entry in context.all(am.NeedEntry)}


@model_rule("INC-HW-FREQ-VALUE", am.FrequencyDomain)
def _check_freq_value(element: am.FrequencyDomain, context: Context) -> Iterator[str | Downgraded]:
    cores = context.once(_cores).get(element, [])
    if not cores or amount(element.default_value) > 0:
        return
    message = f"the frequency domain {element.name or ''!r} has no positive frequency with a unit"
    is_compared = any(_has_others(core) for core in cores)
    yield message if element.default_value is None and is_compared else Downgraded(message)


def _cores(context: Context) -> dict[am.FrequencyDomain, list[am.ProcessingUnit]]:
    found: dict[am.FrequencyDomain, list[am.ProcessingUnit]] = {}
    for core in context.all(am.ProcessingUnit):
        if core.frequency_domain is not None:
            found.setdefault(core.frequency_domain, []).append(core)
    return found


def _has_others(core: am.ProcessingUnit) -> bool:
    """Whether the same structure has other processing units, whose clocks am2inc compares with this one."""
    holder = core.container
    modules = holder.modules if isinstance(holder, am.HwStructure) else []
    return sum(isinstance(module, am.ProcessingUnit) for module in modules) > 1


@model_rule("INC-HW-CACHE-PLACE", am.Cache)
def _check_cache(element: am.Cache, context: Context) -> Iterator[str]:
    holder = element.container
    modules = holder.modules if isinstance(holder, am.HwStructure) else []
    if not isinstance(holder, am.ProcessingUnit) and not any(isinstance(module, am.ProcessingUnit) for module in modules):
        yield f"the cache {element.name or ''!r} is neither inside a processing unit nor in the same structure as one"


@model_rule("INC-HW-ONE-SYSTEM", am.HwStructure)
def _check_systems(element: am.HwStructure, context: Context) -> Iterator[str]:
    last = context.once(_systems)[-1:]
    if element.structure_type == "System" and element not in last:
        yield f"the imported project is named after {last[0].name!r}, not after {element.name or ''!r}"


def _systems(context: Context) -> list[am.HwStructure]:
    return [structure for structure in context.all(am.HwStructure) if structure.structure_type == "System"]


@model_rule("INC-HW-PU-STRUCT", am.HwStructure)
def _check_grouping(element: am.HwStructure, context: Context) -> Iterator[str]:
    cpus = context.once(_cpus)
    inner = context.once(_cpus_within)[element]
    # A structure around all CPUs groups nothing.
    if inner > 1 and (element in cpus or inner < len(cpus)):
        yield f"the grouping of {inner} CPUs in the structure {element.name or ''!r} is dropped by am2inc"


def _cpus(context: Context) -> set[Element]:
    """The structures that become CPUs: those that directly contain processing units."""
    return {core.container for core in context.all(am.ProcessingUnit) if core.container is not None}


def _cpus_within(context: Context) -> Counter[Element]:
    """The number of CPUs in each structure, including itself."""
    found: Counter[Element] = Counter()
    for cpu in context.once(_cpus):
        holder: Element | None = cpu
        while isinstance(holder, am.HwStructure):
            found[holder] += 1
            holder = holder.container
    return found
