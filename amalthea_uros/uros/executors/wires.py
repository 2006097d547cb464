"""What the transport means for executors: whether there is a wire, and whether an interrupt receives its messages."""

from __future__ import annotations

from typing import TypeAlias

from amalthea_uros.spec.transports import Can, CanFd, CustomTransport, Interrupt, Network, Serial, Transport, UsbCdc

_Wire: TypeAlias = Can | CanFd | CustomTransport | Network | Serial | UsbCdc


def describes_wire(transport: Transport) -> bool:
    """Whether a description says what the messages are sent on."""
    return bool(_wires(transport))


def receive_interrupt(transport: Transport) -> Interrupt | None:
    """The interrupt that receives messages; None if none is described."""
    return next((wire.interrupt for wire in _wires(transport) if wire.interrupt is not None), None)


def _wires(transport: Transport) -> list[_Wire]:
    stated = (
        transport.can,
        transport.can_fd,
        transport.serial,
        transport.udp,
        transport.tcp,
        transport.usb_cdc,
        transport.custom,
    )
    return [wire for wire in stated if wire is not None]
