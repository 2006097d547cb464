"""The occurrences of external stimuli."""

from amalthea_uros.simulate.arrivals.occurrences import StimulusOccurrences
from amalthea_uros.simulate.arrivals.stimuli import least_count, occurrences

__all__ = ["StimulusOccurrences", "least_count", "occurrences"]
