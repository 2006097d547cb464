"""Every AMALTHEA class and enumeration, for AMALTHEA 0.9.7 to 3.3.0: `am.Task`, `am.PeriodicStimulus`, `am.Time(10, "ms")`."""

from amalthea_uros.metamodel.classes import *  # noqa: F403
from amalthea_uros.metamodel.classes import __all__ as __all__
