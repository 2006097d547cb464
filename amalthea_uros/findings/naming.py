"""What the messages of findings name, to see whether two findings are about the same thing."""

from __future__ import annotations

import re

from amalthea_uros.diagnostics import Finding

_QUOTED = re.compile(r"""['"<]([^'"<>]+)['">]""")

#: What stands in a reference between the name of an object and its class.
_TYPE = "?type="


def names_in(finding: Finding) -> frozenset[str]:
    """What a message names in quotes; where it quotes references, only the objects to which these refer."""
    quoted = _QUOTED.findall(finding.message)
    references = [name.partition(_TYPE)[0] for name in quoted if _TYPE in name]
    return frozenset(references or quoted)


def stems(names: frozenset[str]) -> frozenset[str]:
    """Names with what comes before their last underscore: an event `Task_start` is one of `Task`."""
    return names | {name.rpartition("_")[0] for name in names if "_" in name.strip("_")}


def likeness(one: frozenset[str], other: frozenset[str]) -> float:
    """Which part of the names of two findings is the same, from 0 to 1; of the shorter list all must be found for 1."""
    fewer, more = sorted((one, other), key=len)
    if not fewer:
        return 0.0
    found = sum(name in stems(more) or not stems(frozenset((name,))).isdisjoint(more) for name in fewer)
    return found / len(fewer)
