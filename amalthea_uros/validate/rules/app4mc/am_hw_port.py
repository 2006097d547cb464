"""Port with several connections."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import HwPort, HwStructure
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.app4mc._hardware import connections_outside


def _check(element: HwPort, context: Context) -> Iterator[str]:
    count = context.once(connections_outside)[element]
    if count > 1 and not isinstance(element.container, HwStructure):
        yield f"port {element.qualified_name!r} has {count} connections, but at most 1 is allowed"


RULE = ModelRule(
    id="AM-HW-Port",
    title="port with several connections",
    severity=Severity.ERROR,
    target=HwPort,
    check=_check,
    rationale="A connection links exactly two ports; only a connection handler can link more. APP4MC's validation also reports it.",
    remedy="Use a separate port for each connection, or insert a connection handler.",
    fails="""
<hwModel>
  <structures name="ECU">
    <modules xsi:type="am:ProcessingUnit" name="core">
      <ports name="p"/>
    </modules>
    <modules xsi:type="am:Memory" name="RAM">
      <ports name="p"/>
      <ports name="q"/>
    </modules>
    <connections name="a" port1="core/p?type=HwPort" port2="RAM/p?type=HwPort"/>
    <connections name="b" port1="core/p?type=HwPort" port2="RAM/q?type=HwPort"/>
  </structures>
</hwModel>
""",
    edits={
        """</modules>
    <modules xsi:type="am:Memory" name="RAM">""": """  <ports name="q"/>
    </modules>
    <modules xsi:type="am:Memory" name="RAM">""",
        'name="b" port1="core/p?type=HwPort"': 'name="b" port1="core/q?type=HwPort"',
    },
)
