"""Whatever is said about a random model, no play of it shows the contrary, and no limit that is broken in it is met.

`python -m opponent.hunt_models` with `tests` and `tools` on the path looks through more models, and writes the smallest ones that fail.
"""

import pytest
from effort import every
from opponent.generator import nested_model
from opponent.models.claims import MANY_VARIANTS, Tally, false_claims, refuted
from opponent.models.facts import facts_of
from opponent.models.generator import random_model, richer_model
from opponent.to_perf import read_system

from amalthea_uros.analyze.system import analyze_system

BLOCK = 100
#: Of the richer models, which take longer, the first ones.
MODELS = [(random_model, 1000), (nested_model, 1000), (richer_model, 500)]
#: The greatest share of unknown results that is acceptable in models with a construct.
MOST_UNKNOWN = 0.25


@pytest.mark.parametrize(
    ("make", "first"),
    [pytest.param(make, first, id=f"{make.__name__}-{first}") for make, count in MODELS for first in range(0, count, BLOCK)],
)
def test_nothing_false_is_said(make, first):
    tally, found = Tally(), {}
    for seed in every(BLOCK, range(first, first + BLOCK)):
        model = make(seed)
        if said := false_claims(model, tally):
            found[seed] = sorted(model.features), said[:5]
    assert found == {}
    assert tally.limits.total() > 0


def test_most_results_about_nested_systems_are_known_and_none_is_refuted():
    tally, found = Tally(), {}
    for seed in every(50, range(7, 1007)):
        model = nested_model(seed)
        analysis = analyze_system(read_system(model.text))
        for process in analysis.processes:
            tally.add(model.features, is_unknown=process.wcrt is None, ratio=None)
        for chain in analysis.chains:
            tally.add(model.features, is_unknown=not chain.values, ratio=None)
        # Some readings show what is suspicious, many of them whether it is false.
        if list(refuted(analysis, facts_of(model.text, plays=2, most=4))):
            found[seed] = list(refuted(analysis, facts_of(model.text, most=MANY_VARIANTS)))
    assert {seed: said for seed, said in found.items() if said} == {}
    assert {name: tally.unknown[name] for name, all_ in tally.claims.items() if tally.unknown[name] > MOST_UNKNOWN * all_} == {}
