"""Executors: their handles in the order of the calls that add them, and how they spin."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from amalthea_uros._internal.ports import parameter_services
from amalthea_uros.source.entities import callback_of
from amalthea_uros.source.facts import (
    CodeCallback,
    CodeEntityKind,
    CodeExecutor,
    CodeFacts,
    CodeHandle,
    CodeTrigger,
    SpinKind,
)
from amalthea_uros.source.walk import CodeWalk, FunctionCall
from amalthea_uros.units import Time

NANOSECOND = 1000
_ADD = "rclc_executor_add_"
#: What is added -> its kind, and the positions of its callbacks.
_ADDED: Mapping[str, tuple[CodeEntityKind, tuple[int, ...]]] = {
    "subscription": (CodeEntityKind.SUBSCRIPTION, (3,)),
    "subscription_with_context": (CodeEntityKind.SUBSCRIPTION, (3,)),
    "timer": (CodeEntityKind.TIMER, ()),
    "service": (CodeEntityKind.SERVICE, (4,)),
    "service_with_request_id": (CodeEntityKind.SERVICE, (4,)),
    "service_with_context": (CodeEntityKind.SERVICE, (4,)),
    "client": (CodeEntityKind.CLIENT, (3,)),
    "client_with_request_id": (CodeEntityKind.CLIENT, (3,)),
    "guard_condition": (CodeEntityKind.GUARD_CONDITION, (2,)),
    "action_server": (CodeEntityKind.ACTION_SERVER, (5, 6)),
    "action_client": (CodeEntityKind.ACTION_CLIENT, (5, 6, 7, 8)),
    "parameter_server": (CodeEntityKind.PARAMETER_SERVER, (2,)),
    "parameter_server_with_context": (CodeEntityKind.PARAMETER_SERVER, (2,)),
}
SPIN_KINDS = {
    "rclc_executor_spin": SpinKind.ENDLESS,
    "rclc_executor_spin_some": SpinKind.SOME,
    "rclc_executor_spin_period": SpinKind.PERIOD,
    "rclc_executor_spin_period_with_exit": SpinKind.PERIOD,
    "rclc_executor_spin_one_period": SpinKind.PERIOD,
}
_LIFECYCLE = (
    "rclc_lifecycle_init_get_state_server",
    "rclc_lifecycle_init_get_available_states_server",
    "rclc_lifecycle_init_change_state_server",
)
_TRIGGER_PREFIX = "rclc_executor_trigger_"
_BUILT_IN = ("any", "all", "one", "always")

Action = Callable[[CodeFacts, FunctionCall, CodeWalk], None]


def _init(facts: CodeFacts, call: FunctionCall, _walk: CodeWalk) -> None:
    variable, number = call.argument(0), call.argument(2)
    if variable is not None and variable.key not in facts.executors:
        handles = number.number if number is not None else None
        facts.executors[variable.key] = CodeExecutor(
            key=variable.key, variable=variable.name, place=call.place, max_handles=handles
        )


def executor_of(facts: CodeFacts, call: FunctionCall, index: int = 0) -> CodeExecutor | None:
    """The executor that an argument of a call is; None if it was not initialised in these sources."""
    variable = call.argument(index)
    return facts.executors.get(variable.key) if variable is not None else None


def _add(facts: CodeFacts, call: FunctionCall, walk: CodeWalk) -> None:
    executor, entity = executor_of(facts, call), call.argument(1)
    if executor is None or entity is None:
        return
    kind, positions = _ADDED[call.name.removeprefix(_ADD)]
    callbacks: list[CodeCallback] = []
    for position in positions:
        given = call.argument(position)
        callback = callback_of(given, walk) if given is not None else None
        callbacks += [callback] if callback is not None else []
    last, message = call.argument(-1), call.argument(2)
    handle = CodeHandle(
        kind=kind,
        entity=entity.key,
        callbacks=tuple(callbacks),
        place=call.place,
        count=parameter_services(facts.ros.value if facts.ros is not None else None)
        if kind is CodeEntityKind.PARAMETER_SERVER
        else 1,
        message=message.core.text if message is not None and kind is CodeEntityKind.SUBSCRIPTION else "",
        always=kind is CodeEntityKind.SUBSCRIPTION and last is not None and last.resolved.text == "ALWAYS",
    )
    executor.handle_by_entity.setdefault((kind, entity.key), handle)


def _add_lifecycle(facts: CodeFacts, call: FunctionCall, _walk: CodeWalk) -> None:
    executor = executor_of(facts, call, 1)
    if executor is not None:
        handle = CodeHandle(kind=CodeEntityKind.LIFECYCLE, entity=call.name, callbacks=(), place=call.place)
        executor.handle_by_entity.setdefault((handle.kind, handle.entity), handle)


def _timeout(facts: CodeFacts, call: FunctionCall, _walk: CodeWalk) -> None:
    executor, given = executor_of(facts, call), call.argument(1)
    if executor is not None and given is not None:
        number = given.number
        executor.timeout = Time(number * NANOSECOND) if number is not None and number > 0 else None
        executor.timeout_place = call.place


def _trigger(facts: CodeFacts, call: FunctionCall, _walk: CodeWalk) -> None:
    executor, function, target = executor_of(facts, call), call.argument(1), call.argument(2)
    if executor is not None and function is not None:
        name = function.name.removeprefix(_TRIGGER_PREFIX)
        is_custom = name not in _BUILT_IN
        executor.trigger = CodeTrigger(
            function=name, object=target.key if target is not None else "", is_custom=is_custom, place=call.place
        )


def _semantics(facts: CodeFacts, call: FunctionCall, _walk: CodeWalk) -> None:
    executor, given = executor_of(facts, call), call.argument(1)
    if executor is not None and given is not None and given.resolved.text in ("LET", "RCLCPP_EXECUTOR"):
        executor.semantics = "LET" if given.resolved.text == "LET" else "ROS"


#: What the functions of the executor do, beside spinning.
ACTIONS: Mapping[str, Action] = {
    "rclc_executor_init": _init,
    "rclc_executor_set_timeout": _timeout,
    "rclc_executor_set_trigger": _trigger,
    "rclc_executor_set_semantics": _semantics,
    **dict.fromkeys((_ADD + name for name in _ADDED), _add),
    **dict.fromkeys(_LIFECYCLE, _add_lifecycle),
}
SPINS = frozenset(SPIN_KINDS)
