"""Random models with limits one unit inside of what occurs when an independent player plays them."""

from __future__ import annotations

import sys
from pathlib import Path
from random import Random

from templating import ROOT

from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.judge.verdict import Verdict
from fuzzing.commands import require

# The player is independent of the product, and lives with the tests that check it.
if str(ROOT / "tests") not in sys.path:
    sys.path.append(str(ROOT / "tests"))

from opponent.models.facts import facts_of
from opponent.models.generator import random_model
from opponent.models.limits import limits_of, with_limits
from opponent.models.reading import UnplayableError

#: What marks the limits that are broken; other limits are nobody's claim.
_MARK = "<!-- every limit is broken -->"


def make_model(rng: Random) -> bytes:
    """A model that breaks all of its limits; one without limits, if it cannot be played."""
    model = random_model(rng.randrange(10**9))
    try:
        facts = facts_of(model.text, model.delays)
    except UnplayableError:
        return model.told()[0].encode()
    return (with_limits(model.told()[0], facts, list(limits_of(facts))) + _MARK).encode()


def require_broken(path: Path, analysis: Analysis) -> None:
    """No limit of a model that breaks all of them is met."""
    if path.read_bytes().endswith(_MARK.encode()):
        met = [requirement.name for requirement in analysis.requirements if requirement.verdict is Verdict.MET]
        require(not met, f"limits that are broken are met: {met[:3]}")
