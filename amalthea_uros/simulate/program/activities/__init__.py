"""What each kind of activity is in the program of a process."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from amalthea_uros.errors import UnknownError
from amalthea_uros.perf import activities as perf
from amalthea_uros.simulate.program.activities.calls import call, server_call
from amalthea_uros.simulate.program.activities.control_flow import choose, group, loop, switch, terminate
from amalthea_uros.simulate.program.activities.effects import (
    execute,
    execution_need,
    incomplete,
    label_access,
    mode_access,
    os_events,
    raise_event,
    receive,
    schedule_point,
    semaphore,
    send,
    sender_receiver_access,
    trigger,
)

if TYPE_CHECKING:
    from amalthea_uros.simulate.program.body import Body


def _migrate(body: Body, activity: perf.Migrate) -> None:
    raise UnknownError("it migrates to another scheduler, which is not simulated")


_COMPILERS: Mapping[type[perf.Activity], Callable[[Body, Any], None]] = MappingProxyType(
    {
        perf.Call: call,
        perf.ClearEvent: os_events,
        perf.Execute: execute,
        perf.ExecutionNeed: execution_need,
        perf.Group: group,
        perf.Incomplete: incomplete,
        perf.LabelAccess: label_access,
        perf.Loop: loop,
        perf.Migrate: _migrate,
        perf.ModeAccess: mode_access,
        perf.ProbabilitySwitch: choose,
        perf.RaiseEvent: raise_event,
        perf.Receive: receive,
        perf.SchedulePoint: schedule_point,
        perf.SemaphoreAccess: semaphore,
        perf.Send: send,
        perf.SenderReceiverAccess: sender_receiver_access,
        perf.ServerCall: server_call,
        perf.SetEvent: os_events,
        perf.Switch: switch,
        perf.Terminate: terminate,
        perf.Trigger: trigger,
        perf.WaitEvent: os_events,
    }
)


def compile_activity(body: Body, activity: perf.Activity) -> None:
    """Append the operations of one activity.

    Raises
    ------
    UnknownError : it cannot be simulated.
    UnknownError : a demand in it is not known.
    """
    _COMPILERS[type(activity)](body, activity)
