"""The network: wires between the controller and others, the messages on them, and the agent at the other end.

In `hardware`, a wire is a core whose clock is its bit rate, and in `software` each message on it is a task of that core, so that both
have response times and loads as others have. This model says what these cores and tasks are.
"""

from __future__ import annotations

from enum import StrEnum

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.perf.named import Brief, Named
from amalthea_uros.units import Time

#: Losses in a time at most, as in descriptions: each takes a place in the memory of a simulation.
MOST_LOST = 1000
#: Probabilities of losses are whole numbers of billionths.
BILLION = 10**9
#: The kind of events of messages for which no wire is described.
OFF_WIRE_EVENT = "message without a wire"


def plain_topic(topic: str | None) -> str:
    """A topic without the slash at its beginning; "" for none."""
    return (topic or "").removeprefix("/")


def request_topic(service: str) -> str:
    """The topic of the requests of a service: ROS 2 carries a service as two topics."""
    return f"{plain_topic(service)}/request"


def response_topic(service: str) -> str:
    """The topic of the responses of a service."""
    return f"{plain_topic(service)}/response"


class ActionPart(StrEnum):
    """The services and topics of which an action consists, as `ros2/rcl rcl_action/src/rcl_action/names.c` calls them."""

    GOALS = "send_goal"
    RESULTS = "get_result"
    CANCELLING = "cancel_goal"
    FEEDBACK = "feedback"

    def of(self, action: str) -> str:
        """The name of the service or topic of an action."""
        return f"{action}{_OF_ACTION}{self}"


#: Between the name of an action and that of one of its parts.
_OF_ACTION = "/_action/"


def conversation(service: str) -> str:
    """The name that requests and their responses share: the service, or the action of which it is a part."""
    name, mark, _ = plain_topic(service).partition(_OF_ACTION)
    return f"{name}{mark}"


class WireKind(StrEnum):
    """What a wire is."""

    CAN = "CAN"
    CAN_FD = "CAN FD"
    SERIAL = "serial"
    UDP = "UDP"
    TCP = "TCP"
    USB_CDC = "USB CDC"
    CUSTOM = "custom"


@dataclass(frozen=True, slots=True, kw_only=True)
class Span(Brief):
    """The least and the greatest of a time; None for a maximum that is not known.

    Attributes
    ----------
    mean : what is known instead of the maximum; no bound follows from it
    """

    least: Time = 0
    most: Time | None = None
    mean: Time | None = None

    @property
    def simulated(self) -> Span:
        """The time that a simulation takes: always the mean if that is all that is known."""
        return self if self.most is not None or self.mean is None else Span(least=self.mean, most=self.mean)


class Direction(StrEnum):
    """Where a message goes."""

    TO_CONTROLLER = "to the controller"
    TO_AGENT = "to the agent"


@dataclass(frozen=True, slots=True, kw_only=True)
class Losses(Brief):
    """How many messages are lost, as an assumption: a number in any time of some length, or each message with a probability.

    Attributes
    ----------
    directions : in which they are lost
    count : the most that are lost in any time of the length `window`, in all these directions together
    window : 0 for a probability
    per_billion : the probability that a message is lost, in billionths
    """

    directions: tuple[Direction, ...]
    count: int = 0
    window: Time = 0
    per_billion: int = 0


@dataclass(frozen=True, slots=True, kw_only=True)
class Recovery(Brief):
    """How reliable messages that were lost are found and sent again: who misses an acknowledgement asks for it.

    Attributes
    ----------
    asks_after : time without a received message after which a thread of the controller that waits for messages asks
    agent_asks_every : time between two times at which the agent asks
    sent_parts : most parts of messages that the controller keeps until they are acknowledged; None for no limit
    received_parts : how many parts the controller can receive ahead of one that is missing, itself included; None for no limit
    agent_sent_parts : most parts of messages that the agent sends before the first one is acknowledged; None for no limit
    """

    asks_after: Time
    agent_asks_every: Time
    sent_parts: int | None = None
    received_parts: int | None = None
    agent_sent_parts: int | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Wire(Named):
    """A wire.

    Attributes
    ----------
    cores : that stand for it: one per direction if both can send at the same time, else one
    loses_messages : whether messages can be lost on it
    losses : how many are; none of them if that is not known
    recovery : None if nothing is acknowledged, or who asks for missing acknowledgements is not known
    keeps_sender : whether a thread of the controller that sends waits until its message is on the wire
    client : of the middleware, at the end of the wire that is not the agent; "" in a system with one controller
    """

    kind: WireKind
    cores: tuple[str, ...]
    loses_messages: bool = False
    losses: tuple[Losses, ...] = ()
    recovery: Recovery | None = None
    keeps_sender: bool = False
    client: str = ""


class Purpose(StrEnum):
    """What a message on a wire is for."""

    DATA = "data"
    ACKNOWLEDGEMENT = "acknowledgement"
    HEARTBEAT = "heartbeat"
    FOREIGN = "foreign"


@dataclass(frozen=True, slots=True, kw_only=True)
class Transmission(Named):
    """A message on a wire; its name is that of the task that stands for it.

    Attributes
    ----------
    topic : a service has one for requests and one for responses; None for acknowledgements, heartbeats and foreign frames
    callback : that receives or sends it
    acknowledges : the transmission that it acknowledges; None for others
    length : in bytes, of the message of the middleware with its headers
    link : time besides that on the core of the wire: in switches, access points, and until a host polls
    driver : time in the driver of the controller after its receipt that is not execution time, such as waiting for ticks; while it is
        sent, the driver keeps the wire busy, so that this time is part of that on the wire
    processes : that a message passes before the executor sees it: interrupt service routines, then tasks of the middleware
    agent : time in the agent: from the host to the wire, from the wire to the host, or from a message to its acknowledgement
    waits : whether what sends it waits for its acknowledgement
    is_dropped_when_busy : whether the middleware drops it, instead of waiting, while another thread is sending
    """

    wire: str
    direction: Direction
    purpose: Purpose = Purpose.DATA
    topic: str | None = None
    callback: str | None = None
    acknowledges: str | None = None
    length: int = 0
    link: Span = field(default_factory=lambda: Span(most=0))
    driver: Span = field(default_factory=lambda: Span(most=0))
    processes: tuple[str, ...] = ()
    agent: Span = field(default_factory=Span)
    waits: bool = False
    is_dropped_when_busy: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class Wait(Brief):
    """A runnable outside executors in loops waits for the acknowledgement of a message that is on no wire of the system.

    Attributes
    ----------
    timeout : after which it no longer waits; None if there is none
    """

    runnable: str
    topic: str
    timeout: Time | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Network(Brief):
    """The network of a system.

    Attributes
    ----------
    agent : name of the agent at the other end of the wires
    waits : for messages that are on none of the wires
    assumptions : on which the times of wires and agent are based, in sentences
    """

    wires: tuple[Wire, ...] = ()
    transmissions: tuple[Transmission, ...] = ()
    agent: str = "Agent"
    waits: tuple[Wait, ...] = ()
    assumptions: tuple[str, ...] = ()

    @property
    def wire_cores(self) -> frozenset[str]:
        """The cores that stand for the directions of wires."""
        return frozenset(core for wire in self.wires for core in wire.cores)
