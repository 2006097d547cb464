"""The profile of Micro XRCE-DDS."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from amalthea_uros.perf.executors import Waiting
from amalthea_uros.spec.application import Application
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.spec.profiles import ProfileData
from amalthea_uros.units import Time
from amalthea_uros.uros.middleware import figures
from amalthea_uros.uros.middleware.options import OptionRow
from amalthea_uros.uros.middleware.profile import Heartbeat, MemoryUse, MessageKind, MiddlewareThread, Option, Part, Sending
from amalthea_uros.uros.middleware.xrce_dds import limits, memory, messages, pools, sending


@dataclass(frozen=True, slots=True)
class XrceDds:
    """Micro XRCE-DDS, or a middleware of the kind with other figures."""

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
        """How an executor waits."""
        return figures.waiting(self.data, limits.slots(middleware, self.data))

    def sending(self, middleware: Middleware) -> Sending:
        """How messages are sent."""
        return sending.sending(middleware, self.data)

    def threads(self, middleware: Middleware) -> Sequence[MiddlewareThread]:
        """Its threads beside the executors, or those of its port."""
        return tuple(figures.threads(self.data, middleware))

    def parts(self, kind: MessageKind, content: int, *, reliable: bool, middleware: Middleware) -> Sequence[Part]:
        """What is sent for a message."""
        return messages.parts(kind, content, reliable=reliable, middleware=middleware, data=self.data)

    def heartbeat(self, middleware: Middleware) -> Heartbeat | None:
        """Heartbeats, which follow each other while something is not acknowledged."""
        client = limits.heartbeat_interval(middleware, self.data)
        interval = min(client, self.data.sending.heartbeat or client)
        return Heartbeat(figures.size(self.data, "heartbeat"), interval, is_answered=True)

    def gives_up_after(self, kind: MessageKind, content: int, *, reliable: bool, middleware: Middleware) -> Time | None:
        """Time after which a sender stops waiting."""
        return sending.gives_up_after(kind, content, reliable=reliable, middleware=middleware, data=self.data)

    def largest_content(self, kind: MessageKind, *, reliable: bool, middleware: Middleware) -> int | None:
        """The longest content that can be sent or received."""
        waits = self.sending(middleware).waits
        return messages.largest_content(kind, reliable=reliable, waits=waits, middleware=middleware, data=self.data)

    def limiting_options(self, *, reliable: bool, middleware: Middleware) -> Sequence[str]:
        """The build options that limit the content of messages."""
        option = pools.mtu_option(middleware)
        options = () if option is None else (option,)
        return (*options, "RMW_UXRCE_STREAM_HISTORY") if reliable else options

    def buffers(self, middleware: Middleware) -> int | None:
        """The number of buffers of the reliable stream to the agent."""
        return limits.output_history(middleware, self.data)

    def option_table(self) -> Mapping[str, OptionRow]:
        """What is known of its build options."""
        return pools.rows()

    def options(self, application: Application, middleware: Middleware) -> Sequence[Option]:
        """Its build options."""
        return pools.options(application, middleware, self.data)

    def memory(self, application: Application, middleware: Middleware) -> Sequence[MemoryUse]:
        """What it occupies."""
        return memory.memory(application, middleware, self.data)
