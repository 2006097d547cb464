"""The profile of zenoh-pico."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from amalthea_uros.perf.executors import Waiting
from amalthea_uros.spec.application import Application
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.spec.profiles import ProfileData
from amalthea_uros.units import Time
from amalthea_uros.uros.middleware import figures
from amalthea_uros.uros.middleware.profile import MemoryUse, MessageKind, MiddlewareThread, Option, Part, Sending
from amalthea_uros.uros.middleware.zenoh_pico import memory, messages, pools


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
        return figures.waiting(self.data, self.data.waiting.slots)

    def sending(self, middleware: Middleware) -> Sending:
        """How messages are sent: the transport acknowledges them, nobody waits for that."""
        how = self.data.sending
        return Sending(
            waits=how.waits and middleware.reliable.waits,
            timeout=how.timeout if middleware.reliable.timeout is None else middleware.reliable.timeout,
            resends_after=how.resends_after,
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

    def heartbeat(self, middleware: Middleware) -> tuple[int, Time] | None:
        """Length and interval of messages that keep the connection alive."""
        interval = self.data.sending.heartbeat
        return None if interval is None else (figures.size(self.data, "heartbeat"), interval)

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

    def options(self, application: Application, middleware: Middleware) -> Sequence[Option]:
        """Its build options."""
        return pools.options(application, middleware, self.data)

    def memory(self, application: Application, middleware: Middleware) -> Sequence[MemoryUse]:
        """What it occupies."""
        return memory.memory(application, middleware, self.data)
