"""Invalid access path."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import HwAccessElement, HwAccessPath, HwConnection, HwDestination, HwPathElement, Memory
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.magnitudes import bits
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.app4mc.ports import share_no_port


def _check(element: HwAccessPath, context: Context) -> Iterator[str]:
    access = element.container
    destination = access.destination if isinstance(access, HwAccessElement) else None
    yield from _addresses(element, destination)
    if element.path_elements:
        source = access.container if access is not None else None
        yield from _end(element.path_elements[0], source, "start")
        if destination is None:
            yield "the path has no destination"
        yield from _end(element.path_elements[-1], destination, "end")
        for first, second in pairwise(element.path_elements):
            if share_no_port(first, second):
                yield f"{first.qualified_name!r} and {second.qualified_name!r} are adjacent, but share no port"


def _addresses(path: HwAccessPath, destination: HwDestination | None) -> Iterator[str]:
    start, end, offset = (path.start_address or 0), (path.end_address or 0), (path.mem_offset or 0)
    if end < start:
        yield f"the end address {end:#x} is below the start address {start:#x}"
    if not isinstance(destination, Memory) or destination.unresolved is not None:
        return
    if destination.definition is None:
        yield f"the destination memory {destination.name!r} has no definition"
        return
    size = bits(destination.definition.size)
    if size is not None and start <= end and 8 * (offset + end - start) > size:
        yield f"{end - start:#x} bytes at offset {offset:#x} exceed the {size // 8:#x} bytes of {destination.name!r}"


def _end(element: HwPathElement, neighbour: Element | None, which: str) -> Iterator[str]:
    if element.unresolved is not None:
        return
    if not isinstance(element, HwConnection):
        yield f"{element.qualified_name!r} at the {which} of the path is not a connection"
    elif neighbour is not None and share_no_port(element, neighbour):
        yield f"connection {element.name!r} at the {which} of the path has no port of {neighbour.qualified_name!r}"


RULE = ModelRule(
    id="AM-HW-AccessPath",
    title="invalid access path",
    severity=Severity.ERROR,
    target=HwAccessPath,
    check=_check,
    rationale="The access latency is the sum over the elements of the path, so the path must be complete. APP4MC's validation "
    "also reports it.",
    remedy="Connect the processing unit to the destination by connections that share ports, and keep the addresses within the memory.",
    fails="""
<hwModel>
  <definitions xsi:type="am:MemoryDefinition" name="D">
    <size value="1" unit="KiB"/>
  </definitions>
  <structures name="ECU">
    <modules xsi:type="am:ProcessingUnit" name="core">
      <ports name="p"/>
      <accessElements name="a" destination="RAM?type=Memory">
        <accessPath name="way" pathElements="ECU/wire?type=HwConnection" startAddress="0x0" endAddress="0x401"/>
      </accessElements>
    </modules>
    <modules xsi:type="am:Memory" name="RAM" definition="D?type=MemoryDefinition">
      <ports name="p"/>
    </modules>
    <connections name="wire" port1="core/p?type=HwPort"/>
  </structures>
</hwModel>
""",
    edits={
        'endAddress="0x401"': 'endAddress="0x400"',
        'port1="core/p?type=HwPort"': 'port1="core/p?type=HwPort" port2="RAM/p?type=HwPort"',
    },
)
