"""Facts about the controller in files of build systems: those of PlatformIO, Zephyr, ESP-IDF, CMake and libraries for Arduino."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from functools import partial
from typing import TypeAlias

from amalthea_uros._internal.ports import DISTRIBUTIONS, known_ports
from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.source.facts import CodeOption, Stated
from amalthea_uros.source.files import SourceFile


@dataclass(slots=True, kw_only=True)
class BuildFacts:
    """The facts in the files.

    Attributes
    ----------
    port, ros, board, framework : None if they do not say it; the board is called as PlatformIO does
    transport : as `app.yaml` calls it
    clock : of the cores, in Hz
    ticks : per second
    main_stack, main_priority : of the thread of main()
    options : of the middleware
    macros : of Kconfig, as the code has them
    """

    port: Stated | None = None
    ros: Stated | None = None
    board: Stated | None = None
    framework: Stated | None = None
    transport: Stated | None = None
    clock: Stated | None = None
    ticks: Stated | None = None
    main_stack: Stated | None = None
    main_priority: Stated | None = None
    options: dict[str, CodeOption] = field(default_factory=dict)
    macros: dict[str, str] = field(default_factory=dict)
    findings: list[Finding] = field(default_factory=list)


def build_facts(files: Iterable[SourceFile]) -> BuildFacts:
    """The facts of build files; of several ones of a name, those nearest to the top of the folder count."""
    facts = BuildFacts()
    for file in sorted(files, key=lambda file: (-len(file.path.parts), file.path.name == "sdkconfig")):
        match file.path.name:
            case "platformio.ini":
                _platformio(facts, file)
            case "prj.conf" | "amuros.conf":
                _zephyr(facts, _kconfig(facts, file))
            case "sdkconfig" | "sdkconfig.defaults":
                _espidf(facts, _kconfig(facts, file))
            case "CMakeLists.txt":
                _cmake(facts, file)
            case "library.properties":
                _arduino(facts, _sections(file)[""])
    return facts


_NAME = re.compile(r"[\w.]+")
_REMARK = re.compile(r"\s[;#]")
_REFERENCE = re.compile(r"\$\{([\w:-]+)\.(\w+)\}")
_SECTION = re.compile(r"\s*\[(.*)\]")
#: Sections that extend each other.
_MAX_DEPTH = 10
#: References in a value that are replaced, and characters of what replaces one: a file must not grow by them without limit.
_MAX_REFERENCES, _MAX_REFERRED = 20, 2000
#: The settings of an environment of PlatformIO that say something.
_OF_ENVIRONMENTS = (
    *("extends", "lib_deps", "board", "framework", "build_flags"),
    *("board_microros_distro", "board_microros_transport", "board_build.f_cpu"),
)

#: Settings by their names, and those of sections by the names of the sections.
_Settings: TypeAlias = Mapping[str, Stated]
_Sections: TypeAlias = Mapping[str, _Settings]


def _sections(file: SourceFile) -> _Sections:
    """The settings `NAME=VALUE` of sections, "" for those before any; lines that are indented continue a value."""
    found: dict[str, dict[str, tuple[list[str], Location]]] = {}
    section, name = found.setdefault("", {}), ""
    for row, line in enumerate(file.text.decode("utf-8", "replace").splitlines()):
        key, equals, value = line.partition("=")
        if (header := _SECTION.fullmatch(line.rstrip())) is not None:
            section, name = found.setdefault(header[1], {}), ""
        elif line.lstrip()[:1] in ("#", ";"):
            continue
        elif line[:1].isspace() and name:
            section[name][0].append(line.strip())
        elif equals and _NAME.fullmatch(key.strip()) is not None:
            name = key.strip()
            section[name] = [_REMARK.split(value, maxsplit=1)[0].strip().strip('"')], file.location(row, 0)
    return {
        title: {name: Stated(" ".join(lines), place) for name, (lines, place) in settings.items()}
        for title, settings in found.items()
    }


def _kconfig(facts: BuildFacts, file: SourceFile) -> _Settings:
    """The settings of a file of Kconfig, which are macros in the code: a switch that is on is 1."""
    settings = _sections(file)[""]
    facts.macros |= {
        name: "1" if stated.value == "y" else stated.value for name, stated in settings.items() if stated.value != "n"
    }
    return settings


def _platformio(facts: BuildFacts, file: SourceFile) -> None:
    """https://docs.platformio.org, projectconf; of several environments only what all of them say alike."""
    sections = _sections(file)
    names = [name for name in sections if name.startswith("env:")]
    general = _of_environment(sections.get("env", {}))
    if (default := sections.get("platformio", {}).get("default_envs")) is not None:
        chosen = set(re.split(r"[,\s]+", default.value))
        names = [name for name in names if name.removeprefix("env:") in chosen] or names
    known: dict[str, _Settings] = {}
    every = (_interpolated(sections, {**general, **_extended(sections, name, known)}) for name in names)
    common = dict(next(every, general))
    for settings in every:
        common = {key: each for key, each in common.items() if key in settings and settings[key].value == each.value}
    libraries = common.get("lib_deps")
    if libraries is not None and (port := re.search("micro_ros_(platformio|arduino)", libraries.value)) is not None:
        facts.port = Stated(port[1], libraries.place)
        facts.ros = _distribution(libraries) or facts.ros
    facts.board, facts.framework = common.get("board", facts.board), common.get("framework", facts.framework)
    distribution = common.get("board_microros_distro")
    if distribution is not None:
        facts.ros = _distribution(distribution) or facts.ros
    clock = common.get("board_build.f_cpu")
    if clock is not None and (digits := re.fullmatch(r"(\d{1,10})[uUlL]*", clock.value)) is not None:
        facts.clock = Stated(digits[1], clock.place)
    transport = common.get("board_microros_transport")
    if transport is not None:
        facts.transport = _transport(transport, {"wifi": "udp", "wifi_nina": "udp", "native_ethernet": "udp"})
    flags = common.get("build_flags")
    if flags is not None and (usb := re.search(r"ARDUINO_USB_CDC_ON_BOOT=([01])", flags.value)) is not None:
        facts.transport = facts.transport or Stated("usb_cdc" if usb[1] == "1" else "serial", flags.place)


