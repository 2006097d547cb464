"""Server calls and sender-receiver communication: where a runnable is executed, what that costs, and what it carries."""

from dataclasses import replace
from fractions import Fraction

import pytest
from hand_made_systems import of_parts, read, ticks, write

from amalthea_uros import analyze_system
from amalthea_uros.analyze.results.chains import LatencyQuantity
from amalthea_uros.perf.activities import (
    AccessKind,
    Call,
    Chance,
    Demand,
    ProbabilitySwitch,
    SenderReceiverAccess,
    ServerCall,
    ServerCallKind,
    Trigger,
)
from amalthea_uros.perf.distributions import Constant
from amalthea_uros.perf.events import EventChain, Events, ProcessChange, ProcessEvent, RunnableChange, RunnableEvent
from amalthea_uros.perf.hardware import Access, Clock, Core, Hardware, Latency, Memory, Structure
from amalthea_uros.perf.mapping import Placement, TaskAllocation
from amalthea_uros.perf.os import Overhead, Service
from amalthea_uros.perf.software import Label, Runnable, Task
from amalthea_uros.perf.stimuli import InterProcess, Periodic
from amalthea_uros.timing.basics.settings import MemoryModel as MemoryMode
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.units import MICROSECOND as US

SYNCHRONOUS = ServerCall(runnable="serve")
RECEIVE, SEND = (SenderReceiverAccess(label="data", kind=kind) for kind in (AccessKind.READ, AccessKind.WRITE))
NOTIFYING = replace(SEND, notifies=("notified",))


def system(client, server=(), services=()):
    """A client above a server, each every 100 us, on a core of 1 MHz; the server runnable takes 7 us, what it notifies 2 us."""
    tasks = (
        Task(name="client", stimuli=("often",), activities=(ticks(3), *client)),
        Task(name="server", stimuli=("often",), activities=(ticks(1), *server)),
        Task(name="last", stimuli=("triggered",), activities=(ticks(1), read("out"))),
    )
    access = Access(memory="ram", latency=Latency(read=Constant(2), write=Constant(3)))
    core = Core(name="core", clock="clock", accesses=(access,))
    built = of_parts(
        tasks,
        [TaskAllocation(task=task.name, scheduler="core", priority=-rank) for rank, task in enumerate(tasks)],
        [Periodic(name="often", period=100 * US), InterProcess(name="triggered")],
        hardware=Hardware(
            clocks=(Clock(name="clock", frequency=Fraction(10**6)),),
            structures=(Structure(name="ECU", cores=(core,), memories=(Memory(name="ram"),)),),
        ),
        overhead="costs",
        os_parts={"overheads": (Overhead(name="costs", services=tuple(services)),)},
        runnables=[
            Runnable(name="serve", activities=(ticks(7), write("out"), Trigger(stimulus="triggered"))),
            Runnable(name="notified", activities=(ticks(2),)),
        ],
        labels=[Label(name="out"), Label(name="data")],
    )
    placements = tuple(Placement(element=label, memory="ram") for label in ("data", "out"))
    return replace(built, mapping=replace(built.mapping, placements=placements))


