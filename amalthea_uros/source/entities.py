"""What functions of rclc create: nodes, publishers, subscriptions, timers and more."""

from __future__ import annotations

from collections.abc import Mapping

from amalthea_uros._internal.message_types import MessageType
from amalthea_uros._internal.records import dataclass
from amalthea_uros.source.arrays import members_of
from amalthea_uros.source.facts import CodeCallback, CodeEntity, CodeEntityKind
from amalthea_uros.source.scope import Expression
from amalthea_uros.source.syntax import called, descendants, text_of
from amalthea_uros.source.walk import CodeWalk, FunctionCall
from amalthea_uros.units import Time

RELIABLE, BEST_EFFORT = "reliable", "best-effort"
_BY_PROFILE = "by profile"
_TYPE_SUPPORTS = {
    "ROSIDL_GET_MSG_TYPE_SUPPORT": "msg",
    "ROSIDL_GET_SRV_TYPE_SUPPORT": "srv",
    "ROSIDL_GET_ACTION_TYPE_SUPPORT": "action",
}
#: Quality of service profiles: ros2/rmw rmw/include/rmw/qos_profiles.h.
_PROFILES = {
    "rmw_qos_profile_default": RELIABLE,
    "rmw_qos_profile_services_default": RELIABLE,
    "rmw_qos_profile_parameters": RELIABLE,
    "rmw_qos_profile_sensor_data": BEST_EFFORT,
}
#: Policies of profiles: ros2/rmw rmw/include/rmw/types.h.
_POLICIES = {
    "RMW_QOS_POLICY_RELIABILITY_RELIABLE": RELIABLE,
    "RMW_QOS_POLICY_RELIABILITY_BEST_EFFORT": BEST_EFFORT,
}
#: The members of a profile up to its reliability.
_POLICIES_IN_ORDER = ("history", "depth", "reliability")
#: ros2/rcl rcl/include/rcl: they have the profile that is the default.
_DEFAULT_OPTIONS = tuple(f"rcl_{each}_get_default_options" for each in ("publisher", "subscription", "service", "client"))
_NANOSECOND = 1000


@dataclass(frozen=True, slots=True, kw_only=True)
class _Creation:
    """A function that creates something.

    Attributes
    ----------
    node, type, name, period, callback : positions of these arguments; None: it has none
    quality : the reliability, or `by profile`: the fifth argument says it
    """

    kind: CodeEntityKind
    node: int | None = None
    type: int | None = None
    name: int | None = None
    period: int | None = None
    callback: int | None = None
    quality: str | None = None


def _with_quality(kind: CodeEntityKind, name: str) -> dict[str, _Creation]:
    qualities = {
        f"rclc_{name}_init_default": RELIABLE,
        f"rclc_{name}_init_best_effort": BEST_EFFORT,
        f"rclc_{name}_init": _BY_PROFILE,
        f"rcl_{name}_init": _BY_PROFILE,
    }
    return {call: _Creation(kind=kind, node=1, type=2, name=3, quality=quality) for call, quality in qualities.items()}


_TIMER = _Creation(kind=CodeEntityKind.TIMER, period=2, callback=3)
#: ros2/rclc rclc/include/rclc/*.h, rclc_parameter, rclc_lifecycle.
CREATIONS: Mapping[str, _Creation] = {
    "rclc_node_init_default": _Creation(kind=CodeEntityKind.NODE, name=1),
    "rclc_node_init_with_options": _Creation(kind=CodeEntityKind.NODE, name=1),
    "rcl_node_init": _Creation(kind=CodeEntityKind.NODE, name=1),
    **dict.fromkeys(("rcl_timer_init", "rcl_timer_init2"), _Creation(kind=CodeEntityKind.TIMER, period=3, callback=4)),
    "rclc_make_node_a_lifecycle_node": _Creation(kind=CodeEntityKind.LIFECYCLE, node=1),
    "rclc_timer_init_default": _TIMER,
    "rclc_timer_init_default2": _TIMER,
    "rcl_guard_condition_init": _Creation(kind=CodeEntityKind.GUARD_CONDITION),
    "rclc_action_server_init_default": _Creation(kind=CodeEntityKind.ACTION_SERVER, node=1, type=3, name=4),
    "rclc_action_client_init_default": _Creation(kind=CodeEntityKind.ACTION_CLIENT, node=1, type=2, name=3),
    "rclc_parameter_server_init_default": _Creation(kind=CodeEntityKind.PARAMETER_SERVER, node=1),
    "rclc_parameter_server_init_with_option": _Creation(kind=CodeEntityKind.PARAMETER_SERVER, node=1),
    **_with_quality(CodeEntityKind.PUBLISHER, "publisher"),
    **_with_quality(CodeEntityKind.SUBSCRIPTION, "subscription"),
    **_with_quality(CodeEntityKind.SERVICE, "service"),
    **_with_quality(CodeEntityKind.CLIENT, "client"),
}


