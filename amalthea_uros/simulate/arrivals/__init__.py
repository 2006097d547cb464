"""The occurrences of external stimuli."""

from amalthea_uros.simulate.arrivals.occurrences import StimulusOccurrences
from amalthea_uros.simulate.arrivals.stimuli import occurrences

__all__ = ["StimulusOccurrences", "occurrences"]