def responses(built, memory=MemoryMode.NONE):
    processes = analyze_system(built, Settings(memory=memory)).processes
    return {p.name: p.response.worst // US if p.response else p.reason for p in processes}


def test_a_runnable_that_no_process_calls_is_executed_by_the_client():
    # 3 + 7 of the client, 1 of the server, and 1 of the task that the server runnable triggers.
    assert responses(system([SYNCHRONOUS])) == {"client": 10, "server": 11, "last": 12}


@pytest.mark.parametrize(
    "call",
    [ProbabilitySwitch(branches=(Chance(weight=1, activities=(SYNCHRONOUS,)), Chance(weight=1, activities=()))), SYNCHRONOUS],
    ids=["in some jobs", "in all jobs"],
)
def test_it_is_said_that_clients_execute_it(call):
    analysis = analyze_system(system([call]))
    assert analysis["client"].wcet == 10 * US
    assert "clients execute the runnables of synchronous servers that no process calls" in analysis.assumptions


def test_a_client_waits_for_the_process_that_executes_the_runnable():
    found = responses(system([SYNCHRONOUS], [Call(runnable="serve")]))
    assert found["client"] == "it waits for the server runnable 'serve', which 'server' executes"
    assert found["server"] == "depends on 'client', which could not be analysed"


def test_a_runnable_that_others_also_request_is_executed_somewhere():
    asynchronous = replace(SYNCHRONOUS, kind=ServerCallKind.ASYNCHRONOUS)
    found = responses(system([SYNCHRONOUS], [asynchronous]))
    assert found["client"] == "it waits for the server runnable 'serve', which no process executes"


@pytest.mark.parametrize(
    ("call", "served", "expected"),
    [
        # An asynchronous call does not wait, if a process executes the runnable.
        (ServerCall(runnable="serve", kind=ServerCallKind.ASYNCHRONOUS), ["serve"], 3),
        (ServerCall(runnable="serve", kind=ServerCallKind.ASYNCHRONOUS), [], "no process executes the server runnable 'serve'"),
        (
            ServerCall(runnable="serve", kind=ServerCallKind.ASYNCHRONOUS, result="notified"),
            ["serve"],
            "no process executes the result runnable 'notified'",
        ),
        (ServerCall(runnable="serve", kind=ServerCallKind.ASYNCHRONOUS, result="notified"), ["serve", "notified"], 3),
        # The result may not be there yet.
        (
            ServerCall(runnable="serve", kind=ServerCallKind.GET_RESULT),
            ["serve"],
            "it waits for the server runnable 'serve', which 'server' executes",
        ),
        (ServerCall(runnable="serve", kind=ServerCallKind.GET_RESULT, waits=False), ["serve"], 3),
        # A process that is notified calls the runnable; otherwise it is unknown who executes it.
        (NOTIFYING, ["notified"], 3),
        (NOTIFYING, [], "no process executes the notified runnable 'notified'"),
    ],
)
def test_who_waits_and_for_whom(call, served, expected):
    assert responses(system([call], [Call(runnable=name) for name in served]))["client"] == expected


def test_a_server_runnable_that_calls_itself_by_a_server_call():
    built = system([SYNCHRONOUS])
    circle = replace(built.software, runnables=(Runnable(name="serve", activities=(SYNCHRONOUS,)),))
    assert responses(replace(built, software=circle))["client"] == "the runnable 'serve' calls itself"


def test_overheads_of_calls_and_accesses():
    services = (
        (Service.SERVER_CALL, Demand(Constant(10))),
        (Service.SENDER_RECEIVER_READ, Demand(Constant(20))),
        (Service.SENDER_RECEIVER_WRITE, Demand(Constant(40))),
    )
    built = system([SYNCHRONOUS, RECEIVE], services=services)
    assert responses(built)["client"] == 3 + 7 + 10 + 20
    assert responses(system([SEND], services=services))["client"] == 3 + 40
    assert not analyze_system(built).findings


def test_sender_receiver_accesses_take_the_time_of_the_memory():
    assert responses(system([RECEIVE, SEND]), MemoryMode.EXPLICIT)["client"] == 3 + 2 + 3
    # The label is copied in and out, and the copies are accessed.
    assert responses(system([RECEIVE, SEND]), MemoryMode.IMPLICIT)["client"] == 3 + 2 + 3 + 2 + 3


def test_what_the_server_runnable_does_is_carried_on():
    """From the start of the server runnable, in the client, to the end of the task that reads what it writes."""
    built = system([SYNCHRONOUS])
    start = RunnableEvent(name="start", runnable="serve", change=RunnableChange.START)
    end = ProcessEvent(name="end", process="last", change=ProcessChange.TERMINATE)
    chain = EventChain(name="chain", stimulus="start", response="end")
    (found,) = analyze_system(replace(built, events=Events(events=(start, end), chains=(chain,)))).chains
    assert found.routes == ("start -[a trigger triggered]-> end", "start -[data out]-> end")
    # The client starts it at 3; the last task always ends at 12, after all of the client (10) and of the server (1).
    # The data have no bound, since nobody states how long the last task is not triggered at most; what is claimed includes 9.
    claimed = {value.quantity: value.value for value in found.values}
    assert claimed.get(LatencyQuantity.MIN_FIRST_TO_FIRST, 0) <= 9 * US
    assert claimed.get(LatencyQuantity.MAX_REDUCED_REACTION_TIME, 9 * US) >= 9 * US
    assert claimed[LatencyQuantity.MAX_REDUCED_DATA_AGE] >= 9 * US
