"""When stimuli occur, as far as time decides that; in picoseconds, in order."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import count, takewhile

from opponent.models.reading import Stimulus, UnplayableError
from opponent.models.variants import Choices

#: Kinds that others fire.
FIRED = {"InterProcess", "Event"}


def occurrences(stimulus: Stimulus, choices: Choices, until: int) -> list[int]:
    """The occurrences before a time."""
    if stimulus.kind in FIRED:
        return []
    known = {
        "Single": _single,
        "Periodic": _periodic,
        "RelativePeriodic": _sporadic,
        "PeriodicSynthetic": _synthetic,
        "PeriodicBurst": _bursts,
        "ArrivalCurve": _curve,
        "VariableRate": _rate,
    }
    if stimulus.kind not in known:
        raise UnplayableError(f"stimuli of the kind {stimulus.kind}")
    return list(takewhile(lambda time: time < until, known[stimulus.kind](stimulus, choices)))


def _single(stimulus: Stimulus, _choices: Choices) -> Iterator[int]:
    yield stimulus.given.get("occurrence", 0)


def _periodic(stimulus: Stimulus, choices: Choices) -> Iterator[int]:
    given, last = stimulus.given, None
    least, most = given.get("jitter", (0, 0))
    if least < 0:
        raise UnplayableError("times before zero")
    style = choices.rng.choice(("as they come", "first late"))
    for number in count():
        nominal = given.get("offset", 0) + number * given["recurrence"]
        late = choices.between(least, most) if style == "as they come" else (most, least)[min(number % 4, 1)]
        time = nominal + late
        if last is not None:
            time = max(time, last + given.get("minDistance", 0))
        if time > nominal + most:
            raise UnplayableError("jitter without room for the minimum distance")
        last = time
        yield time


def _sporadic(stimulus: Stimulus, choices: Choices) -> Iterator[int]:
    least, most = stimulus.given["distance"]
    time = stimulus.given.get("offset", 0)
    while True:
        yield time
        time += choices.between(least, most, early=True)


def _synthetic(stimulus: Stimulus, _choices: Choices) -> Iterator[int]:
    times = stimulus.given["times"]
    if sorted(times) != times or times[-1] >= times[0] + stimulus.given["recurrence"]:
        raise UnplayableError("times that are not in order")
    for number in count():
        start = stimulus.given.get("offset", 0) + number * stimulus.given["recurrence"]
        yield from (start + time for time in times)


def _bursts(stimulus: Stimulus, _choices: Choices) -> Iterator[int]:
    given = stimulus.given
    distance, length = given.get("occurrenceMinDistance", 0), given.get("burstLength", 0)
    if given["count"] * distance > given["recurrence"]:
        raise UnplayableError("bursts that overlap")
    if any(number * distance == length for number in range(1, given["count"])):
        raise UnplayableError("an occurrence at the end of a burst")
    for number in count():
        start = given.get("offset", 0) + number * given["recurrence"]
        yield from (start + n * distance for n in range(given["count"]) if n * distance <= length)


def _curve(stimulus: Stimulus, choices: Choices) -> Iterator[int]:
    curve, found = stimulus.given["curve"], [0]
    most = max(number for number, _, _ in curve)
    spread = max(lower for _, lower, _ in curve)
    while True:
        yield found[-1]
        past = len(found)
        earliest = max((found[past - n + 1] + lower for n, lower, _ in curve if past >= n - 1), default=found[-1])
        latest = min(
            (found[past - n + 1] + upper for n, _, upper in curve if upper is not None and past >= n - 1), default=None
        )
        if latest is not None and latest < earliest:
            raise UnplayableError("a curve without room")
        end = earliest + spread if latest is None else latest
        found.append(choices.between(max(earliest, found[-1]), end, early=True) if choices.style != "worst" else earliest)
        del found[: max(0, len(found) - most - 1)]


def _rate(stimulus: Stimulus, choices: Choices) -> Iterator[int]:
    """Occurrences at equal distances, which is one of the ways to have a rate."""
    least, most = stimulus.given["rate"]
    rate = {"worst": most, "best": least}.get(choices.style, choices.rng.uniform(least, most))
    if rate <= 0:
        return
    distance = -int(-stimulus.given["step"] // rate)
    yield from (number * distance for number in count(1))