def _of_environment(settings: _Settings) -> _Settings:
    return {name: settings[name] for name in _OF_ENVIRONMENTS if name in settings}


def _extended(sections: _Sections, title: str, known: dict[str, _Settings], depth: int = 0) -> _Settings:
    """The settings of a section, with those of the sections that it extends, of which the last one counts.

    Parameters
    ----------
    known : those of sections that were asked for; this one is added
    """
    if title not in known:
        own = known[title] = _of_environment(sections.get(title, {}))
        around = own["extends"].value if "extends" in own and depth < _MAX_DEPTH else ""
        inherited: dict[str, Stated] = {}
        for name in filter(None, re.split(r"[,\s]+", around)):
            inherited |= _extended(sections, name, known, depth + 1)
        known[title] = inherited | dict(own)
    return known[title]


def _interpolated(sections: _Sections, settings: _Settings) -> _Settings:
    """Settings with `${section.name}` replaced by that value."""
    replacement = partial(_referred, sections)
    return {
        name: Stated(_REFERENCE.sub(replacement, each.value, count=_MAX_REFERENCES), each.place)
        for name, each in settings.items()
    }


def _referred(sections: _Sections, reference: re.Match[str]) -> str:
    stated = sections.get(reference[1], {}).get(reference[2])
    return stated.value if stated is not None and len(stated.value) <= _MAX_REFERRED else reference[0]


def _transport(stated: Stated, words: Mapping[str, str]) -> Stated | None:
    return Stated(words[stated.value], stated.place) if stated.value in words else None


def _distribution(stated: Stated) -> Stated | None:
    """The distribution in the name of a version or branch, such as `2.0.7-humble`; None if there is none, or several."""
    names = {name for name in DISTRIBUTIONS if re.search(rf"(?<![a-z]){name}(?![a-z])", stated.value.lower())}
    return Stated(names.pop(), stated.place) if len(names) == 1 else None


