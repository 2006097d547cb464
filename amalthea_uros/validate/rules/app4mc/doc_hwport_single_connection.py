"""Too many connections at a port."""

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
        yield f"port {element.qualified_name!r} has {count} connections, but at most {most} {'is' if most == 1 else 'are'} allowed"


RULE = ModelRule(
    id="DOC-HwPort-Single-Connection",
    title="too many connections at a port",
    severity=Severity.ERROR,
    target=HwPort,
    check=_check,
    rationale="A port of a structure has one outer and one inner connection, any other port only one; connections inside "
    "connection handlers are not counted. The APP4MC documentation requires this.",
    remedy="Use a separate port for each connection, or insert a connection handler.",
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
    edits={'    <connections name="z" port1="ECU/p?type=HwPort" port2="RAM/c?type=HwPort"/>\n': ""},
)
