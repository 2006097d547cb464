"""How many handles of an executor, and entities of the middleware, a callback needs.

Handles: ros2/rclc `rclc/include/rclc/executor.h`, `rclc_parameter/include/rclc_parameter/rclc_parameter.h` (the constant
`RCLC_EXECUTOR_PARAMETER_SERVER_HANDLES` is 6, and 6 services are added; the README says 5). Entities of the wait set: ros2/rcl
`rcl_action/src/rcl_action/action_server.c` (3 services and a timer) and `action_client.c` (3 clients and 2 subscriptions).
"""

from __future__ import annotations

from amalthea_uros.spec.application import Node
from amalthea_uros.uros.callbacks import Callback, CallbackKind

_PARAMETER_SERVICES = 6
_SOURCES = {CallbackKind.ACTION_SERVER: 4, CallbackKind.ACTION_CLIENT: 5}


def handle_count(callback: Callback) -> int:
    """The number of handles that a callback has in its executor."""
    if callback.kind is CallbackKind.PARAMETERS:
        return _PARAMETER_SERVICES
    if callback.kind is CallbackKind.LIFECYCLE:
        return _lifecycle_services(callback.node)
    return 1


def source_count(callback: Callback) -> int:
    """The number of entities that each of its handles adds to the wait set."""
    return _SOURCES.get(callback.kind, 1)


def _lifecycle_services(node: Node) -> int:
    return 0 if node.lifecycle is None else node.lifecycle.services