def _zephyr(facts: BuildFacts, settings: _Settings) -> None:
    """The configuration of Zephyr: micro-ROS/micro_ros_zephyr_module modules/libmicroros/Kconfig, zephyr kernel/Kconfig."""
    micro_ros = [stated for name, stated in settings.items() if name.startswith("CONFIG_MICROROS")]
    if micro_ros:
        facts.port = Stated("zephyr", micro_ros[0].place)
    for name, option in known_ports()["zephyr"].kconfig.items():
        if (stated := settings.get(option)) is not None:
            facts.options[name] = CodeOption(name=name, value=stated.value, place=stated.place)
    for name, wire in (("SERIAL", "serial"), ("SERIAL_USB", "usb_cdc"), ("UDP", "udp")):
        stated = settings.get(f"CONFIG_MICROROS_TRANSPORT_{name}")
        if stated is not None and stated.value == "y":
            facts.transport = Stated(wire, stated.place)
    facts.ticks = _number(settings.get("CONFIG_SYS_CLOCK_TICKS_PER_SEC")) or facts.ticks
    facts.main_stack = _number(settings.get("CONFIG_MAIN_STACK_SIZE")) or facts.main_stack
    facts.main_priority = _number(settings.get("CONFIG_MAIN_THREAD_PRIORITY")) or facts.main_priority


def _espidf(facts: BuildFacts, settings: _Settings) -> None:
    """The configuration of ESP-IDF: espressif/esp-idf components/freertos/Kconfig, components/esp_system/Kconfig."""
    micro_ros = [stated for name, stated in settings.items() if name.startswith("CONFIG_MICRO_ROS")]
    if micro_ros:
        facts.port = Stated("espidf", micro_ros[0].place)
    facts.ticks = _number(settings.get("CONFIG_FREERTOS_HZ")) or facts.ticks
    facts.board = settings.get("CONFIG_IDF_TARGET") or facts.board
    for name, stated in settings.items():
        if re.fullmatch(r"CONFIG_ESP\w*_DEFAULT_CPU_FREQ_MHZ", name) and (number := _number(stated)) is not None:
            facts.clock = Stated(f"{number.value}000000", stated.place)
        if "EMBEDDEDRTPS" in name and stated.value == "y":
            message = "the build has embeddedRTPS as its middleware: what the description says about XRCE-DDS does not hold"
            advice = "Build with XRCE-DDS, or describe another middleware with 'profile'."
            facts.findings.append(Finding("IMP024", Severity.ERROR, message, stated.place, advice))


def _number(stated: Stated | None) -> Stated | None:
    return stated if stated is not None and re.fullmatch(r"-?\d{1,9}", stated.value) else None


_CMAKE_PORTS = (
    (r"micro_ros_espidf_component", "espidf"),
    (r"pico_sdk_init\s*\(|pico_sdk_import", "pico-sdk"),
    (r"find_package\s*\(\s*Zephyr", "zephyr"),
)
_STDIO = re.compile(r"^[ \t]*pico_enable_stdio_(usb|uart)\s*\(\s*\S+\s+(\w+)\s*\)", re.MULTILINE)


def _cmake(facts: BuildFacts, file: SourceFile) -> None:
    """CMake; the standard input and output of the Pico SDK is its transport, by USB or a UART."""
    text = file.text.decode("utf-8", "replace")
    for pattern, port in _CMAKE_PORTS:
        if facts.port is None and (match := re.search(pattern, text)) is not None:
            facts.port = Stated(port, _place(file, text, match.start()))
    enabled = {match[1]: match.start() for match in _STDIO.finditer(text) if match[2] in ("1", "ON")}
    if len(enabled) == 1:
        kind, position = next(iter(enabled.items()))
        facts.transport = Stated("usb_cdc" if kind == "usb" else "serial", _place(file, text, position))


def _place(file: SourceFile, text: str, position: int) -> Location:
    return file.location(text.count("\n", 0, position), 0)


def _arduino(facts: BuildFacts, properties: _Settings) -> None:
    """The properties of a library for Arduino: its version names the distribution."""
    name, version = properties.get("name"), properties.get("version")
    if name is not None and name.value == "micro_ros_arduino":
        facts.port = Stated("arduino", name.place)
        facts.ros = (_distribution(version) if version is not None else None) or facts.ros
