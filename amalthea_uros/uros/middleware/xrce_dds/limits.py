"""The build options that lengths of messages and waiting times depend on."""

from __future__ import annotations

from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.spec.profiles import ProfileData
from amalthea_uros.units import MILLISECOND, Time
from amalthea_uros.uros.middleware.figures import size, stated, stated_length

#: The option of the MTU of whatever transport, which has the same name in all descriptions.
ANY_MTU = "RMW_UXRCE_MTU"
HISTORY_OPTIONS = ("RMW_UXRCE_STREAM_HISTORY",)
#: The options that set the MTU of each transport; the first one that is stated counts. Serial lines and USB are custom transports of
#: the client in the projects for microcontrollers.
_MTU_OPTIONS = {
    "can": ("UCLIENT_CUSTOM_TRANSPORT_MTU",),
    "can_fd": (),
    "serial": ("UCLIENT_CUSTOM_TRANSPORT_MTU", "UCLIENT_SERIAL_TRANSPORT_MTU"),
    "usb_cdc": ("UCLIENT_CUSTOM_TRANSPORT_MTU", "UCLIENT_SERIAL_TRANSPORT_MTU"),
    "udp": ("UCLIENT_UDP_TRANSPORT_MTU",),
    "tcp": ("UCLIENT_TCP_TRANSPORT_MTU",),
    "custom": ("UCLIENT_CUSTOM_TRANSPORT_MTU",),
}


def mtu(middleware: Middleware, data: ProfileData) -> int:
    """The longest message of the transport in bytes; that of CAN FD is a constant."""
    if middleware.transport.can_fd is not None:
        return size(data, "can_mtu")
    length = stated_length(middleware.limits, *_options(middleware), ANY_MTU)
    return data.options["MTU"] if length is None else length


def mtu_options(middleware: Middleware) -> tuple[str, ...]:
    """The build option that sets the MTU of the transport; none for CAN FD."""
    options = _options(middleware)
    stated_ones = [name for name in (*options, ANY_MTU) if options and middleware.limits.states(name)]
    return tuple((stated_ones or options)[:1])


def _options(middleware: Middleware) -> tuple[str, ...]:
    used = [name for name in _MTU_OPTIONS if getattr(middleware.transport, name) is not None]
    return _MTU_OPTIONS[used[0] if used else "custom"]


def history(middleware: Middleware, data: ProfileData, direction: str) -> int:
    """The number of buffers of a reliable stream, `INPUT` or `OUTPUT`.

    Options for the directions replace the common one only if both are set (rmw_microxrcedds_c/CMakeLists.txt).
    """
    limits = middleware.limits
    names = [f"RMW_UXRCE_STREAM_HISTORY_{each}" for each in ("INPUT", "OUTPUT")]
    common = stated(limits, "RMW_UXRCE_STREAM_HISTORY") or data.options["RMW_UXRCE_STREAM_HISTORY"]
    if any(stated(limits, name) is None for name in names):
        return common
    return stated(limits, f"RMW_UXRCE_STREAM_HISTORY_{direction}") or common


def slots(middleware: Middleware, data: ProfileData) -> int | None:
    """The number of messages that can be stored for all handles together."""
    return stated(middleware.limits, "RMW_UXRCE_MAX_HISTORY") or data.waiting.slots


def publish_timeout(middleware: Middleware, data: ProfileData) -> Time:
    """Time after which a sender stops waiting for the acknowledgement."""
    if middleware.reliable.timeout is not None:
        return middleware.reliable.timeout
    option = stated(middleware.limits, "RMW_UXRCE_PUBLISH_RELIABLE_TIMEOUT")
    return data.sending.timeout if option is None else option * MILLISECOND


def heartbeat_interval(middleware: Middleware, data: ProfileData) -> Time | None:
    """Time without input after which the client asks for an acknowledgement."""
    option = stated(middleware.limits, "UCLIENT_MIN_HEARTBEAT_TIME_INTERVAL")
    return data.sending.resends_after if option is None else option * MILLISECOND
