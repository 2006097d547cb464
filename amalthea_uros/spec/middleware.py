"""The generic micro-ROS model: executors, transport and limits of the middleware, as ported to a platform."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from amalthea_uros.spec.executors import ExecutorSection, MessageCost, with_shared_loops
from amalthea_uros.spec.fields import Limits, entry
from amalthea_uros.spec.section import DescriptionSection, Shorthand
from amalthea_uros.spec.transports import Agent, TransportSection
from amalthea_uros.spec.values import Count, CountOrNone, Duration, Name, OffsetOrNumberZero, Payload, Priority, Size, described


class ResponseTime(Shorthand):
    """Time from a request to the agent to its response: a time, or a mapping with minimum and maximum."""

    shorthand = (
        "min",
        "max",
    )
    plain_value = "The same response time for every request."

    min: Duration
    """Minimum time."""
    max: Duration
    """Maximum time."""


class RequestSizes(DescriptionSection):
    """Sizes of the longest requests to create entities, with the headers of the middleware: they depend on the lengths of names."""

    participant: Payload | None = None
    """For a node."""
    topic: Payload | None = None
    """For a topic."""
    publisher: Payload | None = None
    """For a publisher."""
    datawriter: Payload | None = None
    """For the data writer of a publisher."""
    subscriber: Payload | None = None
    """For the subscriber of a subscription."""
    datareader: Payload | None = None
    """For the data reader of a subscription."""
    replier: Payload | None = None
    """For a service."""
    requester: Payload | None = None
    """For a client."""


class InitialisationSection(DescriptionSection):
    """Creation of the entities, one after the other."""

    response_time: ResponseTime | None = None
    """Response time of the agent, from a request to its response as the client sees it; if omitted, only the minimum that the wire
    needs is known."""
    request_sizes: RequestSizes = entry(default_factory=RequestSizes.model_construct)
    """Sizes of the requests; default: unknown."""


_PORTS = described(
    arduino="The precompiled library for Arduino.",
    platformio="The library for PlatformIO.",
    espidf="The component for ESP-IDF.",
    zephyr="The module for Zephyr.",
    cubemx="The utilities for STM32CubeMX.",
    pico_sdk="The library for the Raspberry Pi Pico SDK.",
    renesas="The component for Renesas e2 studio.",
    nuttx="NuttX, built by micro_ros_setup.",
    freertos="FreeRTOS, built by micro_ros_setup.",
)
_TRANSPORTS = described(
    udp="UDP sockets.",
    tcp="TCP sockets.",
    serial="A serial device of a POSIX system.",
    custom="Functions of the application: what the ports to microcontrollers use.",
)
_CREATION_MODES = described(
    bin="Entities are described in binary form.",
    refs="Entities are described by references to profiles of the agent.",
    xml="Entities are described in XML: older releases.",
)


class PoolSizes(DescriptionSection):
    """Build options of the middleware, by their names: those of rmw_microxrcedds, of its XRCE-DDS client, and of zenoh-pico."""

    RMW_UXRCE_MAX_SESSIONS: Count | None = None
    """Sessions with an agent."""
    RMW_UXRCE_MAX_NODES: Count | None = None
    """Nodes."""
    RMW_UXRCE_MAX_TOPICS: Annotated[int, Limits(ge=-1)] | None = None
    """Topics, one per publisher and per subscription; -1: as many as `RMW_UXRCE_MAX_PUBLISHERS` and `RMW_UXRCE_MAX_SUBSCRIPTIONS`
    together."""
    RMW_UXRCE_MAX_PUBLISHERS: CountOrNone | None = None
    """Publishers."""
    RMW_UXRCE_MAX_SUBSCRIPTIONS: CountOrNone | None = None
    """Subscriptions."""
    RMW_UXRCE_MAX_SERVICES: CountOrNone | None = None
    """Service servers."""
    RMW_UXRCE_MAX_CLIENTS: CountOrNone | None = None
    """Service clients."""
    RMW_UXRCE_MAX_WAIT_SETS: CountOrNone | None = None
    """Wait sets: one per executor that has spun."""
    RMW_UXRCE_MAX_GUARD_CONDITION: CountOrNone | None = None
    """Guard conditions: one per timer, and those of the application."""
    RMW_UXRCE_MAX_HISTORY: Count | None = None
    """Slots for received messages that wait until they are taken, shared by all subscriptions, services and clients."""
    RMW_UXRCE_MTU: Size | None = None
    """Maximum size of a message of the transport: the `UCLIENT_..._TRANSPORT_MTU` of the transport that is used."""
    RMW_UXRCE_STREAM_HISTORY: Count | None = None
    """MTU-sized buffers of each reliable stream, a power of two."""
    RMW_UXRCE_STREAM_HISTORY_INPUT: Count | None = None
    """MTU-sized buffers of the reliable input stream, a power of two; only together with `RMW_UXRCE_STREAM_HISTORY_OUTPUT`."""
    RMW_UXRCE_STREAM_HISTORY_OUTPUT: Count | None = None
    """MTU-sized buffers of the reliable output stream, a power of two; only together with `RMW_UXRCE_STREAM_HISTORY_INPUT`."""
    RMW_UXRCE_PUBLISH_RELIABLE_TIMEOUT: Duration | None = None
    """Time after which publishing a reliable message times out."""
    RMW_UXRCE_ENTITY_CREATION_DESTROY_TIMEOUT: OffsetOrNumberZero | None = None
    """Time after which creating or destroying an entity times out; 0: it is not checked."""
    RMW_UXRCE_ENTITY_CREATION_TIMEOUT: OffsetOrNumberZero | None = None
    """The same, for creating only."""
    RMW_UXRCE_ENTITY_DESTROY_TIMEOUT: OffsetOrNumberZero | None = None
    """The same, for destroying only."""
    RMW_UXRCE_NODE_NAME_MAX_LENGTH: Count | None = None
    """Characters of the name of a node, with its terminator."""
    RMW_UXRCE_TOPIC_NAME_MAX_LENGTH: Count | None = None
    """Characters of the name of a topic or service, with the leading `/` and its terminator."""
    RMW_UXRCE_TYPE_NAME_MAX_LENGTH: Count | None = None
    """Characters of the name of a message type, with its terminator."""
    RMW_UXRCE_REF_BUFFER_LENGTH: Count | None = None
    """Characters of a reference to a profile of the agent, for `RMW_UXRCE_CREATION_MODE: refs`."""
    RMW_UXRCE_XML_BUFFER_LENGTH: Count | None = None
    """Not read any more."""
    RMW_UXRCE_TRANSPORT: Annotated[Literal["udp", "tcp", "serial", "custom"], _TRANSPORTS] | None = None
    """Transport that the middleware is built with; default: `udp` and `tcp` for these, else `custom`."""
    RMW_UXRCE_CREATION_MODE: Annotated[Literal["bin", "refs", "xml"], _CREATION_MODES] | None = None
    """How entities are described to the agent."""
    RMW_UXRCE_GRAPH: bool | None = None
    """Whether the graph of nodes and topics is available."""
    RMW_UXRCE_ALLOW_DYNAMIC_ALLOCATIONS: bool | None = None
    """Whether pools of entities grow on the heap when they are full; the slots for received messages never do."""
    RMW_UROS_ERROR_HANDLING: bool | None = None
    """Whether the middleware reports errors, such as dropped messages, to a callback of the application."""
    UCLIENT_UDP_TRANSPORT_MTU: Size | None = None
    """Maximum size of a message, for the transport `udp`."""
    UCLIENT_TCP_TRANSPORT_MTU: Size | None = None
    """Maximum size of a message, for the transport `tcp`."""
    UCLIENT_SERIAL_TRANSPORT_MTU: Size | None = None
    """Maximum size of a message, for the transport `serial`."""
    UCLIENT_CUSTOM_TRANSPORT_MTU: Size | None = None
    """Maximum size of a message, for the transport `custom`."""
    UCLIENT_MAX_SESSION_CONNECTION_ATTEMPTS: Count | None = None
    """Attempts to connect to the agent before the initialisation fails."""
    UCLIENT_MIN_SESSION_CONNECTION_INTERVAL: Duration | None = None
    """Time between two of these attempts."""
    UCLIENT_MIN_HEARTBEAT_TIME_INTERVAL: Duration | None = None
    """Time without input after which an unacknowledged message is announced again."""
    UCLIENT_HARD_LIVELINESS_CHECK: bool | None = None
    """Whether the agent drops a client that it does not hear from."""
    UCLIENT_HARD_LIVELINESS_CHECK_TIMEOUT: Duration | None = None
    """Time after which it does."""
    BATCH_UNICAST_SIZE: Size | None = None
    """zenoh-pico: buffer of a unicast link, for each direction."""
    BATCH_MULTICAST_SIZE: Size | None = None
    """zenoh-pico: buffer of a multicast link, for each direction."""
    FRAG_MAX_SIZE: Size | None = None
    """zenoh-pico: maximum size of a message that arrives in fragments."""
    Z_CONFIG_SOCKET_TIMEOUT: Duration | None = None
    """zenoh-pico: timeout of a socket."""
    Z_TRANSPORT_LEASE: Duration | None = None
    """zenoh-pico: time without a message after which a connection counts as lost."""
    Z_TRANSPORT_CONNECT_TIMEOUT: Duration | None = None
    """zenoh-pico: timeout of a connection attempt."""
    Z_TRANSPORT_ACCEPT_TIMEOUT: Duration | None = None
    """zenoh-pico: timeout of accepting a connection."""
    Z_RUNTIME_MAX_TASKS: Count | None = None
    """zenoh-pico: jobs of its background thread."""
    Z_MAX_KEYEXPR_LENGTH: Count | None = None
    """zenoh-pico: characters of a key expression."""
    Z_FEATURE_MULTI_THREAD: bool | None = None
    """zenoh-pico: whether it has threads of its own."""
    Z_FEATURE_BATCHING: bool | None = None
    """zenoh-pico: whether messages can be held back and sent together."""
    Z_FEATURE_FRAGMENTATION: bool | None = None
    """zenoh-pico: whether messages longer than a batch are sent in fragments."""


def option_units() -> dict[str, str]:
    """The unit of each build option: "B", "ms" or "number"; "switch" for a truth value, "word" for a choice."""
    from amalthea_uros.spec.section_schemas import whole_schema

    properties = whole_schema(PoolSizes)["properties"]
    return {key: _unit(properties[key]["anyOf"][0]) for key in PoolSizes.model_fields}


def _unit(schema: dict[str, Any]) -> str:
    if "enum" in schema:
        return "word"
    if "examples" in schema:
        return "B" if schema["examples"] == ["4 B"] else "ms"
    return "switch" if schema["type"] == "boolean" else "number"


_POLICIES = described(
    FixedPriorityPreemptive="The ready task with the highest priority executes.",
    OSEK="As `FixedPriorityPreemptive`, with the task types and the priority ceiling protocol of OSEK.",
)


class Reliable(DescriptionSection):
    """How reliable messages are sent."""

    waits: bool = True
    """Whether a publishing callback waits until the agent has acknowledged its message; `false` for ports that do not."""
    timeout: Duration | None = None
    """Time after which it times out; default: that of the middleware, `RMW_UXRCE_PUBLISH_RELIABLE_TIMEOUT` for XRCE-DDS."""


class MiddlewareTask(DescriptionSection):
    """A task or thread of the middleware, beside the executors."""

    name: Name
    """Name of the task: that of a thread of the profile, or of a task of this port that receives messages."""
    priority: Priority | None = None
    """Its priority; default: that of the profile, if it has one."""
    core: Name | None = None
    """Its core; default: that of the first executor."""
    execution_time: MessageCost | None = None
    """Execution time per message."""
    stack: Size | None = None
    """Its stack."""


class Middleware(DescriptionSection):
    """The generic micro-ROS model of a platform."""

    profile: Name = "xrce-dds"
    """The middleware: `xrce-dds`, `zenoh-pico`, or a file that describes another one."""
    ros: Literal["foxy", "galactic", "humble", "iron", "jazzy", "kilted", "rolling"] | None = None
    """Distribution of ROS 2 of its micro-ROS: a parameter server has five services up to humble, and six since;
    default: unknown, so that six are counted."""
    port: (
        Annotated[
            Literal["arduino", "platformio", "espidf", "zephyr", "cubemx", "pico-sdk", "renesas", "nuttx", "freertos"], _PORTS
        ]
        | None
    ) = None
    """How micro-ROS is brought to the controller: it decides the transport that the library is built for, default pools and how
    options are set; default: that of the platform. With another port than that of the platform, nothing that the platform says of its
    own port is used."""
    policy: Annotated[Literal["FixedPriorityPreemptive", "OSEK"], _POLICIES] = "FixedPriorityPreemptive"
    """Scheduling policy of the operating system."""
    task_periods: list[Duration] = entry(default_factory=list)
    """Available task periods; if omitted, any period is available."""
    executor: ExecutorSection = entry(default_factory=ExecutorSection.model_construct)
    """The executor, if there is only one."""
    executors: list[ExecutorSection] = entry(default_factory=list)
    """The executors, if there are several; the first one serves callbacks that name no other."""
    multithread: bool = False
    """Whether the middleware is built for several threads: then they share its session, one at a time."""
    publish: MessageCost = entry(default_factory=MessageCost.model_construct)
    """Execution time of publishing a message, added to that of the callback."""
    reliable: Reliable = entry(default_factory=Reliable.model_construct)
    """How reliable messages are sent."""
    tasks: list[MiddlewareTask] = entry(default_factory=list)
    """Tasks or threads of the middleware."""
    transport: TransportSection = entry(default_factory=TransportSection.model_construct)
    """The transport to the agent."""
    agent: Agent = entry(default_factory=Agent.model_construct)
    """The agent, or the router of the middleware."""
    initialisation: InitialisationSection = entry(default_factory=InitialisationSection.model_construct)
    """Creation of the entities."""
    limits: PoolSizes = entry(default_factory=PoolSizes.model_construct)
    """Static pools."""

    @property
    def stated_executors(self) -> tuple[ExecutorSection, ...]:
        """The executors; the first one serves callbacks that name no other."""
        return with_shared_loops(tuple(self.executors) or (self.executor,))

    @property
    def thread_count(self) -> int:
        """The threads or tasks in which executors spin: several ones can spin in one loop."""
        loops = [executor.loop for executor in self.stated_executors if executor.loop is not None]
        spins = (item.executor for loop in loops for item in loop.items or ())
        return len(self.stated_executors) - len({name for name in spins if name is not None})
