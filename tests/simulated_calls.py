"""Random executors and applications whose calls a simulation and a player that shares no code with it execute at the same times."""

import random
from dataclasses import replace

import numpy as np
import test_whole_way
from random_executors import application

from amalthea_uros.executors.semantics.steps import with_steps
from amalthea_uros.perf.stimuli import Periodic
from amalthea_uros.simulate.kernel.layout import JOB_SIZE
from amalthea_uros.simulate.options import Options, SimulationMode
from amalthea_uros.simulate.program.build import build_program
from amalthea_uros.simulate.runs.execution import SimulationRun
from amalthea_uros.timing.activation.releases import with_first_arrivals
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import Duration


class Least:
    """Chooses the least of everything, and nothing that may happen."""

    def choice(self, options):
        return options[0] if isinstance(options[0], str) else min(options)

    def randint(self, low, high):
        return low

    def randrange(self, *_):
        return 0

    def uniform(self, low, high):
        return low

    def random(self):
        return 0.9


def calls(system, until):
    """The calls of each handle in a run in which everything takes its least time: the response times in picoseconds."""
    options = Options(duration=Duration(until), mode=SimulationMode.BEST)
    context = TimingContext.of_scheduling(with_first_arrivals(with_steps(system), {}), options.settings)
    program, rows = build_program(context, options), []
    assert program.left_out == {}
    run = SimulationRun(context, options, program)
    run.driver.jobs = lambda chunk: rows.append(chunk.copy())
    run.execute([])
    jobs = np.concatenate([np.empty((0, JOB_SIZE), np.int64), *rows])
    first = len(program.processes) + len(program.runnables)
    return {
        key: [(int(row[4]) - int(row[2])) // program.units for row in jobs[jobs[:, 0] == first + number]]
        for number, key in enumerate(program.handles)
    }


def first_difference(simulated, played):
    """Where two lists of times differ; the last call can be cut off by the end. None if they do not."""
    if abs(len(simulated) - len(played)) > 1:
        return len(simulated), len(played)
    pairs = zip(simulated, played, strict=False)
    return next((pair for pair in pairs if pair[0] != pair[1]), None)


def fixed(seed):
    """A random application without publications, in which all phases are known and no two things occur at the same instant.

    No loop goes round without time. Execution times are whole microseconds. Whatever has a period, a phase, a timeout or a sleep gets a
    random part of a microsecond, so that two things that do not cause each other do not occur at the same picosecond: who is first
    then is not defined.
    """
    chance = random.Random(seed)
    app = application(chance)

    def apart(time):
        return time + chance.randrange(1, US) if time else time

    executors = [_fixed(executor, apart, chance) for executor in app.system.executors]
    preempting, ticks = [], {}
    for number, (priority, period, offset, *cost) in enumerate(app.preempting):
        tick = Periodic(name=f"P{number}_tick", period=apart(period), offset=offset + chance.randrange(1, US))
        preempting.append((priority, tick.period, tick.offset, *cost))
        ticks[tick.name] = tick
    stimuli = tuple(ticks.get(each.name, each) for each in app.system.stimuli.stimuli)
    system = replace(app.system, executors=tuple(executors), stimuli=replace(app.system.stimuli, stimuli=stimuli))
    return replace(app, system=system, preempting=preempting)


def _fixed(executor, apart, chance):
    handles = []
    for each in executor.handles:
        interval = apart(each.interval)
        phase = chance.randrange(1, interval) if interval else None
        # The player pays for taking what is not there, the model does not.
        take = None if each.always else each.take
        handles.append(replace(each, publications=(), interval=interval, phase=phase, take=take))
    loop, place = executor.loop, executor.place
    if loop.sleep:
        sleep = apart(loop.sleep)
        early = min(loop.sleep_early, sleep // 2)
        loop = replace(loop, sleep=sleep, sleep_early=early, pace=loop.pace and loop.pace + sleep - loop.sleep)
    loop = replace(loop, period=apart(loop.period), timeout=apart(loop.timeout))
    # A little less than timeouts, so that they are not cut to nothing.
    resolution = executor.waiting.resolution and executor.waiting.resolution - chance.randrange(1, US)
    waiting = replace(executor.waiting, resolution=resolution)
    if place is not None:
        sleep = apart(place.sleep)
        place = replace(place, sleep=sleep, sleep_early=min(place.sleep_early, sleep // 2))
    return replace(executor, handles=tuple(handles), loop=loop, place=place, waiting=waiting)


def on_wires(seed):
    """A random description with known phases, and the plan of its player; None for what the two model with different detail."""
    chance = random.Random(seed)
    content, plan = test_whole_way.drawn(chance)
    plan["begin"] = 0
    for handle in plan["handles"]:
        handle["phase"] = chance.randrange(1, handle["period"])
    wire = content["middleware"]["transport"]
    has_frames = plan["stages"] and plan["wire"] == "serial"  # each chunk has an interrupt, for the player each message
    if plan["tick"] or plan["wire"] == "usb_cdc" or has_frames or wire.get("can_fd", {}).get("foreign"):
        return None
    if plan["wire"] == "serial":
        # A bit takes a whole number of picoseconds, in which the player counts.
        plan["rate"] = wire["serial"]["baud_rate"] = 1_000_000
    return content, plan


def without_heartbeats(system):
    """The system of the player, whose sessions are never silent for long."""
    gone = {name for name in system.transmissions if name.startswith("heartbeat")}
    network, software = system.network, system.software
    return replace(
        system,
        network=replace(network, transmissions=tuple(each for each in network.transmissions if each.name not in gone)),
        software=replace(software, tasks=tuple(task for task in software.tasks if task.name not in gone)),
        mapping=replace(system.mapping, tasks=tuple(each for each in system.mapping.tasks if each.task not in gone)),
    )


def as_planned(system, plan):
    phases = {handle["name"]: handle["phase"] for handle in plan["handles"]}
    (executor,) = system.executors
    handles = tuple(replace(handle, phase=phases[handle.name]) for handle in executor.handles)
    loop = replace(executor.loop, sleep=plan["sleep"], sleep_early=0, pace=0)
    return replace(system, executors=(replace(executor, loop=loop, handles=handles),))
