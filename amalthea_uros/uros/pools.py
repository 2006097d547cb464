"""The build options of the middleware: what the application needs of its pools, and which values the build refuses or ignores."""

from __future__ import annotations

from collections.abc import Iterable

from amalthea_uros.diagnostics import Location
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.middleware.options import Option, OptionRole


def pools_of(options: Iterable[Option]) -> tuple[Option, ...]:
    """The options that count things, entities and waiting messages."""
    return tuple(each for each in options if each.role in (OptionRole.POOL, OptionRole.QUEUE) and each.needed is not None)


def check_options(options: Iterable[Option], middleware: Middleware, notes: Notes) -> None:
    """Report options that are too small, and values that the build refuses or ignores."""
    for option in options:
        if option.without_effect:
            _report_without_effect(option, middleware, notes)
        elif option.is_power_of_two and option.available & (option.available - 1):
            _report_no_power_of_two(option, middleware, notes)
        elif option.is_exceeded and option.role in (OptionRole.POOL, OptionRole.QUEUE):
            _report_pool(option, middleware, notes)
        elif option.is_exceeded and option.role is OptionRole.ROOM:
            _report_name(option, middleware, notes)


def _report_pool(option: Option, middleware: Middleware, notes: Notes) -> None:
    """Without an entity the application does not start; without a slot it loses messages."""
    default = "" if option.is_stated else " by default"
    is_queue = option.role is OptionRole.QUEUE
    least = "at least " if is_queue else ""
    message = f"{option.name} is {option.available}{default}, but the application needs {least}{option.needed}"
    # How many messages wait depends on response times, which nobody knows here.
    value = "the number that 'amuros generate' computes" if is_queue else f"{option.needed} or more"
    advice = f"{option.when_exhausted} Set {option.name} to {value} in the build and under 'limits'."
    report = notes.error if option.is_stated and option.role is OptionRole.POOL else notes.warning
    report("UR120", message, _location(option, middleware), advice)


def _report_no_power_of_two(option: Option, middleware: Middleware, notes: Notes) -> None:
    lower = 1 << (option.available.bit_length() - 1)
    message = f"{option.name} is {option.available}, which is not a power of two: the build stops with an error"
    notes.warning("UR126", message, _location(option, middleware), f"Set it to {2 * lower}, or to {lower} if that is enough.")


def _report_name(option: Option, middleware: Middleware, notes: Notes) -> None:
    default = "" if option.is_stated else " by default"
    message = f"{option.name} is {option.available}{default}, but the application needs {option.needed} {option.counts}"
    advice = f"{option.when_exhausted} Use a shorter name, or set {option.name} to {option.needed} or more."
    report = notes.error if option.is_stated else notes.warning
    report("UR127", message, _location(option, middleware), advice)


def _report_without_effect(option: Option, middleware: Middleware, notes: Notes) -> None:
    message = f"{option.name} has no effect: {option.without_effect}"
    notes.warning("UR128", message, _location(option, middleware), "Remove it here and in the build.")


def _location(option: Option, middleware: Middleware) -> Location | None:
    return middleware.limits.location(option.name)
