"""The latencies of a chain."""

from __future__ import annotations

from enum import StrEnum

from amalthea_uros._internal.by_name import Results
from amalthea_uros._internal.records import dataclass, field
from amalthea_uros._internal.shown import Shown
from amalthea_uros.analyze.results.processes import bound_text
from amalthea_uros.executors.results import Hop
from amalthea_uros.timing.response import Claim
from amalthea_uros.units import Time


class LatencyQuantity(StrEnum):
    """An end-to-end latency of a chain."""

    MAX_REACTION_TIME = "max_reaction_time"
    MAX_REDUCED_REACTION_TIME = "max_reduced_reaction_time"
    MAX_DATA_AGE = "max_data_age"
    MAX_REDUCED_DATA_AGE = "max_reduced_data_age"
    MAX_FIRST_TO_LAST = "max_first_to_last"
    MAX_LAST_TO_FIRST = "max_last_to_first"
    MIN_FIRST_TO_FIRST = "min_first_to_first"
    MIN_LAST_TO_LAST = "min_last_to_last"
    MIN_LAST_TO_FIRST = "min_last_to_first"
    MEAN_REACTION_TIME = "mean_reaction_time"
    MEAN_FIRST_TO_FIRST = "mean_first_to_first"
    MEAN_LAST_TO_LAST = "mean_last_to_last"

    @property
    def is_upper(self) -> bool:
        """Whether it is a maximum, so that bounds are upper bounds."""
        return self.startswith("max")

    @property
    def is_reaction(self) -> bool:
        """Whether it is a maximum reaction time, also a reduced one."""
        return self in (LatencyQuantity.MAX_REACTION_TIME, LatencyQuantity.MAX_REDUCED_REACTION_TIME)

    @property
    def is_mean(self) -> bool:
        """Whether it is a mean."""
        return self.startswith("mean")


#: The quantities that can be explained.
EXPLAINED: tuple[LatencyQuantity, ...] = (
    LatencyQuantity.MAX_REACTION_TIME,
    LatencyQuantity.MAX_REDUCED_REACTION_TIME,
    LatencyQuantity.MAX_DATA_AGE,
    LatencyQuantity.MAX_REDUCED_DATA_AGE,
)
#: The latencies that limits of chains by these names limit.
LIMITED = {"reaction": LatencyQuantity.MAX_REDUCED_REACTION_TIME, "data age": LatencyQuantity.MAX_REDUCED_DATA_AGE}


@dataclass(frozen=True, slots=True, kw_only=True)
class LatencyValue:
    """A quantity by one method, in picoseconds; None if there is no finite value or it is unknown."""

    quantity: LatencyQuantity
    value: Time | None
    claim: Claim
    method: str
    source: str
    reason: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class ChainResult(Shown):
    """A chain.

    Attributes
    ----------
    routes : readable texts: the events and the links between them
    values : the tightest value of each quantity
    all_values : the values of all methods
    why : why the values are exact or only bounds
    reason : why some or all values are missing
    remedy : what to do about it, if that is known
    crosses_messages : whether it crosses wires, the agent or executors in loops; what follows is only known of such chains
    start, end : what its latency starts and ends with, such as `/cmd_vel` and `pwm`
    hops : in order; empty if they are not known, for the `reason`
    loss : how messages can be lost; "" if none can. Then the sum of the hops only holds for messages that are not lost
    assumptions : on which the hops are based
    """

    name: str
    communication: str
    routes: tuple[str, ...] = ()
    values: tuple[LatencyValue, ...] = ()
    all_values: tuple[LatencyValue, ...] = ()
    why: str = ""
    reason: str = ""
    remedy: str = ""
    crosses_messages: bool = False
    start: str = ""
    end: str = ""
    hops: Results[Hop] = field(default_factory=Results)
    loss: str = ""
    assumptions: tuple[str, ...] = ()

    def __repr__(self) -> str:
        shown = [value for value in self.values if value.quantity in EXPLAINED] or self.values
        texts = [f"{value.quantity.replace('_', ' ')} {bound_text(value.value)} ({value.claim})" for value in shown]
        return f"<ChainResult {self.name}: {', '.join(texts) or self.reason or 'no values'}>"

    def value(self, quantity: LatencyQuantity) -> LatencyValue | None:
        """The tightest value of a quantity."""
        return next((value for value in self.values if value.quantity is quantity), None)

    @property
    def best(self) -> Time | None:
        """A lower bound of the latency from the first event to the last; None if it is unknown."""
        value = self.value(LatencyQuantity.MIN_FIRST_TO_FIRST)
        return None if value is None else value.value

    @property
    def worst(self) -> Time | None:
        """An upper bound of the reduced reaction time; None if there is none."""
        value = self.value(LatencyQuantity.MAX_REDUCED_REACTION_TIME)
        return None if value is None else value.value

    @property
    def worst_if_not_lost(self) -> Time | None:
        """The sum of the hops, an upper bound for messages that are not lost; None if one is unknown, or there are no hops."""
        times = [hop.worst for hop in self.hops]
        return None if not times or None in times else sum(filter(None, times))
