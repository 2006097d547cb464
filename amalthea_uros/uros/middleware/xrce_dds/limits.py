"""The build options that lengths of messages and waiting times depend on."""

from __future__ import annotations

from amalthea_uros.spec.application import Application
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.spec.profiles import ProfileData
from amalthea_uros.units import MILLISECOND, Time
from amalthea_uros.uros.middleware import figures
from amalthea_uros.uros.middleware.xrce_dds.pools import histories_of, mtu_of, options


def mtu(middleware: Middleware, data: ProfileData) -> int:
    """The longest message of the transport in bytes."""
    return mtu_of(middleware, data.options)


def input_history(middleware: Middleware, data: ProfileData) -> int:
    """The number of buffers of the reliable stream from the agent."""
    return histories_of(middleware, data.options)[0]


def output_history(middleware: Middleware, data: ProfileData) -> int:
    """The number of buffers of the reliable stream to the agent."""
    return histories_of(middleware, data.options)[1]


def slots(middleware: Middleware, data: ProfileData) -> int:
    """The number of messages that can be stored for all handles together."""
    return _option("RMW_UXRCE_MAX_HISTORY", middleware, data)


def publish_timeout(middleware: Middleware, data: ProfileData) -> Time:
    """Time after which a sender stops waiting for the acknowledgement."""
    if middleware.reliable.timeout is not None:
        return middleware.reliable.timeout
    return _option("RMW_UXRCE_PUBLISH_RELIABLE_TIMEOUT", middleware, data) * MILLISECOND


def heartbeat_interval(middleware: Middleware, data: ProfileData) -> Time:
    """Time without input after which the client asks for an acknowledgement."""
    return _option("UCLIENT_MIN_HEARTBEAT_TIME_INTERVAL", middleware, data) * MILLISECOND


def _option(name: str, middleware: Middleware, data: ProfileData) -> int:
    return figures.option(options(Application(), middleware, data), name)
