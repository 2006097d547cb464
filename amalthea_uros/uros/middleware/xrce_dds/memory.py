"""The static memory of rmw_microxrcedds and its client, from the sizes of its structures on 32-bit targets.

The structures are those of micro-ROS/rmw_microxrcedds src/types.h and eProsima/Micro-XRCE-DDS-Client include/uxr/client; the sizes of
entities are within 10 %. Besides, the middleware uses the heap while entities are created and destroyed, but not while it spins;
strings and sequences of messages are allocated by the application.
"""

from __future__ import annotations

from amalthea_uros.spec.application import Application
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.spec.profiles import ProfileData
from amalthea_uros.uros.middleware.profile import MemoryUse
from amalthea_uros.uros.middleware.xrce_dds.pools import histories_of, mtu_of, options

#: Bytes of a slot for a received message, besides its buffer.
_SLOT = 64
#: Bytes of an entity.
_ENTITIES = {
    "RMW_UXRCE_MAX_PUBLISHERS": 224,
    "RMW_UXRCE_MAX_SUBSCRIPTIONS": 224,
    "RMW_UXRCE_MAX_SERVICES": 208,
    "RMW_UXRCE_MAX_CLIENTS": 208,
    "RMW_UXRCE_MAX_NODES": 164,
    "RMW_UXRCE_MAX_TOPICS": 28,
    "RMW_UXRCE_MAX_GUARD_CONDITION": 32,
    "RMW_UXRCE_MAX_WAIT_SETS": 28,
}


def memory(application: Application, middleware: Middleware, data: ProfileData) -> tuple[MemoryUse, ...]:
    """The static memory with the options of a description."""
    values = {option.name: option.available for option in options(application, middleware, data)}
    sessions, slots = values["RMW_UXRCE_MAX_SESSIONS"], values["RMW_UXRCE_MAX_HISTORY"]
    mtu, (inputs, outputs) = mtu_of(middleware, data.options), histories_of(middleware, data.options)
    found = [
        MemoryUse(
            name="streams and receive buffer of the session",
            size=sessions * mtu * (inputs + outputs + 2),
            formula=f"{sessions} x {mtu} B x ({inputs} + {outputs} + 1 + 1)",
        ),
        MemoryUse(
            name="slots for received messages",
            size=slots * (mtu * inputs + _SLOT),
            formula=f"{slots} x ({mtu} B x {inputs} + {_SLOT} B)",
        ),
        MemoryUse(
            name="pools of entities",
            size=sum(size * values[name] for name, size in _ENTITIES.items()),
            formula=" + ".join(f"{values[name]} x {size} B" for name, size in _ENTITIES.items() if values[name]),
        ),
    ]
    if values["RMW_UXRCE_GRAPH"]:
        found.append(
            MemoryUse(
                name="graph of nodes and topics", size=sessions * mtu * inputs, formula=f"{sessions} x {mtu} B x {inputs}"
            )
        )
    return tuple(found)
