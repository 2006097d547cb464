"""The build options of zenoh-pico; it has no pools, but allocates entities and messages on the heap."""

from __future__ import annotations

from collections.abc import Mapping

from amalthea_uros.spec.application import Application
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.uros.middleware.options import OptionRow, option_rows
from amalthea_uros.uros.middleware.profile import Option

#: What a message carries besides its content, at most: the encapsulation header of CDR, the attachment of ROS 2 and the headers of a
#: push and a put with numbers of full length (eclipse-zenoh/zenoh-pico src/protocol/codec; esol-community/rmw_zenoh_pico).
_HEADERS = 50


def rows() -> Mapping[str, OptionRow]:
    """The table of options."""
    return option_rows(__name__.rpartition(".")[0])


def options(application: Application, middleware: Middleware, defaults: Mapping[str, int]) -> tuple[Option, ...]:
    """The build options; `defaults` are those that a profile states instead of those of the package."""
    longest = max((_bytes(each.message_size) for node in application.nodes for each in node.subscriptions), default=0)
    sizes = [size for node in application.nodes for each in node.services for size in (each.request_size, each.response_size)]
    sizes += [size for node in application.nodes for each in node.clients for size in (each.request_size, each.response_size)]
    longest = max([longest, *map(_bytes, sizes)])
    needed = {"FRAG_MAX_SIZE": longest + _HEADERS} if longest else {}
    found = []
    for name, row in rows().items():
        stated = row.stated(middleware.limits)
        available = defaults.get(name, row.default) if stated is None else stated
        if available is not None:
            found.append(row.option(needed=needed.get(name), available=available, is_stated=stated is not None))
    return tuple(found)


def _bytes(size: int) -> int:
    return -(-size // 8)
