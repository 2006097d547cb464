"""The build options of rmw_microxrcedds and its client, with what an application needs of each."""

from __future__ import annotations

from collections.abc import Mapping

from amalthea_uros.spec.application import Application, Node
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.spec.profiles import ProfileData
from amalthea_uros.uros.memory.entities import Entities, entities_of, executors_of
from amalthea_uros.uros.middleware.options import OptionRow, option_rows
from amalthea_uros.uros.middleware.profile import Option
from amalthea_uros.uros.middleware.xrce_dds.contents import contents_of, fragments, least_mtu

#: The CAN FD transport has no option for it (eProsima/Micro-XRCE-DDS-Client src/c/profile/transport/can/can_transport.c).
CAN_FD_MTU = 63
_MTU = "UCLIENT_{}_TRANSPORT_MTU"
_INPUT, _OUTPUT = "RMW_UXRCE_STREAM_HISTORY_INPUT", "RMW_UXRCE_STREAM_HISTORY_OUTPUT"


def rows() -> Mapping[str, OptionRow]:
    """The table of options."""
    return option_rows(__name__.rpartition(".")[0])


def transport_of(middleware: Middleware) -> str:
    """The transport that the middleware is built with; microcontrollers have a custom one for serial lines, too."""
    wire, limits = middleware.transport, middleware.limits
    if limits.RMW_UXRCE_TRANSPORT is not None:
        return limits.RMW_UXRCE_TRANSPORT
    if (
        wire.serial is not None
        and limits.UCLIENT_SERIAL_TRANSPORT_MTU is not None
        and limits.UCLIENT_CUSTOM_TRANSPORT_MTU is None
    ):
        return "serial"
    return "udp" if wire.udp is not None else "tcp" if wire.tcp is not None else "custom"


def mtu_option(middleware: Middleware) -> str | None:
    """The option with the MTU of the transport; None for CAN FD, whose MTU is fixed."""
    return None if middleware.transport.can_fd is not None else _MTU.format(transport_of(middleware).upper())


def mtu_of(middleware: Middleware, defaults: Mapping[str, int]) -> int:
    """The MTU of the transport, in bytes."""
    option = mtu_option(middleware)
    return CAN_FD_MTU if option is None else _value(option, middleware, defaults)


def histories_of(middleware: Middleware, defaults: Mapping[str, int]) -> tuple[int, int]:
    """The buffers of the input and of the output stream; those for one direction count only if both are given."""
    limits = middleware.limits
    if limits.RMW_UXRCE_STREAM_HISTORY_INPUT is not None and limits.RMW_UXRCE_STREAM_HISTORY_OUTPUT is not None:
        return limits.RMW_UXRCE_STREAM_HISTORY_INPUT, limits.RMW_UXRCE_STREAM_HISTORY_OUTPUT
    both = _value("RMW_UXRCE_STREAM_HISTORY", middleware, defaults)
    return both, both


def options(application: Application, middleware: Middleware, data: ProfileData) -> tuple[Option, ...]:
    """The build options; those that count only where they are given are left out where they are not."""
    needed, defaults = _needs(application, middleware, data), data.options
    found = []
    for name, row in rows().items():
        stated = _stated(row, middleware)
        if stated is None and row.default is None:
            continue
        available = _value(name, middleware, defaults)
        if name == "RMW_UXRCE_MAX_TOPICS" and available < 0:
            available = sum(_value(f"RMW_UXRCE_MAX_{kind}", middleware, defaults) for kind in ("PUBLISHERS", "SUBSCRIPTIONS"))
        without_effect = _without_effect(name, middleware) if stated is not None else ""
        found.append(
            row.option(
                needed=needed.get(name), available=available, is_stated=stated is not None, without_effect=without_effect
            )
        )
    return tuple(found)


def _stated(row: OptionRow, middleware: Middleware) -> int | None:
    """What the description says of an option, in other words, too."""
    match row.name:
        case "RMW_UXRCE_TRANSPORT" if middleware.transport.model_fields_set:
            return row.words.index(transport_of(middleware))
        case "UCLIENT_PROFILE_MULTITHREAD" if middleware.multithread:
            return 1
        case "RMW_UXRCE_PUBLISH_RELIABLE_TIMEOUT" if middleware.reliable.timeout is not None:
            return row.stated(middleware.limits.model_copy(update={row.name: middleware.reliable.timeout}))
    stated = row.stated(middleware.limits)
    if stated is None and row.name == mtu_option(middleware) and middleware.limits.RMW_UXRCE_MTU is not None:
        return middleware.limits.RMW_UXRCE_MTU // 8
    return stated


def _value(name: str, middleware: Middleware, defaults: Mapping[str, int]) -> int:
    """The value of an option that has a default or is stated."""
    row = rows()[name]
    if (stated := _stated(row, middleware)) is not None:
        return stated
    other = defaults.get("MTU") if name == mtu_option(middleware) else defaults.get(name)
    return other if other is not None else row.default or 0


