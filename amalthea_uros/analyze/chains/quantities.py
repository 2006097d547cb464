"""What is told of a chain. `docs/chains.md` has the definitions and a picture of each."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from amalthea_uros.analyze.response_times.task import Claim
from amalthea_uros.units import Time


class Quantity(StrEnum):
    """A latency from the start of a chain to its end."""

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
        """Whether a bound of it is one from above."""
        return self.value.startswith("max")

    @property
    def is_mean(self) -> bool:
        """Whether it is a mean value."""
        return self.value.startswith("mean")


@dataclass(frozen=True, slots=True, kw_only=True)
class Value:
    """A quantity as one method tells it, in picoseconds; None: there is no finite value, or not known."""

    quantity: Quantity
    value: Time | None
    claim: Claim
    method: str
    source: str
    reason: str = ""
