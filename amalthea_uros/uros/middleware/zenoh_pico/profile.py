"""The profile of zenoh-pico."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from amalthea_uros.perf.executors import Waiting
from amalthea_uros.spec.application import Application
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.spec.profiles import ProfileData
from amalthea_uros.units import MILLISECOND, Time
from amalthea_uros.uros.middleware import figures
from amalthea_uros.uros.middleware.options import OptionRow
from amalthea_uros.uros.middleware.profile import Heartbeat, MemoryUse, MessageKind, MiddlewareThread, Option, Part, Sending
from amalthea_uros.uros.middleware.zenoh_pico import memory, messages, pools

#: In each lease (`Z_TRANSPORT_LEASE_EXPIRE_FACTOR` in CMakeLists.txt of eclipse-zenoh/zenoh-pico).
_KEEP_ALIVES = 3


@dataclass(frozen=True, slots=True)
class ZenohPico:
    """zenoh-pico with rmw_zenoh_pico, whose subscribers put messages into queues for an rclc executor."""

    data: ProfileData

    @property
    def name(self) -> str:
        """Its name."""
        return self.data.profile

    @property
    def title(self) -> str:
        """Its full name."""
        return self.data.title

    @property
    def source(self) -> str:
        """Where its figures come from."""
        return self.data.source

    def waiting(self, middleware: Middleware) -> Waiting:
        """How an executor waits; its queues are lists on the heap, without a limit."""
        return figures.waiting(self.data, None)

    def sending(self, middleware: Middleware) -> Sending:
        """How messages are sent: the transport acknowledges them, nobody waits for that."""
        how, stated = self.data.sending, middleware.reliable.timeout
        return Sending(
            waits=how.waits and middleware.reliable.waits,
            timeout=self._time("Z_CONFIG_SOCKET_TIMEOUT", middleware) if stated is None else stated,
            resends_after=None,
            holds_session_while_waiting=how.holds_session_while_waiting,
            drops_when_busy=how.drops_when_busy,
            is_protected=how.is_protected,
        )

    def threads(self, middleware: Middleware) -> Sequence[MiddlewareThread]:
        """Its threads beside the executors."""
        return tuple(figures.threads(self.data, middleware))

    def parts(self, kind: MessageKind, content: int, *, reliable: bool, middleware: Middleware) -> Sequence[Part]:
        """What is sent for a message."""
        return messages.parts(kind, content, reliable=reliable, middleware=middleware, data=self.data)

    def heartbeat(self, middleware: Middleware) -> Heartbeat | None:
        """Messages that keep the connection alive."""
        interval = self._time("Z_TRANSPORT_LEASE", middleware) // _KEEP_ALIVES
        return Heartbeat(figures.size(self.data, "heartbeat"), interval, is_answered=False)

    def gives_up_after(self, kind: MessageKind, content: int, *, reliable: bool, middleware: Middleware) -> Time | None:
        """Time after which a sender stops waiting for an acknowledgement, if it does at all."""
        how = self.sending(middleware)
        return how.timeout if reliable and how.waits else None

    def largest_content(self, kind: MessageKind, *, reliable: bool, middleware: Middleware) -> int | None:
        """The longest content that can be sent or received."""
        return messages.largest_content(kind, reliable=reliable, middleware=middleware, data=self.data)

    def limiting_options(self, *, reliable: bool, middleware: Middleware) -> Sequence[str]:
        """The build options that limit the content of messages."""
        return ("FRAG_MAX_SIZE",)

    def buffers(self, middleware: Middleware) -> int | None:
        """There are none: nobody keeps messages until they are acknowledged."""
        return None

    def option_table(self) -> Mapping[str, OptionRow]:
        """What is known of its build options."""
        return pools.rows()

    def options(self, application: Application, middleware: Middleware) -> Sequence[Option]:
        """Its build options."""
        return pools.options(application, middleware, self.data.options)

    def _time(self, option: str, middleware: Middleware) -> Time:
        return figures.option(self.options(Application(), middleware), option) * MILLISECOND

    def memory(self, application: Application, middleware: Middleware) -> Sequence[MemoryUse]:
        """What it occupies."""
        return memory.memory(application, middleware, self.data.options)
