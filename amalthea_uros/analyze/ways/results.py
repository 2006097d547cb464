"""The results for the ways of messages."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from amalthea_uros._internal.shown import Shown
from amalthea_uros.executors.results import Hop
from amalthea_uros.units import Time, time_text

#: The method of the bound, as tables and JSON call it.
METHOD = "sum of hop bounds"
#: Response times of the parts are added up, which needs no assumption on when their worst cases occur.
SOURCE = "compositional analysis, K. Richter 2005"


@dataclass(frozen=True, slots=True, kw_only=True)
class Way(Shown):
    """A chain that crosses wires, the agent or executors that loop, with bounds of its latency.

    Attributes
    ----------
    name : of the chain
    start, end : what its latency starts and ends with, such as `/cmd_vel` and `pwm`
    hops : in order; empty if the way is not known, for the `reason`
    reason : why there is no bound; "" if there is one
    remedy : what to do about it
    loss : how messages can be lost on the way; "" if none can. Then the sum only holds for those that are not
    """

    name: str
    start: str
    end: str
    hops: tuple[Hop, ...]
    assumptions: tuple[str, ...] = ()
    reason: str = ""
    remedy: str = ""
    loss: str = ""

    def __repr__(self) -> str:
        worst = "unknown" if self.worst is None else time_text(self.worst)
        return f"<Way {self.name}: {self.start} to {self.end}, at most {worst}>"

    @property
    def best(self) -> Time:
        """A lower bound of the latency: the sum of the best cases."""
        return sum(hop.best for hop in self.hops)

    @property
    def delivered(self) -> Time | None:
        """An upper bound of the latency of messages that are not lost: the sum of the worst cases; None if one is unknown."""
        times = [hop.worst for hop in self.hops]
        return None if self.reason or not times or None in times else sum(filter(None, times))

    @property
    def worst(self) -> Time | None:
        """An upper bound of the latency; None if there is none, because a hop has none or messages can be lost."""
        return None if self.loss else self.delivered

    def share(self, hop: Hop) -> Fraction | None:
        """The part of the upper bound that a hop is; None if one of both is unknown."""
        whole = self.delivered
        return Fraction(hop.worst, whole) if whole and hop.worst is not None else None
