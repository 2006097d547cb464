"""A limit on the jitter of a chain decides what reports say of the chain."""

from support import ROOT

import amalthea_uros as amuros
from amalthea_uros.analyze.results.chains import LatencyQuantity
from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.report.documents.judged import decisive_quantity, limits_table, requirements_of

#: Reactions from 1.016 to 20.029 ms over all phases, which are met with a limit of 25 ms; of 15 ms of jitter, that is unknown.
TEXT = (ROOT / "samples" / "bodas-test-advanced.yaml").read_text().replace("reaction: 25 ms", "reaction: 25 ms, jitter: 15 ms")


def test_a_chain_is_not_met_if_its_jitter_is_unknown():
    analysis = amuros.analyze(TEXT)
    jitter, reaction = requirements_of("factor-to-output", analysis)
    assert (jitter.quantity, jitter.verdict) == ("reaction jitter", Verdict.UNKNOWN)
    assert (reaction.quantity, reaction.verdict) == ("reaction", Verdict.MET)
    assert decisive_quantity("factor-to-output", analysis) is LatencyQuantity.MAX_REDUCED_REACTION_TIME


def test_the_jitter_of_an_exact_latency_can_be_a_bound():
    rows = {row[2]: row[7] for row in limits_table(amuros.analyze(TEXT)).rows}
    assert rows["reaction of factor-to-output"] == "exact"
    assert rows["reaction jitter of factor-to-output"] == "bound"