def entity_of(call: FunctionCall, walk: CodeWalk) -> CodeEntity | None:
    """What a call creates; None if it lacks the first argument."""
    form, variable = CREATIONS[call.name], call.argument(0)
    if variable is None:
        return None
    parts = {name: _argument(call, getattr(form, name)) for name in ("node", "type", "name", "period", "callback")}
    nanoseconds = parts["period"].number if parts["period"] is not None else None
    return CodeEntity(
        kind=form.kind,
        key=variable.key,
        variable=variable.name,
        place=call.place,
        node=parts["node"].key if parts["node"] is not None else "",
        name=parts["name"].string if parts["name"] is not None else None,
        type=message_type(parts["type"]) if parts["type"] is not None else None,
        reliability=_reliability(call, form.quality),
        period=Time(nanoseconds * _NANOSECOND) if nanoseconds is not None and nanoseconds > 0 else None,
        callback=callback_of(parts["callback"], walk) if parts["callback"] is not None else None,
        options=_options(call),
    )


def _argument(call: FunctionCall, index: int | None) -> Expression | None:
    return call.argument(index) if index is not None else None


def message_type(given: Expression) -> MessageType | None:
    """The type whose support an expression is."""
    own = given.resolved
    if own.node.type != "call_expression":
        return None
    name, arguments = called(own.node)
    # A parameter of a macro is replaced in the names of types, too; one of a function is not.
    is_macro = own.function is not None and own.function.is_macro
    names = [own.at(argument).name if is_macro else text_of(argument) for argument in arguments]
    if name not in _TYPE_SUPPORTS:
        return None
    if len(names) == 2:
        names.insert(1, _TYPE_SUPPORTS[name])
    return MessageType(*names) if len(names) == 3 else None


def callback_of(given: Expression, walk: CodeWalk) -> CodeCallback | None:
    """The function that an expression names; None for NULL."""
    own = given.resolved
    if own.node.type == "lambda_expression":
        function = walk.lambdas.get(text_of(own.node))
        return CodeCallback(name=function.name if function is not None else "lambda", function=function)
    name = own.name
    if name in ("NULL", "nullptr", "0"):
        return None
    found = walk.program.functions.get(name, [])
    near = [each for each in found if each.file is own.file] or found
    return CodeCallback(name=name, function=near[0] if len(near) == 1 else None)


def _reliability(call: FunctionCall, quality: str | None) -> str | None:
    if quality != _BY_PROFILE:
        return quality
    profile = call.argument(4)
    if profile is None:
        return None
    assigned: set[str] = set().union(
        *(profile.program.assigned.get(f"{profile.core.text}{member}.reliability", set()) for member in ("", ".qos"))
    )
    profiles = profile.program.assigned.get(f"{profile.core.text}.qos", set())
    if profiles and not assigned:
        return _PROFILES.get(next(iter(profiles))) if len(profiles) == 1 else None
    own = members_of(profile.resolved.node, _POLICIES_IN_ORDER).get("reliability")
    stated = {*assigned, *([text_of(own)] if own is not None else [])}
    if stated:
        return _POLICIES.get(next(iter(stated))) if len(stated) == 1 else None
    if profile.resolved.node.type == "call_expression" and called(profile.resolved.node)[0] in _DEFAULT_OPTIONS:
        return RELIABLE
    return _PROFILES.get(profile.resolved.name)


def _options(call: FunctionCall) -> tuple[tuple[str, bool], ...]:
    """The options of a parameter server, as far as their initialiser shows them."""
    given = call.argument(2)
    if call.name != "rclc_parameter_server_init_with_option" or given is None:
        return ()
    found = []
    for pair in descendants(given.resolved.node):
        if pair.type == "initializer_pair" and (value := pair.child_by_field_name("value")) is not None:
            designator = pair.child_by_field_name("designator")
            if designator is not None and text_of(value) in ("true", "false", "1", "0"):
                found.append((text_of(designator).lstrip("."), text_of(value) in ("true", "1")))
    return tuple(found)
