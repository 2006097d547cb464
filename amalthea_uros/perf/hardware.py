"""Hardware: clocks, cores, memories, what lies between them, and what an access costs."""

from __future__ import annotations

from collections.abc import Iterator
from enum import StrEnum

from amalthea_uros._internal.records import dataclass
from amalthea_uros.perf.distributions import Distribution
from amalthea_uros.perf.named import Brief, Named
from amalthea_uros.units import BitRate, DataSize, Frequency


class StructureKind(StrEnum):
    """What a part of the hardware is."""

    SYSTEM = "system"
    ECU = "ECU"
    MICROCONTROLLER = "microcontroller"
    SOC = "SoC"
    CLUSTER = "cluster"
    GROUP = "group"
    ARRAY = "array"
    AREA = "area"
    REGION = "region"


class CoreKind(StrEnum):
    """What kind of processing unit it is."""

    CPU = "CPU"
    GPU = "GPU"
    ACCELERATOR = "accelerator"


class MemoryKind(StrEnum):
    """The technology of a memory."""

    SRAM = "SRAM"
    DRAM = "DRAM"
    FLASH = "flash"
    PCM = "PCM"


class Arbitration(StrEnum):
    """How an interconnect decides between accesses that wait."""

    ROUND_ROBIN = "round robin"
    FIRST_COME = "first come first served"
    PRIORITY = "priority"


@dataclass(frozen=True, slots=True, kw_only=True)
class Clock(Named):
    """A clock of the hardware; None: its frequency is not known."""

    frequency: Frequency | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Feature:
    """A number that a core type has, such as its ticks per unit of an execution need.

    Attributes
    ----------
    category : what the number is about; execution needs are looked up by it
    name : unique in the category
    """

    category: str
    name: str
    value: float


@dataclass(frozen=True, slots=True, kw_only=True)
class CoreType(Named):
    """A type of core; execution demand may differ between types."""

    kind: CoreKind | None = None
    features: tuple[Feature, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Latency:
    """What reads and writes cost, in cycles; alternatively the data rate.

    Attributes
    ----------
    read : request and response together
    write : the request
    """

    read: Distribution[int] | None = None
    write: Distribution[int] | None = None
    rate: BitRate | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Access:
    """What it costs a core to access a memory.

    Attributes
    ----------
    latency : in cycles of the core
    path : caches, interconnects and connections on the way; if given, they make up the cost instead of the latency here
    """

    memory: str
    latency: Latency = Latency()
    path: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Cache(Named):
    """A cache.

    Attributes
    ----------
    latency : cycles of the cache's own clock
    hit_rate : per cent
    """

    clock: str | None = None
    size: DataSize | None = None
    latency: Distribution[int] | None = None
    hit_rate: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Core(Named):
    """A processing unit."""

    type: str | None = None
    clock: str | None = None
    accesses: tuple[Access, ...] = ()
    caches: tuple[Cache, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Memory(Named):
    """A memory.

    Attributes
    ----------
    latency : cycles of the memory's own clock, added to the cost of the way there
    """

    clock: str | None = None
    kind: MemoryKind | None = None
    size: DataSize | None = None
    latency: Distribution[int] | None = None
    rate: BitRate | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Interconnect(Named):
    """A bus or crossbar that arbitrates between accesses; latencies in cycles of its own clock."""

    clock: str | None = None
    arbitration: Arbitration | None = None
    latency: Latency = Latency()


@dataclass(frozen=True, slots=True, kw_only=True)
class Connection(Named):
    """A link from one module to another; latencies in cycles of the module before it on a path."""

    source: str
    target: str
    latency: Latency = Latency()


@dataclass(frozen=True, slots=True, kw_only=True)
class Structure(Named):
    """A part of the hardware with what it contains."""

    kind: StructureKind | None = None
    structures: tuple[Structure, ...] = ()
    cores: tuple[Core, ...] = ()
    memories: tuple[Memory, ...] = ()
    caches: tuple[Cache, ...] = ()
    interconnects: tuple[Interconnect, ...] = ()
    connections: tuple[Connection, ...] = ()

    def walk(self) -> Iterator[Structure]:
        """The structure itself and all within it."""
        yield self
        for structure in self.structures:
            yield from structure.walk()


@dataclass(frozen=True, slots=True, kw_only=True)
class Hardware(Brief):
    """All hardware of a system."""

    clocks: tuple[Clock, ...] = ()
    core_types: tuple[CoreType, ...] = ()
    structures: tuple[Structure, ...] = ()

    def walk(self) -> Iterator[Structure]:
        """All structures, outer before inner."""
        for structure in self.structures:
            yield from structure.walk()