def _needs(application: Application, middleware: Middleware, data: ProfileData) -> dict[str, int]:
    """What the application needs of each option that depends on it."""
    entities, contents = entities_of(application, middleware), contents_of(application)
    needed = {
        "RMW_UXRCE_MAX_SESSIONS": 1 if entities.nodes else 0,
        "RMW_UXRCE_MAX_NODES": entities.nodes,
        "RMW_UXRCE_MAX_TOPICS": entities.topics,
        "RMW_UXRCE_MAX_PUBLISHERS": entities.publishers,
        "RMW_UXRCE_MAX_SUBSCRIPTIONS": entities.subscriptions,
        "RMW_UXRCE_MAX_SERVICES": entities.services,
        "RMW_UXRCE_MAX_CLIENTS": entities.clients,
        "RMW_UXRCE_MAX_WAIT_SETS": entities.executors,
        "RMW_UXRCE_MAX_GUARD_CONDITION": entities.guard_conditions,
        "RMW_UXRCE_MAX_HISTORY": _waiting_messages(application, entities, middleware),
        "RMW_UXRCE_NODE_NAME_MAX_LENGTH": max((len(node.name) + 1 for node in application.nodes), default=0),
        "RMW_UXRCE_TOPIC_NAME_MAX_LENGTH": max(map(_name_length, _names(application)), default=0),
    }
    if (option := mtu_option(middleware)) is not None:
        needed[option] = least_mtu(contents, middleware, data)
    buffers = [(each, fragments(each, mtu_of(middleware, data.options), middleware, data) or 0) for each in contents]
    incoming = max((count for each, count in buffers if each.reliable and each.incoming), default=0)
    outgoing = max((count for each, count in buffers if each.reliable and not each.incoming), default=0)
    if middleware.reliable.waits and not middleware.multithread:
        # Longer ones are sent buffer by buffer, with a wait after each (eProsima/Micro-XRCE-DDS-Client src/c/core/session/session.c),
        # in builds for one thread.
        outgoing = min(outgoing, 1)
    both = middleware.limits.RMW_UXRCE_STREAM_HISTORY_INPUT is not None and _is_given(_OUTPUT, middleware)
    return needed | ({_INPUT: incoming, _OUTPUT: outgoing} if both else {"RMW_UXRCE_STREAM_HISTORY": max(incoming, outgoing)})


def _waiting_messages(application: Application, entities: Entities, middleware: Middleware) -> int:
    """How many received messages can wait at the same time at least: if each is taken before the next one of its entity arrives.

    Whether it is depends on response times, so more of them can wait.

    An executor that waits for one message at a time takes it in the same round, so it needs one slot. While a reliable publication
    waits for its acknowledgement, while a trigger condition is false, until the next period, and with several executors on one session,
    messages of all entities can wait (micro-ROS/rmw_microxrcedds src/rmw_wait.c, src/callbacks.c).
    """
    executors = executors_of(middleware)
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
    return min(entities.receivers, 1) if takes_each else entities.receivers


def _sends_reliably(node: Node) -> bool:
    """Whether a node waits for acknowledgements; requests and responses are always reliable."""
    services = (node.services, node.clients, node.action_servers, node.action_clients)
    more = node.parameter_server is not None or node.lifecycle is not None
    return more or any(services) or any(publisher.reliability == "reliable" for publisher in node.publishers)


def _names(application: Application) -> list[str]:
    """The names of topics and services; an action has several with the suffixes of ros2/rcl rcl_action/src/rcl_action/names.c."""
    found: list[str] = []
    for node in application.nodes:
        found += [subscription.topic for subscription in node.subscriptions]
        found += [publisher.topic for publisher in node.publishers]
        found += [service.name for service in node.services]
        found += [client.service for client in node.clients]
        actions = [*(server.name for server in node.action_servers), *(client.action for client in node.action_clients)]
        found += [f"{name}/_action/cancel_goal" for name in actions]
        if node.parameter_server is not None:
            found.append(f"{node.name}/set_parameters_atomically")
        if node.lifecycle is not None:
            found.append(f"{node.name}/get_available_transitions")
    return found


def _name_length(name: str) -> int:
    """With the slash that expands a relative name, and the terminator."""
    return len(name.encode()) + (not name.startswith("/")) + 1


def _is_given(name: str, middleware: Middleware) -> bool:
    return getattr(middleware.limits, name) is not None


def _without_effect(name: str, middleware: Middleware) -> str:
    """Why an option that is given has no effect; "" if it has."""
    if name == "RMW_UXRCE_XML_BUFFER_LENGTH":
        return "it is not read any more"
    if name.endswith("_TRANSPORT_MTU") and name != (option := mtu_option(middleware)):
        return f"the MTU of this transport is {option}" if option is not None else f"the MTU of CAN FD is {CAN_FD_MTU} B"
    for one, other in ((_INPUT, _OUTPUT), (_OUTPUT, _INPUT)):
        if name == one and not _is_given(other, middleware):
            return f"it needs {other}, too"
    if name == "RMW_UXRCE_STREAM_HISTORY" and _is_given(_INPUT, middleware) and _is_given(_OUTPUT, middleware):
        return f"{_INPUT} and {_OUTPUT} replace it"
    if name == "RMW_UXRCE_REF_BUFFER_LENGTH" and middleware.limits.RMW_UXRCE_CREATION_MODE != "refs":
        return "RMW_UXRCE_CREATION_MODE is not 'refs'"
    return ""
