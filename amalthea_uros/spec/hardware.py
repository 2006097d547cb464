"""The hardware model: a controller by name, or described inline."""

from __future__ import annotations

from typing import Annotated, Any, Literal, TypeAlias

from amalthea_uros.spec.fields import Before, Limits, WrittenAs, entry
from amalthea_uros.spec.section import DescriptionSection, Shorthand
from amalthea_uros.spec.values import CountOrNone, Name, Rate, Size, described, unexpected

MAX_CORES = 1024


class CoreSection(Shorthand):
    """A core: its name, or a mapping with more."""

    shorthand = ("name",)
    plain_value = "Name by which tasks, nodes and callbacks refer to it."

    name: Name
    """Name by which tasks, nodes and callbacks refer to it."""
    type: Name | None = None
    """Core type; default: the `core_type` of the hardware."""
    frequency: Rate | None = None
    """Clock of this core; default: the `frequency` of the hardware."""


def _of_number(value: Any) -> Any:
    if isinstance(value, list):
        return value
    if isinstance(value, bool) or not isinstance(value, int):
        raise unexpected("expected the number of cores, or a list of them")
    if not 1 <= value <= MAX_CORES:
        raise unexpected(f"expected 1 or more, up to {MAX_CORES}" if value > MAX_CORES else "expected 1 or more")
    return [{"name": f"Core_{index}"} for index in range(value)]


#: The cores, or their number: 4 means Core_0 to Core_3.
Cores: TypeAlias = Annotated[
    list[CoreSection],
    Limits(min_length=1, max_length=MAX_CORES),
    Before(_of_number),
    WrittenAs(Annotated[int, Limits(ge=1, le=MAX_CORES)] | list[CoreSection]),
]


_MEMORY_KINDS = described(
    SRAM="Static random access memory.",
    DRAM="Dynamic random access memory.",
    flash="Flash memory.",
    PCM="Phase-change memory.",
)


class LatenciesSection(DescriptionSection):
    """Core cycles of accesses to a memory from certain cores."""

    cores: list[Name] = entry(min_length=1)
    """Cores that it holds for."""
    read_cycles: CountOrNone
    """Core cycles per read access."""
    write_cycles: CountOrNone
    """Core cycles per write access."""


class MemorySection(DescriptionSection):
    """A memory."""

    name: Name
    """Name by which labels refer to it."""
    size: Size
    """Capacity."""
    kind: Annotated[Literal["SRAM", "DRAM", "flash", "PCM"], _MEMORY_KINDS] | None = None
    """Memory technology."""
    read_cycles: CountOrNone | None = None
    """Core cycles per read access."""
    write_cycles: CountOrNone | None = None
    """Core cycles per write access."""
    accesses: list[LatenciesSection] = entry(default_factory=list)
    """Core cycles per access where they depend on the core: a memory of one core is slower for the others."""


class HardwareSection(Shorthand):
    """The controller that the application runs on: a platform, or a mapping with more.

    Other keys override those of the platform.
    """

    shorthand = ("platform",)
    plain_value = "A known platform, or a file."

    platform: Name | None = entry(
        None, examples=["esp32", "nucleo-f446re", "bodas-rc18-12-40", "generic", "./my-controller.yaml"]
    )
    """A known platform (`bodas-rc18-12-40`, `ek-ra6m5`, `esp32`, `esp32-s3`, `generic`, `host`, `nucleo-f446re`, `nucleo-f746zg`,
    `nucleo-f767zi`, `nucleo-h743zi`, `olimex-stm32-e407`, `rp2040`, `single-core`, `tc389` or `teensy41`), or a file, e.g.
    `./my-controller.yaml`."""
    title: Name | None = None
    """Full name of the controller."""
    microcontroller: Name | None = None
    """Name of the microcontroller."""
    core_type: Name | None = None
    """Type of all cores without a `type`."""
    frequency: Rate | None = None
    """Clock of all cores without a `frequency`; together with `platform`: clock of all cores."""
    cores: Cores | None = None
    """The cores, or their number."""
    memories: list[MemorySection] | None = None
    """The memories."""
    label_memory: Name | None = None
    """Memory of all labels without a `memory`; default: the first SRAM."""
    ram_budget: Size | None = None
    """Memory that is left for micro-ROS: its pools, heap and stacks."""
