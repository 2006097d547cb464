"""Port with more connections than its kind has."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import HwPort, HwStructure
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.app4mc._hardware import connections_outside


def _check(element: HwPort, context: Context) -> Iterator[str]:
    count = context.once(connections_outside)[element]
    most = 2 if isinstance(element.container, HwStructure) else 1
    if count > most:
        yield f"{count} connections lead to the port {element.qualified_name!r}, of at most {most}"


RULE = ModelRule(
    id="DOC-HwPort-Single-Connection",
    title="port with more connections than its kind has",
    severity=Severity.ERROR,
    target=HwPort,
    check=_check,
    rationale="The port of a structure is joined on the outside and on the inside, the port of a module once; "
    "connections inside connection handlers come on top. The documentation of APP4MC asks for no more.",
    remedy="Give each connection a port of its own, or put a connection handler in between.",
    fails="""
<hwModel>
  <structures name="ECU">
    <ports name="p"/>
    <modules xsi:type="am:Memory" name="RAM">
      <ports name="a"/>
      <ports name="b"/>
      <ports name="c"/>
    </modules>
    <connections name="x" port1="ECU/p?type=HwPort" port2="RAM/a?type=HwPort"/>
    <connections name="y" port1="ECU/p?type=HwPort" port2="RAM/b?type=HwPort"/>
    <connections name="z" port1="ECU/p?type=HwPort" port2="RAM/c?type=HwPort"/>
  </structures>
</hwModel>
""",
    passes="""
<hwModel>
  <structures name="ECU">
    <ports name="p"/>
    <modules xsi:type="am:Memory" name="RAM">
      <ports name="a"/>
      <ports name="b"/>
      <ports name="c"/>
    </modules>
    <connections name="x" port1="ECU/p?type=HwPort" port2="RAM/a?type=HwPort"/>
    <connections name="y" port1="ECU/p?type=HwPort" port2="RAM/b?type=HwPort"/>
  </structures>
</hwModel>
""",
)
