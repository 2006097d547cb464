"""The profile of Micro XRCE-DDS.

A reliable message keeps its sender until the agent has acknowledged all of it, as in rmw_publish.c, rmw_request.c and rmw_response.c of
micro-ROS/rmw_microxrcedds: `uxr_run_session_until_confirm_delivery` follows each message, so that there is never more than one message
that is not acknowledged.

The static memory consists of the structures in src/types.h of rmw_microxrcedds and in include/uxr/client of the client, on 32-bit
targets; the sizes of entities are within 10 %. Besides, the middleware uses the heap while entities are created and destroyed, but not
while it spins; strings and sequences of messages are allocated by the application.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from amalthea_uros.spec.application import Application
from amalthea_uros.units import MILLISECOND, Time
from amalthea_uros.uros.middleware.options import Option, OptionRow
from amalthea_uros.uros.middleware.profile import Heartbeat, MemoryUse, MessageKind, Part, Profile, Sending
from amalthea_uros.uros.middleware.xrce_dds import pools
from amalthea_uros.uros.middleware.xrce_dds.build import Build, rows
from amalthea_uros.uros.middleware.xrce_dds.messages import MessageLayout

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


@dataclass(frozen=True, slots=True)
class XrceDds(Profile):
    """Micro XRCE-DDS, or a middleware of the kind with other figures."""

    @property
    def build(self) -> Build:
        """The values of its build options."""
        return Build(self.middleware, self.data.options)

    @property
    def layout(self) -> MessageLayout:
        """The lengths of its messages."""
        return MessageLayout(self, self.build)

    @property
    def slots(self) -> int:
        """The number of messages that can be stored for all handles together."""
        return self.build.value("RMW_UXRCE_MAX_HISTORY")

    @property
    def sending(self) -> Sending:
        """How messages are sent."""
        how, stated = self.data.sending, self.middleware.reliable.timeout
        return Sending(
            waits=how.waits and self.middleware.reliable.waits,
            timeout=self._time("RMW_UXRCE_PUBLISH_RELIABLE_TIMEOUT") if stated is None else stated,
            resends_after=self._heartbeat_interval,
            holds_session_while_waiting=how.holds_session_while_waiting and self.middleware.multithread,
            drops_when_busy=how.drops_when_busy,
            is_protected=how.is_protected or self.middleware.multithread,
        )

    @property
    def heartbeat(self) -> Heartbeat:
        """Heartbeats, which follow each other while something is not acknowledged."""
        client = self._heartbeat_interval
        return Heartbeat(self.size("heartbeat"), min(client, self.data.sending.heartbeat or client), is_answered=True)

    @property
    def _heartbeat_interval(self) -> Time:
        """Time without input after which the client asks for an acknowledgement."""
        return self._time("UCLIENT_MIN_HEARTBEAT_TIME_INTERVAL")

    @property
    def buffers(self) -> int:
        """The number of buffers of the reliable stream to the agent."""
        return self.build.histories[1]

    @property
    def option_table(self) -> Mapping[str, OptionRow]:
        """What is known of its build options."""
        return rows()

    def parts(self, kind: MessageKind, content: int, *, reliable: bool) -> Sequence[Part]:
        """What is sent for a message."""
        return self.layout.parts(kind, content, reliable=reliable)

    def times_out_after(self, kind: MessageKind, content: int, *, reliable: bool) -> Time | None:
        """Time after which the sender of a message stops waiting; None if it does not wait.

        A message of more fragments than there are buffers is sent in several steps, each of which waits until the buffers are empty.
        """
        how = self.sending
        if not (reliable and how.waits):
            return None
        flushes = -(-len(self.parts(kind, content, reliable=True)) // self.buffers) - 1
        return how.timeout + flushes * (self.data.sending.flush_timeout or how.timeout)

    def largest_content(self, kind: MessageKind, *, reliable: bool) -> int:
        """The longest content that can be sent or received."""
        return self.layout.largest_content(kind, reliable=reliable, waits=self.sending.waits)

    def limiting_options(self, *, reliable: bool) -> Sequence[str]:
        """The build options that limit the content of messages."""
        option = self.build.mtu_option
        options = () if option is None else (option,)
        return (*options, "RMW_UXRCE_STREAM_HISTORY") if reliable else options

    def options(self, application: Application) -> Sequence[Option]:
        """Its build options."""
        return tuple(pools.options(application, self.layout))

    def memory(self, application: Application) -> Sequence[MemoryUse]:
        """Its static memory with the options of the description."""
        values = {option.name: option.available for option in self.options(application)}
        sessions, slots = values["RMW_UXRCE_MAX_SESSIONS"], values["RMW_UXRCE_MAX_HISTORY"]
        mtu, (inputs, outputs) = self.build.mtu, self.build.histories
        session = MemoryUse(
            name="streams and receive buffer of the session",
            size=sessions * mtu * (inputs + outputs + 2),
            formula=f"{sessions} x {mtu} B x ({inputs} + {outputs} + 1 + 1)",
        )
        messages = MemoryUse(
            name="slots for received messages",
            size=slots * (mtu * inputs + _SLOT),
            formula=f"{slots} x ({mtu} B x {inputs} + {_SLOT} B)",
        )
        entities = MemoryUse(
            name="pools of entities",
            size=sum(size * values[name] for name, size in _ENTITIES.items()),
            formula=" + ".join(f"{values[name]} x {size} B" for name, size in _ENTITIES.items() if values[name]),
        )
        graph = MemoryUse(
            name="graph of nodes and topics", size=sessions * mtu * inputs, formula=f"{sessions} x {mtu} B x {inputs}"
        )
        return (session, messages, entities, *([graph] if values["RMW_UXRCE_GRAPH"] else []))

    def _time(self, option: str) -> Time:
        return self.build.value(option) * MILLISECOND
