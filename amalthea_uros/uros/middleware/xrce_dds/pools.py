"""The build options of rmw_microxrcedds and its client, with what an application needs of each."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.spec.application import Application, NodeSection
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.uros.application.entities import Entities, entities_of, executors_of
from amalthea_uros.uros.middleware.options import Option
from amalthea_uros.uros.middleware.xrce_dds.build import rows
from amalthea_uros.uros.middleware.xrce_dds.messages import MessageLayout, contents_of


def options(application: Application, layout: MessageLayout) -> Iterator[Option]:
    """The build options; those that count only where they are given are left out where they are not."""
    needed, build = _needs(application, layout), layout.build
    for name, row in rows().items():
        stated = build.stated(row)
        if stated is None and row.default is None:
            continue
        available = build.value(name)
        if name == "RMW_UXRCE_MAX_TOPICS" and available < 0:
            available = sum(build.value(f"RMW_UXRCE_MAX_{kind}") for kind in ("PUBLISHERS", "SUBSCRIPTIONS"))
        without_effect = build.without_effect(name) if stated is not None else ""
        yield Option.of(
            row, needed=needed.get(name), available=available, is_stated=stated is not None, without_effect=without_effect
        )


def _needs(application: Application, layout: MessageLayout) -> dict[str, int]:
    """What the application needs of each option that depends on it."""
    middleware, contents = layout.build.middleware, contents_of(application)
    entities = entities_of(application, middleware)
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


def _sends_reliably(node: NodeSection) -> bool:
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
