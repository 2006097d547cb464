"""A board with a looping executor behind a serial line; the ECU has 1 MHz, and so have the wires: a tick is a microsecond.

/cmd --agent--> wire_in --> [interrupt] --> Executor: On_cmd writes "speed" --> pwm (own task, every 5 ms)
                                            Executor: On_cmd publishes /odom --> wire_out --agent--> host
"""

from dataclasses import replace

from hand_made_systems import READ, WRITE, Proc, access, chain, system, ticks

from amalthea_uros.analyze.chains.message_chains import evaluate_executors_and_messages
from amalthea_uros.analyze.response_times.propagation import solve
from amalthea_uros.executors.semantics.loops import timing_context
from amalthea_uros.perf.activities import Call, Chance, ProbabilitySwitch
from amalthea_uros.perf.distributions import Constant
from amalthea_uros.perf.events import LabelChange, LabelEvent, ProcessChange, ProcessEvent, RunnableChange, RunnableEvent
from amalthea_uros.perf.executors import Executor, Handle, HandleKind, LoopKind, Publication, ThreadLoop, WaitBehaviour
from amalthea_uros.perf.network import Direction, Network, Purpose, Span, Transmission, Wire, WireKind
from amalthea_uros.perf.os import Policy, Scheduler
from amalthea_uros.perf.software import Label, Preemption, Runnable
from amalthea_uros.perf.stimuli import RelativePeriodic
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import MILLISECOND as MS

#: Times on the wires in microseconds: Twist and Int32 at 115200 baud, an acknowledgement.
CMD, ODOM, ACK = 5816, 1997, 1737
SLEEP = 10 * MS
AGENT = Span(least=MS, most=2 * MS)
LOOP = ThreadLoop(kind=LoopKind.SLEEPING, timeout=100 * MS, sleep=SLEEP)

_EVENTS = (
    ProcessEvent(name="cmd_published", process="cmd_in", change=ProcessChange.ACTIVATE),
    RunnableEvent(name="on_cmd_end", runnable="On_cmd", change=RunnableChange.TERMINATE, process="Executor"),
    RunnableEvent(name="on_tick_end", runnable="On_tick", change=RunnableChange.TERMINATE, process="Executor"),
    LabelEvent(name="speed_written", label="speed", change=LabelChange.WRITE, process="Executor"),
    ProcessEvent(name="pwm_end", process="pwm", change=ProcessChange.TERMINATE),
    ProcessEvent(name="odom_at_host", process="odom_out", change=ProcessChange.TERMINATE),
    ProcessEvent(name="sensor_start", process="sensor", change=ProcessChange.START),
)


def board(*chains, agent=AGENT, publication=None, handles=(), wire=None, **handle):
    """The system; each chain as its name and its events.

    Parameters
    ----------
    agent : its latency in both directions and to acknowledgements
    handles : further ones, after that of /cmd, with their execution times in microseconds
    """
    publication = publication or Publication(topic="odom", transmission="odom_out")
    cmd = Handle(
        name="cmd",
        kind=HandleKind.SUBSCRIPTION,
        runnable="On_cmd",
        interval=200 * MS,
        transmission="cmd_in",
        depth=10,
        publications=(publication,),
    )
    every = [(replace(cmd, **handle), 300), *handles]
    names = [each.runnable for each, _ in every]
    switches = [
        ProbabilitySwitch(branches=(Chance(weight=1.0, activities=(Call(runnable=name),)), Chance(weight=1.0, activities=())))
        for name in names
    ]
    found = system(
        Proc("Executor", (Call(runnable="Spin"), *switches), stimuli=("round",), priority=5),
        Proc("pwm", (access("speed", READ), ticks(50)), 5000, priority=9),
        Proc("sensor", (ticks(20), access("raw", WRITE)), 10_000, priority=8),
        _on_wire("cmd_in", CMD, 200, "rx"),
        _on_wire("odom_out", ODOM, 200, "tx"),
        _on_wire("odom_ack", ACK, 200, "rx"),
        schedulers=[
            Scheduler(name="s0", policy=Policy.OSEK, cores=("c0",)),
            Scheduler(name="rx", policy=Policy.OSEK, cores=("c1",)),
            Scheduler(name="tx", policy=Policy.OSEK, cores=("c2",)),
        ],
        labels=(Label(name="speed"), Label(name="raw")),
        runnables=(
            Runnable(name="Spin", activities=(ticks(100),)),
            Runnable(name="On_cmd", callback=True, activities=(ticks(300), access("speed", WRITE))),
            *(
                Runnable(
                    name=each.runnable, callback=True, activities=(access("raw", READ), ticks(cost), access("speed", WRITE))
                )
                for each, cost in handles
            ),
        ),
        events=_EVENTS,
        chains=tuple(chain(name, *events) for name, *events in chains),
    )
    executor = Executor(
        name="Executor",
        task="Executor",
        spin="Spin",
        loop=LOOP,
        handles=tuple(each for each, _ in every),
        waiting=WaitBehaviour(slots=None),
    )
    stimuli = (
        RelativePeriodic(name="round", distance=Constant(SLEEP + 100 * US), has_maximum=False),
        *(
            RelativePeriodic(name=f"{name}_queued", distance=Constant(200 * MS), has_maximum=False)
            for name in ("cmd_in", "odom_out", "odom_ack")
        ),
    )
    hardware = found.hardware
    (structure,) = hardware.structures
    third = replace(structure.cores[0], name="c2")
    return replace(
        found,
        hardware=replace(hardware, structures=(replace(structure, cores=(*structure.cores, third)),)),
        stimuli=replace(found.stimuli, stimuli=(*found.stimuli.stimuli, *stimuli)),
        executors=(executor,),
        network=Network(
            wires=(wire or Wire(name="UART", kind=WireKind.SERIAL, cores=("c1", "c2")),),
            transmissions=(
                _transmission("cmd_in", Direction.TO_CONTROLLER, agent, "/cmd"),
                _transmission("odom_out", Direction.TO_AGENT, agent, "/odom"),
                _transmission("odom_ack", Direction.TO_CONTROLLER, agent, None),
            ),
        ),
    )


def message_chains(found):
    """The results of the chains of a system that cross messages, by name."""
    return evaluate_executors_and_messages(solve(timing_context(found)))[1]


def tick(interval=50_000, cost=200):
    """A timer that reads what the sensor writes, with its execution time; both in microseconds."""
    return Handle(name="tick", kind=HandleKind.TIMER, runnable="On_tick", interval=interval * US), cost


def _on_wire(name, length, interval, scheduler):
    return Proc(
        name,
        (ticks(length),),
        stimuli=(f"{name}_queued",),
        priority=0,
        scheduler=scheduler,
        task={"preemption": Preemption.NON_PREEMPTIVE, "activation_limit": 1_000_000},
    )


def _transmission(name, direction, agent, topic):
    purpose = Purpose.DATA if topic else Purpose.ACKNOWLEDGEMENT
    return Transmission(name=name, wire="UART", direction=direction, agent=agent, topic=topic, purpose=purpose)


__all__ = [
    "ACK",
    "CMD",
    "MS",
    "ODOM",
    "SLEEP",
    "US",
    "Publication",
    "Span",
    "Wire",
    "WireKind",
    "board",
    "message_chains",
    "tick",
]
