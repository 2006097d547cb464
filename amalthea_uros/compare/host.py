"""Bounds of a host for the times that recordings of ROS 2 show: of callbacks, and of messages up to the callbacks that take them.

A recording does not show when a message is in its queue or a timer is due, so that response times are not measured. But the gross
execution time of a callback is a part of its response time, and from a publication to the begin of the callback it takes at most the
latency of the topic and that response time. A timer is called within its response time after it is due.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from amalthea_uros._internal.by_name import Results
from amalthea_uros._internal.records import dataclass
from amalthea_uros.compare.agreement import Prediction
from amalthea_uros.compare.measured.receptions import receptions
from amalthea_uros.compare.results import PredictionClaim, Statistic
from amalthea_uros.executors.results import ExecutorResult, HandleResult
from amalthea_uros.measure.series import MeasuredKind
from amalthea_uros.perf.host import Host, HostCallback
from amalthea_uros.timing.basics.quantities import ChainQuantity, JobMetric
from amalthea_uros.units import Time

#: Of a message from its publication to the begin of the callback that takes this very message.
_OF_MESSAGES = (ChainQuantity.REDUCED_DATA_AGE, ChainQuantity.LAST_TO_LAST, ChainQuantity.LAST_TO_FIRST)
_STATED = "stated execution time, with what the executor does before"
_WHOLE = "analysis of the response time, of which it is a part"
_LATENCY = "latency of the topic, and analysis of the response time"
_WITHIN = "period, and analysis of the response time"


@dataclass(frozen=True, slots=True)
class HostPredictor:
    """Looks up what is predicted of a host.

    Attributes
    ----------
    results : of the executors, by the analysis
    """

    host: Host
    results: Results[ExecutorResult]

    def of(self, kind: MeasuredKind, name: str, quantity: str) -> dict[Statistic, Prediction]:
        """The bounds of a quantity."""
        return dict(self._bounds(kind, name, quantity))

    def reason(self, kind: MeasuredKind, name: str) -> str:
        """Why nothing is known of something, "" if that is not the reason."""
        callback = self._callback(kind, name)
        handle = None if callback is None else self._handle(callback)
        executors = [each for each in self.results if callback is not None and callback.name in each.handles.names]
        reason = next((each.reason for each in executors), "")
        return reason or ("" if handle is None else handle.response.reason)

    def _bounds(self, kind: MeasuredKind, name: str, quantity: str) -> Iterator[tuple[Statistic, Prediction]]:
        callback = self._callback(kind, name)
        handle = None if callback is None else self._handle(callback)
        if callback is None or handle is None:
            return
        worst = handle.response.worst
        match kind, quantity:
            case MeasuredKind.CHAIN, _ if quantity in _OF_MESSAGES:
                latency = next(topic.latency for topic in self.host.topics if topic.name == callback.topic)
                yield _bound(Statistic.MIN, latency.least, "latency of the topic")
                if worst is not None and latency.most is not None:
                    yield _bound(Statistic.MAX, latency.most + worst, _LATENCY)
            case MeasuredKind.RUNNABLE, (JobMetric.NET_EXECUTION_TIME | JobMetric.RUNNING_TIME):
                if callback.execution.most is not None:
                    yield _bound(Statistic.MAX, callback.execution.most, _STATED)
            case MeasuredKind.RUNNABLE, JobMetric.GROSS_EXECUTION_TIME if worst is not None:
                yield _bound(Statistic.MAX, worst, _WHOLE)
            case MeasuredKind.RUNNABLE, JobMetric.START_TO_START if callback.period is not None:
                if worst is not None:
                    yield from _distances(callback.period, worst, handle.lost is not None)

    def _callback(self, kind: MeasuredKind, name: str) -> HostCallback | None:
        if kind is MeasuredKind.CHAIN:
            return receptions(self.host).get(name)
        return next((each for each in self.host.callbacks if each.name == name), None)

    def _handle(self, callback: HostCallback) -> HandleResult | None:
        handles = (each.handles[callback.name] for each in self.results if callback.name in each.handles.names)
        return next(handles, None)


def _distances(period: Time, worst: Time, can_lose: bool) -> Iterator[tuple[Statistic, Prediction]]:
    yield _bound(Statistic.MIN, max(period - worst, 0), _WITHIN)
    if not can_lose:
        yield _bound(Statistic.MAX, period + worst, _WITHIN)


def _bound(statistic: Statistic, value: Time, method: str) -> tuple[Statistic, Prediction]:
    return statistic, Prediction(value=Fraction(value), claim=PredictionClaim.BOUND, method=method)
