"""The occurrences of external stimuli."""

from amalthea_uros.simulate.arrivals.occurrences import Occurrences, UnknownArrivalError
from amalthea_uros.simulate.arrivals.stimuli import occurrences

__all__ = ["Occurrences", "UnknownArrivalError", "occurrences"]
