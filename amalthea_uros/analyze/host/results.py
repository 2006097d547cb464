"""The results of a host."""

from __future__ import annotations

from amalthea_uros._internal.by_name import Results
from amalthea_uros._internal.records import dataclass
from amalthea_uros.analyze.host.releases import HostReleases
from amalthea_uros.executors.results import ExecutorResult


@dataclass(frozen=True, slots=True)
class HostResults:
    """The results of a host.

    Attributes
    ----------
    releases : with the latencies from the first callback of each route
    """

    releases: HostReleases
    executors: Results[ExecutorResult]
