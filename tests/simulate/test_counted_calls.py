"""Events of a runnable occur only when a call of it has an effect."""

from amalthea_uros.perf.activities import Call, Count, Demand, Execute
from amalthea_uros.perf.distributions import Constant
from amalthea_uros.perf.events import EventChain, Events, ProcessChange, ProcessEvent, RunnableChange, RunnableEvent
from amalthea_uros.perf.hardware import Clock, Core, Hardware, Structure
from amalthea_uros.perf.mapping import Mapping, TaskAllocation
from amalthea_uros.perf.os import OperatingSystem, Os, Policy, Scheduler
from amalthea_uros.perf.software import Runnable, Software, Task
from amalthea_uros.perf.stimuli import Counter, EventTriggered, Periodic, Stimuli
from amalthea_uros.perf.system import System
from amalthea_uros.simulate.options import Options
from amalthea_uros.simulate.system import simulate_system
from amalthea_uros.timing.basics.quantities import ChainQuantity
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import MILLISECOND as MS


def system(call):
    """A task calls a runnable every millisecond; its end activates another task. One tick is a microsecond."""
    work = Execute(demand=Demand(ticks=Constant(10)))
    ends = RunnableEvent(name="ends", runnable="work", change=RunnableChange.TERMINATE)
    starts = RunnableEvent(name="starts", runnable="work", change=RunnableChange.START)
    finished = ProcessEvent(name="finished", process="second", change=ProcessChange.TERMINATE)
    return System(
        hardware=Hardware(
            clocks=(Clock(name="clock", frequency=10**6),),
            structures=(Structure(name="ECU", cores=(Core(name="core", clock="clock"),)),),
        ),
        os=Os(
            systems=(
                OperatingSystem(name="OS", schedulers=(Scheduler(name="scheduler", policy=Policy.OSEK, cores=("core",)),)),
            )
        ),
        stimuli=Stimuli(stimuli=(Periodic(name="timer", period=MS), EventTriggered(name="at the end", events=("ends",)))),
        software=Software(
            tasks=(
                Task(name="first", stimuli=("timer",), activities=(call, work)),
                Task(name="second", stimuli=("at the end",), activities=(work,), activation_limit=10),
            ),
            runnables=(Runnable(name="work", activities=(work,)),),
        ),
        mapping=Mapping(
            tasks=(
                TaskAllocation(task="first", scheduler="scheduler", priority=2),
                TaskAllocation(task="second", scheduler="scheduler", priority=1),
            )
        ),
        events=Events(
            events=(starts, ends, finished),
            chains=(EventChain(name="way", stimulus="starts", response="finished"),),
        ),
    )


def test_a_call_that_counting_leaves_out_raises_no_event():
    found = simulate_system(system(Call(runnable="work", counter=Counter(prescaler=5, offset=1))), Options(duration=100 * MS))
    assert (found["first"].jobs, found["second"].jobs) == (100, 20)
    # From the start of the call: it takes 10 us, the rest of the job 10 us, and the job that its end activates 10 us.
    latency = found.chains["way"].quantities[ChainQuantity.REDUCED_REACTION_TIME]
    assert (latency.count, latency.min, latency.max) == (20, 30 * US, 30 * US)


def test_a_call_that_stands_for_several_raises_its_events_each_time():
    found = simulate_system(system(Call(runnable="work", times=Count(least=3, mean=3, most=3))), Options(duration=100 * MS))
    assert (found["first"].jobs, found["second"].jobs) == (100, 300)
