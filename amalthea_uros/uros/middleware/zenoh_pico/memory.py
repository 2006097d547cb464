"""The buffers of zenoh-pico; entities, received messages and fragments are on the heap, without a limit."""

from __future__ import annotations

from collections.abc import Mapping

from amalthea_uros.spec.application import Application
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.uros.middleware.profile import MemoryUse
from amalthea_uros.uros.middleware.zenoh_pico.pools import options

#: Of a serial link, in bytes (eclipse-zenoh/zenoh-pico include/zenoh-pico/system/link/serial.h).
_SERIAL_MTU = 1500
#: rmw_zenoh_pico/src of esol-community/rmw_zenoh_pico: the depth of a history is not enforced.
_HEAP = "not known: entities, fragments, and messages that wait, in any number"


def memory(application: Application, middleware: Middleware, defaults: Mapping[str, int]) -> tuple[MemoryUse, ...]:
    """The buffers for sending, a batch but no longer than the link allows, and for receiving (src/transport/unicast/transport.c)."""
    batch = next(each.available for each in options(application, middleware, defaults) if each.name == "BATCH_UNICAST_SIZE")
    is_serial = middleware.transport.serial is not None or middleware.transport.usb_cdc is not None
    sent = min(batch, _SERIAL_MTU) if is_serial else batch
    return (
        MemoryUse(name="buffer for sending", size=sent, formula=f"{sent} B"),
        MemoryUse(name="buffer for receiving", size=batch, formula=f"{batch} B"),
        MemoryUse(name="heap", size=0, formula=_HEAP, is_bounded=False),
    )
