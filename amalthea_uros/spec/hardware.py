"""The hardware model: a controller by name, or described inline."""

from __future__ import annotations

from typing import Annotated, Any, Literal, TypeAlias

from pydantic import BeforeValidator, Field

from amalthea_uros.spec.section import Section, Shorthand
from amalthea_uros.spec.values import CountOrNone, Name, Rate, Size

MAX_CORES = 1024


class Core(Shorthand):
    """A core: its name, or a mapping with more."""

    shorthand = ("name",)

    name: Name
    """What tasks, nodes and callbacks call it."""
    type: Name | None = None
    """Type of core; default: the `core_type` of the hardware."""
    frequency: Rate | None = None
    """Clock of this core; default: the `frequency` of the hardware."""


def _of_number(value: Any) -> Any:
    is_number = isinstance(value, int) and not isinstance(value, bool)
    return [{"name": f"Core_{index}"} for index in range(min(value, MAX_CORES + 1))] if is_number else value


#: The cores themselves, or how many there are: 4 stands for Core_0 to Core_3.
Cores: TypeAlias = Annotated[
    list[Core],
    Field(min_length=1, max_length=MAX_CORES),
    BeforeValidator(_of_number, json_schema_input_type=Annotated[int, Field(ge=1, le=MAX_CORES)] | list[Core]),
]


class Memory(Section):
    """A memory."""

    name: Name
    """What labels call it."""
    size: Size
    """How much fits into it."""
    kind: Literal["SRAM", "DRAM", "flash", "PCM"] | None = None
    """Its technology."""
    read_cycles: CountOrNone | None = None
    """Cycles of a core that a read takes."""
    write_cycles: CountOrNone | None = None
    """Cycles of a core that a write takes."""


class Hardware(Shorthand):
    """The controller that the application runs on: a platform, or a mapping in which more is stated.

    What stands beside `platform` replaces what the platform says.
    """

    shorthand = ("platform",)

    platform: Name | None = None
    """A platform that amuros knows (`bodas-rc18-12-40`, `generic`, `single-core`), or a file such as `./my-controller.yaml`."""
    title: Name | None = None
    """What the controller is called in full."""
    microcontroller: Name | None = None
    """The microcontroller."""
    core_type: Name | None = None
    """The type of all cores that do not state theirs."""
    frequency: Rate | None = None
    """The clock of all cores that do not state theirs; beside `platform`: of all cores."""
    cores: Cores | None = None
    """The cores, or how many there are."""
    memories: list[Memory] | None = None
    """The memories."""
    label_memory: Name | None = None
    """The memory of labels that do not state theirs; default: the first SRAM."""


class Platform(Section):
    """A controller that applications can name."""

    amuros: Literal[1]
    """Version of the format."""
    platform: Name
    """The name by which execution times refer to it."""
    hardware: Hardware
    """The hardware itself."""
    source: str | None = None
    """Where the figures come from."""
