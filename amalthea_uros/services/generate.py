"""From an `app.yaml` to files for the build of the firmware, and a check of files that others wrote."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from amalthea_uros._internal.files import FileError, is_file, read_text
from amalthea_uros._internal.limits import SETTINGS_SIZE
from amalthea_uros._internal.paths import StrPath, folder_of
from amalthea_uros._internal.resources import resource_folder
from amalthea_uros._internal.shown import Shown
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import ReadError, WriteError
from amalthea_uros.findings.accepted import unsuppressed
from amalthea_uros.perf.named import Brief
from amalthea_uros.services.build import describe
from amalthea_uros.services.waiting_messages import waiting_messages, with_analysed_storage
from amalthea_uros.spec.application import Application, NodeSection
from amalthea_uros.spec.platforms import complete
from amalthea_uros.spec.read import read_description
from amalthea_uros.uros.application.entities import LIFECYCLE_SERVICES, PARAMETER_SERVICES
from amalthea_uros.uros.assemble import Assembly, assemble
from amalthea_uros.uros.colcon_meta import parse_meta
from amalthea_uros.uros.generated_options import check_meta, values_of, with_generated_options
from amalthea_uros.uros.memory import MemoryDemand
from amalthea_uros.uros.middleware.options import Option, OptionRole
from amalthea_uros.uros.profiles import profile_of

META, HEADER, CMAKE = "colcon.meta", "amuros_limits.h", "zenoh_options.cmake"
#: In each file, by which it can be told from those that people wrote.
_MARK = "Written by amuros generate"
#: Findings about sizes, which the files set.
_SOLVED = ("UR120", "UR127")
#: Packages of options that the header of rmw_microxrcedds repeats.
_WITH_HEADER = "rmw_microxrcedds"
_MTU = re.compile(r"UCLIENT_(\w+_TRANSPORT_MTU)")


@dataclass(frozen=True, slots=True, kw_only=True)
class GenerateResult(Brief, Shown):
    """Files that were generated.

    Attributes
    ----------
    description : the file
    folder : where the files are; None if they were not written
    texts : their contents, by name
    memory : with the options in them
    """

    description: Path
    folder: Path | None
    assembly: Assembly
    texts: Mapping[str, str]
    memory: MemoryDemand

    @property
    def findings(self) -> tuple[Finding, ...]:
        """Warnings and notes about the description, except about sizes that the files set, and those that comments in it accept."""
        return unsuppressed(finding for finding in self.assembly.findings if finding.rule not in _SOLVED)


@dataclass(frozen=True, slots=True, kw_only=True)
class MetaCheck(Brief, Shown):
    """A `colcon.meta` compared with an application."""

    description: Path
    path: Path
    findings: tuple[Finding, ...]

    @property
    def is_fine(self) -> bool:
        """Whether nothing needs to be changed; values that are larger than necessary do not count."""
        return all(finding.severity is Severity.INFO for finding in self.findings)


def generate(path: StrPath, folder: StrPath | None = None, platform: str | None = None, force: bool = False) -> GenerateResult:
    """The files for the build of an `app.yaml`: `colcon.meta` with the smallest pools that hold, and `amuros_limits.h`.

    Parameters
    ----------
    folder : where they are written; it is created if it does not exist; None: nowhere
    platform : replaces the platform that the file names
    force : replace files that somebody else wrote

    Raises
    ------
    ReadError : the description cannot be read, something in it is wrong, or it has no micro-ROS application.
    WriteError : a file cannot be written, or would be replaced.
    """
    assembly = _described(path, platform)
    if not assembly.description.application.nodes:
        message, advice = "no micro-ROS application: nothing to generate", "Add nodes under 'application'."
        raise ReadError([Finding("GEN009", Severity.ERROR, message, Location(Path(path)), advice)])
    assembly = with_analysed_storage(assembly)
    target = None if folder is None else Path(folder)
    texts = texts_of(assembly)
    result = GenerateResult(
        description=Path(path), folder=target, assembly=assembly, texts=texts, memory=generated_memory(assembly)
    )
    if target is not None:
        _write({target / name: text for name, text in result.texts.items()}, force)
    return result


def check_colcon_meta(path: StrPath, meta: StrPath, platform: str | None = None) -> MetaCheck:
    """What is wrong with a `colcon.meta` for an application.

    Parameters
    ----------
    path : the `app.yaml`
    meta : the file to check; comments and trailing commas are allowed
    platform : replaces the platform that the description names

    Raises
    ------
    ReadError : one of the files cannot be read.
    """
    assembly = _described(path, platform)
    file = Path(meta)
    try:
        text = read_text(file, SETTINGS_SIZE)
    except FileError as error:
        raise ReadError([Finding("GEN006", Severity.ERROR, error.reason, Location(file), error.advice)]) from None
    description, file_options = assembly.description, parse_meta(file, text)
    findings = check_meta(description.application, assembly.profile, file_options, waiting_messages(assembly))
    return MetaCheck(description=Path(path), path=file, findings=findings)


def generated_memory(assembly: Assembly) -> MemoryDemand:
    """The memory with the options that are generated."""
    application, profile = assembly.description.application, assembly.profile
    described = profile.memory(application)
    generated = with_generated_options(profile, assembly.options).memory(application)
    rest = [use for use in assembly.memory.uses if use not in described]
    return replace(assembly.memory, uses=(*generated, *rest))


def _described(path: StrPath, platform: str | None) -> Assembly:
    """The system of a description; pools that are too small are no obstacle, as the files are to set others."""
    try:
        return describe(path, platform)
    except ReadError as error:
        if any(finding.severity is Severity.ERROR and finding.rule not in _SOLVED for finding in error.findings):
            raise
    whole, name, _ = complete(read_description(Path(path)), folder_of(Path(path)), platform)
    middleware = whole.middleware
    sizes = [row.name for row in profile_of(middleware).option_table.values() if row.role is not OptionRole.SETTING]
    limits = middleware.limits.model_copy(update=dict.fromkeys(name for name in sizes if middleware.limits.states(name)))
    whole = whole.model_copy(update={"middleware": middleware.model_copy(update={"limits": limits})})
    return assemble(whole, whole.hardware, name)


def texts_of(assembly: Assembly) -> dict[str, str]:
    """The contents of the files, by name."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    loader = FileSystemLoader(resource_folder("templates/generate"))
    environment = Environment(
        loader=loader, undefined=StrictUndefined, keep_trailing_newline=True, trim_blocks=True, lstrip_blocks=True
    )
    values = values_of(assembly.options)
    packages: dict[str, list[tuple[Option, int]]] = {}
    for option, value in values:
        packages.setdefault(option.package, []).append((option, value))
    application = assembly.description.application
    content = {
        "mark": _MARK,
        "name": _in_comment(assembly.description.name),
        "packages": packages,
        "values": values,
        "checks": list(_checks(values)),
        "handles": _constants("AMUROS_HANDLES", _handles(assembly)),
        "sizes": _constants("AMUROS_SIZE", _sizes(application)),
    }
    is_xrce = _WITH_HEADER in packages
    names = (META, HEADER) if is_xrce else (CMAKE, HEADER)
    return {name: environment.get_template(f"{name}.j2").render(content) for name in names}


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
    nodes = assembly.description.application.nodes
    return {assembly.description.middleware.stated_executors[0].name: sum(map(_node_handles, nodes))}


