"""How far the arrivals of messages at executors vary, besides the jitter that is stated: each hop before can take its best or its
worst time (K. Richter 2005).
"""

from __future__ import annotations

from collections.abc import Mapping

from amalthea_uros.analyze.solution import Solution
from amalthea_uros.analyze.ways.messages import agent_hop, received, variation
from amalthea_uros.units import Time

#: Why a latency of the agent that nobody stated does not make arrivals unknown, if the description states the jitter of messages.
ASSUMPTION = "where the latency of the agent is not stated, the stated jitter is that of the messages that enter the wire"


def arrival_jitter(solution: Solution) -> Mapping[str, Time | None]:
    """The jitter of arrivals by the names of handles; None if a hop has no bound."""
    found: dict[str, Time | None] = {}
    for executor in solution.context.system.executors:
        for handle in executor.handles:
            transmission = solution.context.system.transmissions.get(handle.transmission or "")
            if transmission is None:
                continue
            agent = agent_hop(transmission, solution)
            # Otherwise, nothing activates what stands for the message on the wire, which has no bound then.
            stated = [] if agent.worst is None else [agent]
            jitter = found[handle.name] = variation([*stated, *received(transmission, solution)])
            if agent.worst is None and jitter is not None:
                solution.context.notes.assume(ASSUMPTION)
    return found
