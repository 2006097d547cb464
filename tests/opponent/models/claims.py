"""What the product says about a model, against what occurs in plays of it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from tempfile import TemporaryDirectory

from fuzzing.contradictions import contradictions
from opponent.models.facts import MOST_VARIANTS, Facts, facts_of, horizon, is_random
from opponent.models.generator import RandomModel
from opponent.models.limits import Limit, limits_of, loose_limits_of, with_limits
from opponent.models.reading import UnplayableError

from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.results.chains import ChainResult
from amalthea_uros.analyze.results.processes import ProcessResult, RequirementResult
from amalthea_uros.errors import AmurosError
from amalthea_uros.judge.verdict import ObservedVerdict, Verdict
from amalthea_uros.services.analyze import analyze_files
from amalthea_uros.services.simulate import simulate_files
from amalthea_uros.simulate.observations import RequirementObservation
from amalthea_uros.simulate.options import Mode, Options
from amalthea_uros.simulate.results import Simulation
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.timing.response import Claim
from amalthea_uros.units import Duration

#: How many readings confirm a suspicion.
MANY_VARIANTS = 64

#: The runs that are compared: how values are chosen, and the seed.
RUNS = ((Mode.WORST, 1), (Mode.BEST, 1), (Mode.SAMPLED, 1), (Mode.SAMPLED, 2))


@dataclass(slots=True)
class Tally:
    """What was examined, by construct."""

    models: int = 0
    unplayable: Counter[str] = field(default_factory=Counter)
    claims: Counter[str] = field(default_factory=Counter)
    unknown: Counter[str] = field(default_factory=Counter)
    limits: Counter[str] = field(default_factory=Counter)
    kinds: Counter[str] = field(default_factory=Counter)
    ratios: dict[str, list[float]] = field(default_factory=dict)

    def add_all(self, other: Tally) -> None:
        """What was examined elsewhere."""
        self.models += other.models
        self.unplayable += other.unplayable
        self.claims += other.claims
        self.unknown += other.unknown
        self.limits += other.limits
        self.kinds += other.kinds
        for name, found in other.ratios.items():
            self.ratios.setdefault(name, []).extend(found)

    def add(self, names: Iterable[str], *, is_unknown: bool, ratio: float | None) -> None:
        """One more process or chain."""
        for name in names:
            self.claims[name] += 1
            self.unknown[name] += is_unknown
            if ratio is not None:
                self.ratios.setdefault(name, []).append(ratio)


def false_claims(model: RandomModel, tally: Tally | None = None, most: int = MOST_VARIANTS) -> list[str]:
    """Whatever the product says falsely of a model with limits that it breaks; unplayable ones are left out.

    Some readings show what is suspicious, many of them whether it is false.
    """
    tally = Tally() if tally is None else tally
    try:
        facts = facts_of(model.text, model.delays, model.constraints, most=most)
    except UnplayableError as error:
        tally.unplayable[str(error)] += 1
        return []
    limits = list(limits_of(facts))
    with TemporaryDirectory() as folder:
        path = Path(folder) / "model.amxmi"
        text, features = model.told()
        path.write_text(with_limits(text, facts, limits), encoding="utf-8")
        is_told = text == model.text
        if "no priority" in features:
            facts, limits = _without_lateness(facts), [each for each in limits if "lateness" not in each.key]
        found = wrong_answers(path, facts, limits, tally, features, is_told=is_told)
        if is_told and model.constraints and is_determined(facts):
            path.write_text(with_limits(text, facts, list(loose_limits_of(facts))), encoding="utf-8")
            tally.kinds["simulated with limits that are kept"] += 1
            found += falsely_missed(path, facts)
    if found and not facts.is_complete and most < MANY_VARIANTS:
        return false_claims(model, most=MANY_VARIANTS)
    return found


def _without_lateness(facts: Facts) -> Facts:
    """A process whose deadline is erased has the response time that is required of it as its deadline."""
    least, greatest = (
        {key: value for key, value in found.items() if "lateness" not in key} for found in (facts.least, facts.greatest)
    )
    return replace(facts, least=least, greatest=greatest)


def falsely_missed(path: Path, facts: Facts) -> list[str]:
    """Limits that all plays keep, and a simulation of the same time does not."""
    try:
        simulation = simulate_files(path, Options(duration=Duration(_duration(facts)), seed=1, mode=Mode.WORST)).simulation
    except AmurosError:
        return []
    by_name = {limit.name: limit for limit in loose_limits_of(facts)}
    return [
        f"simulated: {each.name}: limit {each.limit} missed by {each.value} {each.reason}, but {by_name[each.name].observed} occurs"
        for each in simulation.requirements
        if each.verdict is ObservedVerdict.MISSED and each.name in by_name
    ]


def wrong_answers(
    path: Path, facts: Facts, limits: list[Limit], tally: Tally, features: frozenset[str], *, is_told: bool = True
) -> list[str]:
    """What analysis and simulation of a file say falsely; `is_told`: it says all that was played."""
    try:
        analysis = analyze_files(path).analysis
    except AmurosError:
        raise
    except Exception as error:  # whatever it is, it is a finding
        return [f"analysis: {error!r}"]
    tally.models += 1
    count(analysis, facts, tally, features)
    found = [*refuted(analysis, facts), *falsely_met(analysis, limits, tally)]
    for mode, seed in RUNS:
        try:
            options = Options(duration=Duration(_duration(facts)), seed=seed, mode=mode)
            simulation = simulate_files(path, options).simulation
        except AmurosError:
            continue
        except Exception as error:  # whatever it is, it is a finding
            return [*found, f"simulation: {error!r}"]
        found += [f"simulated {mode} {seed}: {text}" for text in contradictions(analysis, simulation)]
        if mode is Mode.WORST and is_told and is_determined(facts):
            found += [f"simulated: {text}" for text in played_otherwise(simulation, facts)]
            found += [f"simulated: {text}" for text in falsely_kept(simulation, limits)]
    return found


def _duration(facts: Facts) -> int:
    return horizon(facts.played)


def count(analysis: Analysis, facts: Facts, tally: Tally, features: frozenset[str]) -> None:
    """Claims, unknowns, and how far above what occurs they are."""
    for process in analysis.processes:
        worst, occurs = process.wcrt, facts.greatest.get(("process", process.name, "response_time"))
        ratio = occurs / worst if worst and occurs is not None else None
        tally.add(features, is_unknown=worst is None, ratio=ratio)
    for chain in analysis.chains:
        tally.add((f"{name}/chain" for name in features), is_unknown=not chain.values, ratio=_chain_ratio(chain, facts))


def _chain_ratio(chain: ChainResult, facts: Facts) -> float | None:
    for value in chain.values:
        occurs = facts.greatest.get(("chain", chain.name, value.quantity.value))
        if value.quantity.value == "max_reaction_time" and value.value and occurs:
            return float(occurs / value.value)
    return None


def refuted(analysis: Analysis, facts: Facts) -> Iterator[str]:
    """Bounds that what occurs is beyond."""
    for process in analysis.processes:
        yield from _refuted_process(process, facts)
    for chain in analysis.chains:
        for value in chain.all_values:
            key = ("chain", chain.name, value.quantity.value)
            occurs = (facts.greatest if value.quantity.is_upper else facts.least).get(key)
            if value.value is None or occurs is None or value.quantity.is_mean:
                continue
            is_beyond = value.value < occurs if value.quantity.is_upper else value.value > occurs
            if is_beyond or (value.claim is Claim.EXACT and key in facts.determined and value.value != occurs):
                yield f"{chain.name}: {value.quantity} {value.value} ({value.claim} by {value.method}), but {occurs} occurs"


def _refuted_process(process: ProcessResult, facts: Facts) -> Iterator[str]:
    bounds = {name.value: (metric.min, metric.max, "metric") for name, metric in process.metrics.items()}
    if process.response is not None:
        response = process.response
        bounds[JobMetric.RESPONSE_TIME.value] = (response.best, response.worst, f"{response.claim} by {response.method}")
    for quantity, (least, most, how) in bounds.items():
        key = ("process", process.name, quantity)
        if most is not None and most < facts.greatest.get(key, most):
            yield f"{process.name}: {quantity} at most {most} ({how}), but {facts.greatest[key]} occurs"
        if least is not None and least > facts.least.get(key, least):
            yield f"{process.name}: {quantity} at least {least} ({how}), but {facts.least[key]} occurs"
    key = ("process", process.name, "response_time")
    if process.response is not None and process.response.claim is Claim.EXACT and key in facts.determined:
        claimed, occurs = (process.response.best, process.response.worst), (facts.least[key], facts.greatest[key])
        if process.response.worst is not None and claimed != occurs:
            yield f"{process.name}: response_time exactly {claimed} by {process.response.method}, but {occurs} occurs"


def falsely_met(analysis: Analysis, limits: Iterable[Limit], tally: Tally) -> Iterator[str]:
    """Limits inside of what occurs that are said to be met."""
    by_name = {limit.name: limit for limit in limits}
    results: dict[str, list[RequirementResult]] = {}
    for requirement in analysis.requirements:
        results.setdefault(requirement.name, []).append(requirement)
    for requirement in analysis.requirements:
        limit = by_name.get(requirement.name.removesuffix(" repetition"))
        if limit is None:
            continue
        words = limit.key[1].split() if limit.key[0] == "constraint" else []
        kind = " ".join([limit.key[0], *(word for word in words if word.isalpha())])
        tally.limits[str(requirement.verdict)] += 1
        tally.kinds[f"{kind}: {requirement.verdict}"] += 1
        # A constraint is met if all that is said about it is.
        if all(each.verdict is Verdict.MET for each in results[requirement.name]):
            bounds = f"[{requirement.lower}, {requirement.upper}]"
            yield f"{requirement.name}: limit {limit.limit} met by {bounds}, but {limit.observed} occurs"


def falsely_kept(simulation: Simulation, limits: Iterable[Limit]) -> Iterator[str]:
    """Limits that no play keeps, and a simulation says that it did."""
    by_name = {limit.name: limit for limit in limits if limit.key[0] == "constraint"}
    results: dict[str, list[RequirementObservation]] = {}
    for requirement in simulation.requirements:
        results.setdefault(requirement.name, []).append(requirement)
    for name, limit in by_name.items():
        if name in results and all(each.verdict is ObservedVerdict.OK for each in results[name]):
            yield f"{name}: limit {limit.limit} kept with {results[name][0].value}, but {limit.observed} occurs"


def is_determined(facts: Facts) -> bool:
    """Whether nothing is left to chance, and all readings were played."""
    return facts.is_complete and not facts.lost and not is_random(facts.played)


def played_otherwise(simulation: Simulation, facts: Facts) -> Iterator[str]:
    """Where the response times of a simulation are not between those of the plays; without some processes, they are no results."""
    for process in () if simulation.left_out else simulation.processes:
        spread, times = facts.spread.get(("process", process.name, "response_time")), process.response_time
        if times is None or spread is None:
            continue
        if times.min < spread[0] or times.max > spread[1]:
            yield f"{process.name} responds in {times.min} to {times.max}, played in {spread[0]} to {spread[1]}"