def _node_handles(node: NodeSection) -> int:
    messages = len(node.subscriptions) + len(node.services) + len(node.clients)
    others = len(node.timers) + len(node.guard_conditions) + len(node.action_servers) + len(node.action_clients)
    parameters = PARAMETER_SERVICES if node.parameter_server is not None else 0
    lifecycle = min(node.lifecycle.services, LIFECYCLE_SERVICES) if node.lifecycle is not None else 0
    return messages + others + parameters + lifecycle


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


def _write(texts: Mapping[Path, str], force: bool) -> None:
    """Write all files, or none."""
    from amalthea_uros.xmi.emf.files import FileText, write_texts

    foreign = [path for path in texts if not force and _is_foreign(path)]
    if foreign:
        message, advice = "the file exists already, and it is not one that amuros generate wrote", "Use --force to replace it."
        raise WriteError([Finding("XMI101", Severity.ERROR, message, Location(path), advice) for path in foreign])
    for folder in {path.parent for path in texts}:
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except (OSError, ValueError) as error:
            message = f"the folder cannot be created: {getattr(error, 'strerror', None) or error}"
            raise WriteError([Finding("XMI101", Severity.ERROR, message, Location(folder), "Name another folder.")]) from None
    write_texts({path: FileText(text) for path, text in texts.items()})


def _is_foreign(path: Path) -> bool:
    """Whether somebody else wrote a file."""
    if not is_file(path):
        return path.exists()
    try:
        return _MARK not in read_text(path, SETTINGS_SIZE)
    except FileError:
        return True
