"""Messages that are lost on wires, and sent again: call by call as a player that shares no code with the simulation, and by hand."""

import random
from dataclasses import replace

import numpy as np
import pytest
from effort import IS_THOROUGH
from lossy_player import LossyPlayer, losses
from test_executor_loops import as_planned, first_difference
from test_whole_way import drawn
from whole_player import MS, US, S

from amalthea_uros.executors.semantics.steps import with_steps
from amalthea_uros.simulate.kernel import layout
from amalthea_uros.simulate.options import Options, SimulationMode
from amalthea_uros.simulate.program.build import build_program
from amalthea_uros.simulate.runs.evaluation import RunEvaluation
from amalthea_uros.simulate.runs.execution import SimulationRun
from amalthea_uros.simulate.sampling.streams import ValueStream
from amalthea_uros.timing.activation.releases import with_first_arrivals
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.uros.described import describe_content

BLOCK = 20
SEEDS = range(4000 if IS_THOROUGH else 60)
DIRECTIONS = ("to_controller", "to_agent")


class Only:
    """Chooses of spans that are one value, and nothing that may happen."""

    def choice(self, options):
        return min(options)

    def randint(self, low, high):
        return low

    def randrange(self, *_):
        return 0

    def uniform(self, low, high):
        return low

    def random(self):
        return 0.9


class Run:
    """A run in which it is stated which messages are lost.

    Attributes
    ----------
    calls : response times of each handle in picoseconds
    result : as of every run
    at_host : times of responses of chains
    """

    def __init__(self, system, until, lost, *, traced=None):
        options = Options(duration=until, mode=SimulationMode.AVERAGE, traced=traced)
        context = TimingContext.of_scheduling(with_first_arrivals(with_steps(system), {}), options.settings)
        program, jobs, observed = build_program(context, options), [], []
        assert program.left_out == {}
        for name, record in program.lossy.items():
            direction = "to_controller" if system.transmissions[name].direction == "to the controller" else "to_agent"
            first = program.memory[record + layout.LOSES]
            values = program.memory[program.memory[first] + layout.LOSS_VALUES]
            program.streams[program.memory[values + layout.STREAM_NUMBER]] = series(lost[direction])
        run = SimulationRun(context, options, program)
        observe = run.driver.observations
        run.driver.jobs = lambda rows: (jobs.append(rows.copy()), add(rows, run))
        run.driver.observations = lambda rows: (observed.append(rows.copy()), observe(rows))
        run.execute([])
        self.result, rows, first = RunEvaluation(run).result(), np.concatenate(jobs), len(program.processes) + len(program.runnables)
        self.calls = {
            key[1]: [(int(row[4]) - int(row[2])) // program.units for row in rows[rows[:, 0] == first + number]]
            for number, key in enumerate(program.handles)
        }
        self.ends = {
            key[1]: [int(row[4]) // program.units for row in rows[rows[:, 0] == first + number]]
            for number, key in enumerate(program.handles)
        }
        found = np.concatenate(observed) if observed else np.empty((0, 4), np.int64)
        self.at_host = [int(row[2]) // program.units for row in found[found[:, 1] == layout.RESPONSE]]


def add(rows, run):
    from amalthea_uros.simulate.metrics import jobs

    jobs.add_rows(rows, [*run.jobs, *run.runnables, *run.handles])


def series(values):
    """Values one after another, then zeros."""
    rest = iter(values)
    return ValueStream(0, 1, lambda count: np.array([int(next(rest, 0)) for _ in range(count)], np.int64))


def without_spans(content):
    """A description in which everything takes its least time."""
    match content:
        case {"min": least, "max": _}:
            return {"min": least, "max": least}
        case dict():
            return {key: without_spans(value) for key, value in content.items()}
        case list():
            return [without_spans(each) for each in content]
    return content


def without_polls(system):
    """A system whose waits do not poll in the last millisecond before a timer is due; the player does not, either."""
    runnables = [replace(each, activities=()) if each.name == "Executor_Poll" else each for each in system.software.runnables]
    return replace(system, software=replace(system.software, runnables=tuple(runnables)))


def on_lossy_wire(seed):
    """A random description with constant times and a wire that loses messages, and the plan of its player; None for other wires."""
    chance = random.Random(seed)
    content, plan = drawn(chance)
    if plan["wire"] not in ("udp", "tcp", "custom") or plan["tick"]:
        return None
    content = without_spans(content)
    for key in ("to_controller", "to_host", "acknowledgement", "link", "transfer"):
        if key in plan:
            plan[key] = (plan[key][0],) * 2
    for each in (*plan["handles"], *plan["tasks"]):
        each["cost"] = (each["cost"][0],) * 2
    plan["begin"] = 0
    for handle in plan["handles"]:
        handle["phase"] = chance.randrange(1, handle["period"])
    content["middleware"]["transport"]["losses"] = dict.fromkeys(DIRECTIONS, "50 %")
    plan["silence"] = chance.choice((1, 20, 100)) * MS
    content["middleware"]["limits"] = {"UCLIENT_MIN_HEARTBEAT_TIME_INTERVAL": f"{plan['silence']} ns"}
    share = chance.choice((0.01, 0.1, 0.3))
    return content, plan, {direction: losses(chance, share) for direction in DIRECTIONS}


@pytest.mark.parametrize("block", range(0, len(SEEDS), BLOCK))
def test_every_call_is_that_of_a_player(block):
    compared, lost = 0, 0
    for seed in SEEDS[block : block + BLOCK]:
        found = on_lossy_wire(seed)
        if found is None:
            continue
        content, plan, drawn_losses = found
        system = describe_content(content).assembly.system
        plan["blocks"] = system.network.wires[0].keeps_sender
        player = LossyPlayer(plan, Only(), drawn_losses)
        seen = player.play(2 * S)
        run = Run(as_planned(without_polls(system), plan), 2 * S * 1000, drawn_losses)
        for handle, responses in run.calls.items():
            played = [time * 1000 for time in seen.responses[handle]]
            assert first_difference(responses, played, tolerance=30_000) is None, (seed, handle, content)
            compared += len(responses)
        (executor,) = run.result.executors
        assert (executor.timeouts, executor.refusals) == (player.counts["timeouts"], player.counts["refused"]), seed
        lost += sum(each.lost for each in run.result.losses)
    assert compared > 20, "hardly anything was called"
    assert lost, "nothing was lost"
