"""The files for the build of the firmware: options with the smallest pools that hold, and a header that checks them."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import replace

from amalthea_uros._internal.ports import known_ports
from amalthea_uros._internal.records import dataclass
from amalthea_uros._internal.resources import resource_folder
from amalthea_uros.diagnostics import Finding
from amalthea_uros.perf.named import Brief
from amalthea_uros.spec.application import Application
from amalthea_uros.uros.application.callbacks import handle_count, sections_of
from amalthea_uros.uros.assemble import Assembly
from amalthea_uros.uros.firmware.code import code_texts, firmware_code
from amalthea_uros.uros.firmware.omissions import omissions
from amalthea_uros.uros.generated_options import values_of, with_generated_options
from amalthea_uros.uros.memory import MemoryDemand
from amalthea_uros.uros.middleware.options import Option
from amalthea_uros.uros.storage import MessageStorage, storage_of

META, HEADER, CMAKE, KCONFIG = "colcon.meta", "amuros_limits.h", "zenoh_options.cmake", "amuros.conf"
#: In each file, by which it can be told from those that people wrote.
MARK = "Written by amuros generate"
#: Packages of options that the header of rmw_microxrcedds repeats.
_WITH_HEADER = "rmw_microxrcedds"
_MTU = re.compile(r"UCLIENT_(\w+_TRANSPORT_MTU)")


def generated_memory(assembly: Assembly) -> MemoryDemand:
    """The memory with the options that are generated."""
    application, profile = assembly.description.application, assembly.profile
    generated = with_generated_options(profile, assembly.options)
    return assembly.memory.with_static(profile.memory(application), generated.memory(application))


def generated_storage(assembly: Assembly) -> MessageStorage | None:
    """The storage for messages with the options that are generated; None if the middleware has none."""
    generated, application = with_generated_options(assembly.profile, assembly.options), assembly.description.application
    storage = storage_of(generated, application, generated.options(application), generated_memory(assembly))
    # As many slots are generated as are needed.
    return None if storage is None else replace(storage, needed=storage.slots)


@dataclass(frozen=True, slots=True, kw_only=True)
class CodeWishes(Brief):
    """The options for the code beyond the description.

    Attributes
    ----------
    reconnects : whether it creates everything anew when the agent comes back
    stamps : whether it sends a CAN frame where a callback starts and ends
    """

    reconnects: bool = False
    stamps: bool = False


def texts_of(assembly: Assembly, code: CodeWishes | None = None) -> dict[str, str]:
    """The contents of the files, by name.

    Parameters
    ----------
    code : None if only the files for the build are wanted

    Raises
    ------
    ReadError : something in the description has no code.
    """
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    loader = FileSystemLoader(resource_folder("templates/generate"))
    environment = Environment(
        loader=loader, undefined=StrictUndefined, keep_trailing_newline=True, trim_blocks=True, lstrip_blocks=True
    )
    values = values_of(assembly.options)
    packages: dict[str, list[tuple[Option, int]]] = {}
    kconfig = _kconfig(assembly.profile.middleware.port, values)
    elsewhere = {option.name for _, _, option in kconfig}
    for option, value in values:
        rows = packages.setdefault(option.package, [])
        rows += [(option, value)] if option.name not in elsewhere else []
    application = assembly.description.application
    handles = _constants("AMUROS_HANDLES", _handles(assembly))
    content = {
        "mark": MARK,
        "name": _in_comment(assembly.description.name),
        "packages": packages,
        "values": values,
        "checks": list(_checks(values)),
        "handles": handles,
        "sizes": _constants("AMUROS_SIZE", _sizes(application)),
        "kconfig": kconfig,
    }
    is_xrce = _WITH_HEADER in packages
    names = (META, HEADER, *([KCONFIG] if kconfig else [])) if is_xrce else (CMAKE, HEADER)
    texts = {name: environment.get_template(f"{name}.j2").render(content) for name in names}
    if code is None:
        return texts
    constants = dict(zip(_handles(assembly), (constant for constant, _, _ in handles), strict=True))
    firmware = firmware_code(assembly.description, assembly.system, reconnects=code.reconnects, stamps=code.stamps)
    return texts | code_texts(firmware, environment, content | {"handle_constants": constants})


def code_findings(assembly: Assembly, code: CodeWishes | None) -> tuple[Finding, ...]:
    """About what the description states and the code does not have; nothing if no code is wanted."""
    return () if code is None else tuple(omissions(assembly.description))


def _kconfig(port: str | None, values: list[tuple[Option, int]]) -> list[tuple[str, str, Option]]:
    """The options that the configuration of a port replaces, whatever `colcon.meta` says, by their names there."""
    known = known_ports().get(port or "")
    names = known.kconfig if known is not None else {}
    return [(names[option.name], option.text(value), option) for option, value in values if option.name in names]


def _checks(values: list[tuple[Option, int]]) -> Iterator[tuple[str, int, Option]]:
    """What the compiler can check: the macros of the library that options became."""
    for option, value in values:
        if option.needed and (found := _MTU.fullmatch(option.name)):
            yield f"UXR_CONFIG_{found[1]}", option.needed, option
        elif option.needed and option.package == _WITH_HEADER and not option.is_power_of_two:
            yield option.name, value, option


def _handles(assembly: Assembly) -> dict[str, int]:
    """The handles that `rclc_executor_init` needs, by executor."""
    loops = {executor.name: len(executor.handles) for executor in assembly.system.executors}
    if loops:
        return loops
    nodes, middleware = assembly.description.application.nodes, assembly.description.middleware
    handles = (handle_count(kind, node, middleware.ros) for node in nodes for kind, _ in sections_of(node))
    return {middleware.stated_executors[0].name: sum(handles)}


def _sizes(application: Application) -> dict[str, int]:
    """The longest message of each topic, in bytes."""
    found: dict[str, int] = {}
    for node in application.nodes:
        sizes = [(subscription.topic, subscription.message_size) for subscription in node.subscriptions]
        sizes += [(publisher.topic, publisher.message_size) for publisher in node.publishers]
        for topic, size in sizes:
            found[topic] = max(found.get(topic, 0), -(-size // 8))
    return found


def _constants(prefix: str, values: Mapping[str, int]) -> list[tuple[str, int, str]]:
    """Names of C for values, each once, with what they are for."""
    found: dict[str, tuple[int, str]] = {}
    for name, value in values.items():
        base = f"{prefix}_{re.sub('[^A-Za-z0-9]+', '_', name).strip('_').upper() or 'UNNAMED'}"
        constant, count = base, 1
        while constant in found:
            count += 1
            constant = f"{base}_{count}"
        found[constant] = (value, _in_comment(name))
    return [(constant, *rest) for constant, rest in found.items()]


def _in_comment(text: str) -> str:
    """A text that does not end the comment of C that it is in."""
    return text.replace("*/", "* /").replace("\\", "/")
