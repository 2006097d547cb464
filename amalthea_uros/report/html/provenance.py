"""By which methods the numbers of an analysis were computed."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.analyze.results.analysis import Analysis


def methods(analysis: Analysis) -> tuple[str, ...]:
    """The methods of response times and latencies with their sources, each once."""
    return tuple(dict.fromkeys(_all_methods(analysis)))


def _all_methods(analysis: Analysis) -> Iterator[str]:
    for process in analysis.processes:
        if process.response is not None:
            yield f"Response times: {process.response.method} ({process.response.source})"
    for chain in analysis.chains:
        for value in chain.values:
            yield f"Latencies: {value.method} ({value.source})"
