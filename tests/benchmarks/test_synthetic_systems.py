"""The systems of the benchmarks have the sizes that their descriptions state, and can be analysed."""

from random import Random

import chains
import hosts
import response_times

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf import activities


def test_the_system_of_the_size_of_a_challenge():
    system = response_times.challenge_system(Random(1))
    runnables = system.software.runnables
    accesses = [item for runnable in runnables for item in runnable.activities if isinstance(item, activities.LabelAccess)]
    assert (len(system.software.tasks), len(runnables), len(accesses)) == (21, 1250, 15255)


def test_the_tasks_with_chains():
    tasks = chains.task_set(Random(1))
    result = analyze_system(chains.whole_system(tasks[:5], [[0, 1, 2]]))
    (chain,) = result.chains
    assert (chain.name, len(result.processes)) == ("C0", 5)


def test_the_host():
    system = hosts.large_host(60)
    assert (len(system.host.callbacks), len(system.host.executors), system.host.computers[0].cores) == (60, 8, 4)
    chains_of_host = analyze_system(system).chains
    assert len(chains_of_host) == 20
    assert all(chain.worst is not None for chain in chains_of_host)
