"""The end-to-end latencies of chains, by the same names wherever they are simulated or measured."""

from __future__ import annotations

from enum import StrEnum


class ChainQuantity(StrEnum):
    """An end-to-end latency of a chain, as observed at each stimulus or at each response; docs/chains.md defines them."""

    REACTION_TIME = "reaction_time"
    REDUCED_REACTION_TIME = "reduced_reaction_time"
    DATA_AGE = "data_age"
    REDUCED_DATA_AGE = "reduced_data_age"
    FIRST_TO_FIRST = "first_to_first"
    FIRST_TO_LAST = "first_to_last"
    LAST_TO_FIRST = "last_to_first"
    LAST_TO_LAST = "last_to_last"
