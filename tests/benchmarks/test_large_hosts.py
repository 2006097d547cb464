"""Hosts with hundreds of callbacks: the analysis takes about as many steps for each of them, whatever their number is."""

from growth import steps
from hosts import CHAINS, large_host

from amalthea_uros.analyze.system import analyze_system


def test_twice_the_callbacks_take_about_twice_the_steps():
    """What one callback is called at most while another one is pending is a question for each pair of an executor, so a bit more."""
    small, large = large_host(100), large_host(200)
    chains = analyze_system(small).chains  # what is imported or compiled once does not count
    assert len(chains) == CHAINS
    assert [chain.name for chain in chains if chain.worst is None] == []
    assert steps(lambda: analyze_system(large)) <= 2.5 * steps(lambda: analyze_system(small))
