"""The profile of Micro XRCE-DDS.

A reliable message keeps its sender until the agent has acknowledged all of it, as in rmw_publish.c, rmw_request.c and rmw_response.c of
micro-ROS/rmw_microxrcedds: `uxr_run_session_until_confirm_delivery` follows each message, so that there is never more than one message
that is not acknowledged.

The static memory consists of the structures in src/types.h of rmw_microxrcedds and in include/uxr/client of the client, on 32-bit
targets, compiled for ARM. Besides, the middleware uses the heap while entities are created and destroyed, but not
while it spins; strings and sequences of messages are allocated by the application.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence

from amalthea_uros._internal.records import dataclass
from amalthea_uros.perf.executors import HandleKind
from amalthea_uros.perf.network import ActionPart, Direction, Recovery
from amalthea_uros.spec.application import Application, NodeSection
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.units import MILLISECOND, Time
from amalthea_uros.uros.application.callbacks import sections_of
from amalthea_uros.uros.application.created_entities import SESSION, CreatedEntity, created_entities
from amalthea_uros.uros.application.messages import MessageKind
from amalthea_uros.uros.middleware.options import Option, OptionRow
from amalthea_uros.uros.middleware.profile import CreationFigures, Heartbeat, MemoryUse, Sending
from amalthea_uros.uros.middleware.xrce_dds.build import XrceBuild, rows
from amalthea_uros.uros.middleware.xrce_dds.messages import MessageLayout, contents_of

#: Bytes of a session, besides its buffers.
_SESSION = 432
#: Bytes of a slot for a received message, besides its buffer.
_SLOT = 64
#: Reliable messages that the agent sends before the first one is acknowledged: its reliable stream in eProsima/Micro-XRCE-DDS-Agent.
_AGENT_WINDOW = 16
#: Bytes of an entity.
_ENTITIES = {
    "RMW_UXRCE_MAX_PUBLISHERS": 216,
    "RMW_UXRCE_MAX_SUBSCRIPTIONS": 216,
    "RMW_UXRCE_MAX_SERVICES": 200,
    "RMW_UXRCE_MAX_CLIENTS": 200,
    "RMW_UXRCE_MAX_NODES": 164,
    "RMW_UXRCE_MAX_TOPICS": 28,
    "RMW_UXRCE_MAX_GUARD_CONDITION": 32,
    "RMW_UXRCE_MAX_WAIT_SETS": 28,
}
#: The option for the pool of each kind of entity; a publisher and a subscription have a topic each, also for the same name.
_CREATED = {
    "RMW_UXRCE_MAX_SESSIONS": SESSION,
    "RMW_UXRCE_MAX_NODES": "participant",
    "RMW_UXRCE_MAX_TOPICS": "topic",
    "RMW_UXRCE_MAX_PUBLISHERS": "publisher",
    "RMW_UXRCE_MAX_SUBSCRIPTIONS": "subscriber",
    "RMW_UXRCE_MAX_SERVICES": "replier",
    "RMW_UXRCE_MAX_CLIENTS": "requester",
}
#: Each timer has one (ros2/rcl rcl/src/rcl/timer.c), that of an action server included.
_WITH_GUARD_CONDITION = (HandleKind.TIMER, HandleKind.GUARD_CONDITION, HandleKind.ACTION_SERVER)


@dataclass(frozen=True, slots=True)
class XrceDds(MessageLayout):
    """Micro XRCE-DDS, or a middleware of the kind with other figures."""

    @property
    def slots(self) -> int:
        """The number of messages that can be stored for all handles together."""
        return self.build.value("RMW_UXRCE_MAX_HISTORY")

    @property
    def slot_size(self) -> int:
        """A slot has the size of the longest message, whatever message it holds."""
        return self.build.mtu * self.build.histories[0] + _SLOT

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

    def heartbeat(self, direction: Direction) -> Heartbeat:
        """Heartbeats, which follow each other while something is not acknowledged."""
        client, agent = self._heartbeat_interval, self.data.sending.heartbeat
        interval = client if direction is Direction.TO_AGENT or agent is None else agent
        return Heartbeat(self.size("heartbeat"), interval, is_answered=True)

    @property
    def recovery(self) -> Recovery:
        """Heartbeats: of the client after a silence, and of the agent at intervals."""
        client, (inputs, outputs) = self._heartbeat_interval, self.build.histories
        return Recovery(
            asks_after=client,
            agent_asks_every=self.data.sending.heartbeat or client,
            sent_parts=outputs,
            received_parts=inputs,
            agent_sent_parts=_AGENT_WINDOW,
        )

    @property
    def _heartbeat_interval(self) -> Time:
        """Time without input after which the client asks for an acknowledgement."""
        return self._time("UCLIENT_MIN_HEARTBEAT_TIME_INTERVAL")

    @property
    def creation(self) -> CreationFigures:
        """Requests with their responses, each with a time limit (micro-ROS/rmw_microxrcedds src/rmw_init.c, src/utils.c)."""
        stated = self.build.stated(self.option_table["RMW_UXRCE_ENTITY_CREATION_TIMEOUT"])
        limit = self._time("RMW_UXRCE_ENTITY_CREATION_DESTROY_TIMEOUT") if stated is None else stated * MILLISECOND
        attempts, interval = "UCLIENT_MAX_SESSION_CONNECTION_ATTEMPTS", "UCLIENT_MIN_SESSION_CONNECTION_INTERVAL"
        return CreationFigures(
            session_request=self.size("create_client"),
            session_response=self.size("status_agent"),
            least_request=self.size("create"),
            status=self.size("status"),
            data_request=self.size("read_data"),
            acknowledgement=self.size("acknowledgement") if limit else None,
            session_limit=self.build.value(attempts) * self._time(interval),
            entity_limit=limit,
        )

    @property
    def buffers(self) -> int:
        """The number of buffers of the reliable stream to the agent."""
        return self.build.histories[1]

    @property
    def option_table(self) -> Mapping[str, OptionRow]:
        """What is known of its build options."""
        return rows()

    def times_out_after(self, kind: MessageKind, content: int, *, reliable: bool) -> Time | None:
        """Time after which the sender of a message stops waiting; None if it does not wait.

        A message of more fragments than there are buffers is sent in several steps, each of which waits until the buffers are empty.
        """
        how = self.sending
        if not (reliable and how.waits):
            return None
        flushes = -(-len(self.parts(kind, content, reliable=True)) // self.buffers) - 1
        return how.timeout + flushes * (self.data.sending.flush_timeout or how.timeout)

    def limiting_options(self, *, reliable: bool) -> Sequence[str]:
        """The build options that limit the content of messages."""
        option = self.build.mtu_option
        options = () if option is None else (option,)
        return (*options, "RMW_UXRCE_STREAM_HISTORY") if reliable else options

    def options(self, application: Application) -> Sequence[Option]:
        """Its build options."""
        return tuple(_options(application, self))

    def memory(self, application: Application) -> Sequence[MemoryUse]:
        """Its static memory with the options of the description."""
        values = _available(self.build)
        sessions, slots = values["RMW_UXRCE_MAX_SESSIONS"], values["RMW_UXRCE_MAX_HISTORY"]
        mtu, (inputs, outputs) = self.build.mtu, self.build.histories
        session = MemoryUse(
            name="streams and receive buffer of the session",
            size=sessions * (mtu * (inputs + outputs + 2) + _SESSION),
            formula=f"{sessions} x ({mtu} B x ({inputs} + {outputs} + 1 + 1) + {_SESSION} B)",
        )
        messages = MemoryUse(
            name="slots for received messages",
            size=slots * self.slot_size,
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


def _options(application: Application, layout: MessageLayout) -> Iterator[Option]:
    """The build options; those that count only where they are given are left out where they are not."""
    needed, build, table = _needs(application, layout), layout.build, rows()
    for name, available in _available(build).items():
        is_stated = build.stated(table[name]) is not None
        without_effect = build.without_effect(name) if is_stated else ""
        yield Option.of(
            table[name], needed=needed.get(name), available=available, is_stated=is_stated, without_effect=without_effect
        )


def _available(build: XrceBuild) -> dict[str, int]:
    """The values of the build options, without those that count only where they are given and are not."""
    values = {
        name: build.value(name) for name, row in rows().items() if row.default is not None or build.stated(row) is not None
    }
    if values["RMW_UXRCE_MAX_TOPICS"] < 0:
        values["RMW_UXRCE_MAX_TOPICS"] = values["RMW_UXRCE_MAX_PUBLISHERS"] + values["RMW_UXRCE_MAX_SUBSCRIPTIONS"]
    return values


def _needs(application: Application, layout: MessageLayout) -> dict[str, int]:
    """What the application needs of each option that depends on it."""
    middleware, contents = layout.build.middleware, contents_of(application)
    entities = created_entities(application, middleware)
    kinds = [kind for node in application.nodes for kind, _ in sections_of(node)]
    counts = Counter(entity.kind for entity in entities)
    needed = {option: counts[kind] for option, kind in _CREATED.items()} | {
        "RMW_UXRCE_MAX_WAIT_SETS": len(middleware.stated_executors) if kinds else 0,
        "RMW_UXRCE_MAX_GUARD_CONDITION": sum(kind in _WITH_GUARD_CONDITION for kind in kinds),
        "RMW_UXRCE_MAX_HISTORY": _waiting_messages(application, entities, middleware),
        "RMW_UXRCE_NODE_NAME_MAX_LENGTH": max((len(node.name) + 1 for node in application.nodes), default=0),
        "RMW_UXRCE_TOPIC_NAME_MAX_LENGTH": max(map(_name_length, _names(application)), default=0),
    }
    if (option := layout.build.mtu_option) is not None:
        needed[option] = layout.least_mtu(contents)
    buffers = [(each, layout.fragments(each) or 0) for each in contents if each.reliable]
    incoming = max((count for each, count in buffers if each.incoming), default=0)
    outgoing = max((count for each, count in buffers if not each.incoming), default=0)
    if middleware.reliable.waits and not middleware.multithread:
        # Longer ones are sent buffer by buffer, with a wait after each (eProsima/Micro-XRCE-DDS-Client src/c/core/session/session.c),
        # in builds for one thread.
        outgoing = min(outgoing, 1)
    names = layout.build.history_options
    return needed | (
        dict(zip(names, (incoming, outgoing), strict=True)) if len(names) > 1 else {names[0]: max(incoming, outgoing)}
    )


def _waiting_messages(application: Application, entities: Sequence[CreatedEntity], middleware: Middleware) -> int:
    """How many received messages can wait at the same time at least: if each is taken before the next one of its entity arrives.

    Whether it is depends on response times, so more of them can wait.

    An executor that waits for one message at a time takes it in the same round, so it needs one slot. While a reliable publication
    waits for its acknowledgement, while a trigger condition is false, until the next period, and with several executors on one session,
    messages of all entities can wait (micro-ROS/rmw_microxrcedds src/rmw_wait.c, src/callbacks.c).
    """
    executors = middleware.stated_executors
    trigger = executors[0].trigger
    takes_each = (
        len(executors) == 1
        and executors[0].loop is not None
        and trigger.when != "all"
        and trigger.one is None
        and trigger.custom is None
        and not middleware.multithread
        and not (middleware.reliable.waits and any(map(_sends_reliably, application.nodes)))
    )
    receivers = sum(entity.asks_for_data for entity in entities)
    return min(receivers, 1) if takes_each else receivers


def _sends_reliably(node: NodeSection) -> bool:
    """Whether a node waits for acknowledgements; requests and responses are always reliable."""
    services = (node.services, node.clients, node.action_servers, node.action_clients)
    more = node.parameter_server is not None or node.lifecycle is not None
    return more or any(services) or any(publisher.reliability == "reliable" for publisher in node.publishers)


def _names(application: Application) -> list[str]:
    """The names of topics and services, of those of an action the longest."""
    found: list[str] = []
    for node in application.nodes:
        found += [subscription.topic for subscription in node.subscriptions]
        found += [publisher.topic for publisher in node.publishers]
        found += [service.name for service in node.services]
        found += [client.service for client in node.clients]
        actions = [*(server.name for server in node.action_servers), *(client.action for client in node.action_clients)]
        found += map(ActionPart.CANCELLING.of, actions)
        if node.parameter_server is not None:
            found.append(f"{node.name}/set_parameters_atomically")
        if node.lifecycle is not None:
            found.append(f"{node.name}/get_available_transitions")
    return found


def _name_length(name: str) -> int:
    """With the slash that expands a relative name, and the terminator."""
    return len(name.encode()) + (not name.startswith("/")) + 1
