"""Ways as chains: their latency in the terms of event chains, so that limits on chains are judged by it."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.analyze.results.chains import ChainResult, Quantity, Value
from amalthea_uros.analyze.ways.results import METHOD, SOURCE, Way
from amalthea_uros.timing.response import Claim

_WHY = "bounds: the worst cases of the hops need not occur together"


def chain_result(way: Way) -> ChainResult:
    """The chain of a way; its data age is not bounded."""
    values = tuple(_values(way))
    return ChainResult(
        name=way.name,
        communication="over wires and executors",
        routes=(" -> ".join((way.start, *dict.fromkeys(hop.name for hop in way.hops), way.end)),),
        values=values,
        all_values=values,
        why=_WHY,
        reason=way.reason or way.loss,
    )


def _values(way: Way) -> Iterator[Value]:
    if not way.hops:
        return
    yield _value(Quantity.MIN_FIRST_TO_FIRST, way.best)
    if way.worst is not None:
        yield _value(Quantity.MAX_REDUCED_REACTION_TIME, way.worst)


def _value(quantity: Quantity, time: int) -> Value:
    return Value(quantity=quantity, value=time, claim=Claim.BOUND, method=METHOD, source=SOURCE)
