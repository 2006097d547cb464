"""The values of the build options of rmw_microxrcedds and its client, as a description and a profile state them."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from pathlib import Path

from amalthea_uros._internal.ports import Port, known_ports
from amalthea_uros._internal.records import dataclass
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.uros.middleware.options import OptionRow, option_rows

#: The CAN FD transport has no option for it (eProsima/Micro-XRCE-DDS-Client src/c/profile/transport/can/can_transport.c).
_CAN_FD_MTU = 63
_INPUT, _OUTPUT = "RMW_UXRCE_STREAM_HISTORY_INPUT", "RMW_UXRCE_STREAM_HISTORY_OUTPUT"


@cache
def rows() -> Mapping[str, OptionRow]:
    """The table of options."""
    return option_rows(Path(__file__).parent)


@dataclass(frozen=True, slots=True)
class XrceBuild:
    """The build options of a description.

    Attributes
    ----------
    defaults : those of the profile, where they differ from those of the packages
    """

    middleware: Middleware
    defaults: Mapping[str, int]

    @property
    def port(self) -> Port | None:
        """The port, if it is stated."""
        return known_ports().get(self.middleware.port or "")

    @property
    def transport(self) -> str:
        """The transport that the middleware is built with; microcontrollers have a custom one for serial lines, too."""
        wire, limits = self.middleware.transport, self.middleware.limits
        if limits.RMW_UXRCE_TRANSPORT is not None:
            return limits.RMW_UXRCE_TRANSPORT
        if self.port is not None and self.port.is_custom:
            return "custom"
        if (
            wire.serial is not None
            and limits.UCLIENT_SERIAL_TRANSPORT_MTU is not None
            and limits.UCLIENT_CUSTOM_TRANSPORT_MTU is None
        ):
            return "serial"
        return "udp" if wire.udp is not None else "tcp" if wire.tcp is not None else "custom"

    @property
    def mtu_option(self) -> str | None:
        """The option with the MTU of the transport; None for CAN FD, whose MTU is fixed."""
        return None if self.middleware.transport.can_fd is not None else f"UCLIENT_{self.transport.upper()}_TRANSPORT_MTU"

    @property
    def mtu(self) -> int:
        """The MTU of the transport, in bytes."""
        option = self.mtu_option
        return _CAN_FD_MTU if option is None else self.value(option)

    @property
    def histories(self) -> tuple[int, int]:
        """The buffers of the input and of the output stream; those for one direction count only if both are given."""
        limits = self.middleware.limits
        if limits.RMW_UXRCE_STREAM_HISTORY_INPUT is not None and limits.RMW_UXRCE_STREAM_HISTORY_OUTPUT is not None:
            return limits.RMW_UXRCE_STREAM_HISTORY_INPUT, limits.RMW_UXRCE_STREAM_HISTORY_OUTPUT
        both = self.value("RMW_UXRCE_STREAM_HISTORY")
        return both, both

    @property
    def history_options(self) -> tuple[str, ...]:
        """The options that the lengths of both streams come from: one for both, or one each."""
        is_separate = self._is_given(_INPUT) and self._is_given(_OUTPUT)
        return (_INPUT, _OUTPUT) if is_separate else ("RMW_UXRCE_STREAM_HISTORY",)

    def value(self, name: str) -> int:
        """The value of an option that has a default or is stated."""
        row = rows()[name]
        if (stated := self.stated(row)) is not None:
            return stated
        other = self.defaults.get("MTU") if name == self.mtu_option else self.defaults.get(name)
        if other is None and self.port is not None:
            other = self.port.pools.get(name)
        return other if other is not None else row.default or 0

    def stated(self, row: OptionRow) -> int | None:
        """What the description says of an option, in other words, too."""
        middleware = self.middleware
        match row.name:
            case "RMW_UXRCE_TRANSPORT" if middleware.transport.model_fields_set:
                return row.words.index(self.transport)
            case "UCLIENT_PROFILE_MULTITHREAD" if middleware.multithread:
                return 1
            case "RMW_UXRCE_PUBLISH_RELIABLE_TIMEOUT" if middleware.reliable.timeout is not None:
                return row.stated(middleware.limits.model_copy(update={row.name: middleware.reliable.timeout}))
        stated = row.stated(middleware.limits)
        if stated is None and middleware.limits.RMW_UXRCE_MTU is not None and row.name == self.mtu_option:
            return middleware.limits.RMW_UXRCE_MTU // 8
        return stated

    def without_effect(self, name: str) -> str:
        """Why an option that is given has no effect; "" if it has."""
        if name == "RMW_UXRCE_XML_BUFFER_LENGTH":
            return "it is not read any more"
        if name.endswith("_TRANSPORT_MTU") and name != (option := self.mtu_option):
            return f"the MTU of this transport is {option}" if option is not None else f"the MTU of CAN FD is {_CAN_FD_MTU} B"
        for one, other in ((_INPUT, _OUTPUT), (_OUTPUT, _INPUT)):
            if name == one and not self._is_given(other):
                return f"it needs {other}, too"
        if name == "RMW_UXRCE_STREAM_HISTORY" and name not in self.history_options:
            return f"{_INPUT} and {_OUTPUT} replace it"
        if name == "RMW_UXRCE_REF_BUFFER_LENGTH" and self.middleware.limits.RMW_UXRCE_CREATION_MODE != "refs":
            return "RMW_UXRCE_CREATION_MODE is not 'refs'"
        return ""

    def _is_given(self, name: str) -> bool:
        return getattr(self.middleware.limits, name) is not None
