"""Random words are those of Philox; sampled values are within the bounds, with the stated mean and the shape of the distribution."""

from fractions import Fraction
from hashlib import blake2b
from math import asin, erf, exp, gamma, log, pi, sqrt

import numpy as np
import pytest
from effort import examples
from hypothesis import assume, given
from hypothesis import strategies as st

from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.distributions import (
    Beta,
    Boundaries,
    Bucket,
    Constant,
    Gauss,
    Histogram,
    Sampling,
    Statistics,
    Uniform,
    Weibull,
    highest,
    lowest,
)
from amalthea_uros.simulate.options import Mode
from amalthea_uros.simulate.sampling.streams import choices, durations, permutations, values
from amalthea_uros.simulate.sampling.variates import sampling_assumption, variate
from amalthea_uros.simulate.sampling.words import RandomSource, scaled, tabulated
from amalthea_uros.timing.demand.means import mean

#: Bounds so far apart that rounding to whole numbers does not matter.
WIDE = 10**9
#: Words at equal distances: their values have the distribution with hardly any deviation.
EQUIDISTANT = (np.arange(20_000, dtype=np.uint64) * 2 + 1) * np.uint64(2**63 // 20_000)


def source(place="somewhere"):
    return RandomSource(1, place)


def normal(x):
    return (1 + erf(x / sqrt(2))) / 2


def weibull(shape, limit):
    """Weibull distribution with the scale 1, truncated at a limit."""
    return lambda x: (1 - exp(-((x * limit) ** shape))) / (1 - exp(-(limit**shape)))


def weibull_distribution(shape, exceeding):
    """The estimators of a Weibull distribution with a shape."""
    limit = log(1 / exceeding) ** (1 / shape)
    average = gamma(1 + 1 / shape) / limit
    return Weibull(lower=0, upper=WIDE, average=average * WIDE, exceeding=exceeding * 1000)


def boundaries(sampling):
    return Boundaries(lower=0, upper=WIDE, sampling=sampling)


#: Distributions between 0 and `WIDE`, and the probability that a value is at most a part of that.
SHAPES = {
    "uniform": (Uniform(lower=0, upper=WIDE), lambda x: x),
    "default sampling": (boundaries(Sampling.DEFAULT), lambda x: x),
    "uniform sampling": (boundaries(Sampling.UNIFORM), lambda x: x),
    # Beta(a, 1) is x**a.
    "best case": (boundaries(Sampling.BEST_CASE), lambda x: x**0.2),
    "worst case": (boundaries(Sampling.WORST_CASE), lambda x: 1 - (1 - x) ** 0.2),
    "average case": (boundaries(Sampling.AVERAGE_CASE), lambda x: 3 * x**2 - 2 * x**3),
    "arcsine": (Beta(alpha=0.5, beta=0.5, lower=0, upper=WIDE), lambda x: 2 / pi * asin(sqrt(x))),
    "beta of integers": (Beta(alpha=1, beta=50, lower=0, upper=WIDE), lambda x: 1 - (1 - x) ** 50),
    "normal": (
        Gauss(mean=WIDE / 4, deviation=WIDE / 2, lower=0, upper=WIDE),
        lambda x: (normal(2 * x - 0.5) - normal(-0.5)) / (normal(1.5) - normal(-0.5)),
    ),
    "narrow normal": (
        Gauss(mean=WIDE / 2, deviation=WIDE / 100, lower=0, upper=WIDE),
        lambda x: normal(100 * x - 50),
    ),
    # Far outside of its bounds, a normal distribution is nearly exponential with the rate distance / deviation**2.
    "tail of a normal": (
        Gauss(mean=-1000 * WIDE, deviation=10 * WIDE, lower=0, upper=WIDE),
        lambda x: (1 - exp(-(1000 * x + x * x / 2) / 100)) / (1 - exp(-10.005)),
    ),
    "exponential": (weibull_distribution(1, 0.001), weibull(1, log(1000))),
    "weibull": (weibull_distribution(2.5, 0.05), weibull(2.5, log(20) ** 0.4)),
}


@pytest.mark.parametrize("shape", SHAPES)
def test_the_values_have_the_distribution(shape):
    distribution, probability = SHAPES[shape]
    # Values that are rounded down and up at random are hardly moved.
    found = np.sort(variate(distribution).of(EQUIDISTANT)) / WIDE
    some = slice(None, None, 10)
    found, shares = found[some], ((np.arange(len(found)) + 0.5) / len(found))[some]
    expected = np.array([probability(x) for x in found])
    # Where the density is infinite, the resolution of the values moves many of them to the same one.
    inside = (found > 1e-5) & (found < 1 - 1e-5)
    assert expected[inside] == pytest.approx(shares[inside], abs=2e-4)


def test_corner_cases_are_symmetric_and_mostly_at_the_ends():
    found = variate(boundaries(Sampling.CORNER_CASE)).of(EQUIDISTANT) / WIDE
    assert np.mean(found) == pytest.approx(0.5, abs=1e-4)
    # The variance of Beta(a, a) is 1 / (4 (2 a + 1)).
    assert np.var(found) == pytest.approx(1 / (4 * 1.4), rel=1e-4)


BOUNDS = st.tuples(st.integers(-(10**18), 10**18), st.integers(0, 10**18)).map(lambda pair: (pair[0], pair[0] + pair[1]))
SMALL_BOUNDS = st.tuples(st.integers(-3, 30), st.integers(0, 9)).map(lambda pair: (pair[0], pair[0] + pair[1]))
#: No Weibull distribution is wider.
SHARES = st.floats(0.1, 0.95)


def between(cls, average=False, **others):
    @st.composite
    def build(draw):
        lower, upper = draw(st.one_of(BOUNDS, SMALL_BOUNDS))
        more = {name: draw(strategy) for name, strategy in others.items()}
        if average:
            more["average"] = lower + (upper - lower) * draw(SHARES)
            assume(lower < more["average"] < upper)
        return cls(lower=lower, upper=upper, **more)

    return build()


DISTRIBUTIONS = st.one_of(
    st.builds(Constant, st.integers(-(10**18), 10**18)),
    between(Uniform),
    between(Boundaries, sampling=st.sampled_from(Sampling)),
    between(Statistics, average=True),
    between(Weibull, average=True, exceeding=st.floats(0.1, 10)),
    between(Beta, alpha=st.floats(1e-3, 1e3), beta=st.floats(1e-3, 1e3)),
    between(Gauss, mean=st.floats(-1e18, 1e18), deviation=st.floats(0, 1e17)),
    between(Gauss, mean=st.floats(-10, 10), deviation=st.floats(0, 10)),
    st.lists(between(Bucket, occurrences=st.integers(1, 5)), min_size=1, max_size=4).map(lambda b: Histogram(tuple(b))),
)


@given(DISTRIBUTIONS)
def test_values_are_within_the_bounds(distribution):
    stream = values(distribution, Mode.SAMPLED, source())
    found = [*stream.take(50).tolist(), *variate(distribution).of(np.array([0, 2**64 - 1], np.uint64)).tolist()]
    assert lowest(distribution) <= stream.lowest <= min(found)
    assert max(found) <= stream.highest <= highest(distribution)


@examples(30)
@given(st.one_of(between(Statistics, average=True), between(Beta, alpha=st.floats(0.1, 10), beta=st.floats(0.1, 10))))
def test_the_mean_is_the_stated_one_even_of_small_numbers(distribution):
    found = variate(distribution).of(source().words(20_000)) - lowest(distribution)
    expected = float(mean(distribution) - lowest(distribution))
    assert np.mean(found) == pytest.approx(expected, abs=5 * np.std(found) / sqrt(20_000) + 1e-3)


@pytest.mark.parametrize("average", [11, 10.001, 999, 500])
def test_an_average_close_to_a_bound_is_kept(average):
    found = variate(Statistics(lower=10, average=average, upper=1000)).of(source().words(100_000))
    assert np.mean(found) == pytest.approx(average, abs=5 * np.std(found) / sqrt(100_000))


def test_all_numbers_between_two_are_equally_probable():
    assert np.bincount(variate(Uniform(lower=0, upper=9)).of(EQUIDISTANT)).tolist() == [2000] * 10


def test_an_interval_of_a_histogram_is_as_probable_as_it_was_frequent():
    histogram = Histogram(
        (
            Bucket(lower=0, upper=1, occurrences=6),
            Bucket(lower=1, upper=1, occurrences=3),
            Bucket(lower=5, upper=5, occurrences=1),
        )
    )
    assert np.bincount(variate(histogram).of(EQUIDISTANT)).tolist() == [6000, 12000, 0, 0, 0, 2000]


def test_a_normal_distribution_without_bounds_is_cut_off_where_nothing_is_left():
    unbounded = variate(Gauss(mean=0.0, deviation=1000.0))
    assert -6400 < unbounded.lowest < -6000
    assert 6000 < unbounded.highest < 6400
    found = unbounded.of(EQUIDISTANT)
    assert np.std(found) == pytest.approx(1000, rel=1e-3)


@given(DISTRIBUTIONS, st.sampled_from(Mode), st.lists(st.integers(0, 40), max_size=6))
def test_values_do_not_depend_on_how_many_are_taken_at_a_time(distribution, mode, counts):
    whole = values(distribution, mode, source()).take(sum(counts))
    stream = values(distribution, mode, source())
    parts = [value for count in counts for value in stream.take(count).tolist()]
    assert parts == whole.tolist()


def test_places_and_seeds_have_independent_values():
    distribution = Uniform(lower=0, upper=10**9)
    found = [
        values(distribution, Mode.SAMPLED, RandomSource(seed, place)).take(1000)
        for seed, place in [(1, "a"), (1, "b"), (2, "a")]
    ]
    assert np.abs(np.corrcoef(found) - np.eye(3)).max() < 0.15


@given(DISTRIBUTIONS)
def test_the_other_modes_take_one_value(distribution):
    found = {mode: set(values(distribution, mode, source()).take(3).tolist()) for mode in Mode if mode is not Mode.SAMPLED}
    assert found[Mode.WORST] == {highest(distribution)}
    assert found[Mode.BEST] == {lowest(distribution)}
    assert found[Mode.AVERAGE] == {round(mean(distribution))}


@given(
    st.integers(0, 10**9),
    st.integers(0, 10**9),
    st.one_of(st.integers(1, 10**6).map(Fraction), st.fractions(Fraction(1, 10**6), 10**6)),
)
def test_ticks_are_converted_and_rounded(lower, more, per_unit):
    ticks = Uniform(lower=lower, upper=lower + more)
    sampled = values(ticks, Mode.SAMPLED, source()).take(20)
    found = durations(ticks, per_unit, Mode.SAMPLED, source()).take(20)
    exact = [int(value) * per_unit for value in sampled]
    assert all(
        abs(value - time) <= Fraction(1, 2) + Fraction(1, 2**30) for value, time in zip(found.tolist(), exact, strict=True)
    )
    assert durations(ticks, per_unit, Mode.WORST, source()).take(1) == -(-ticks.upper * per_unit // 1)
    assert durations(ticks, per_unit, Mode.BEST, source()).take(1) == ticks.lower * per_unit // 1


@pytest.mark.parametrize("deviation", [0.0, 5e-324, 1e-6])
def test_hardly_any_deviation_gives_the_mean_or_the_bound_next_to_it(deviation):
    assert set(variate(Gauss(mean=7.0, deviation=deviation)).of(EQUIDISTANT)) == {7}
    assert set(variate(Gauss(mean=7.0, deviation=deviation, lower=9, upper=20)).of(EQUIDISTANT)) == {9}


def test_a_demand_without_minimum_is_not_negative():
    demand = Gauss(mean=10.0, deviation=100.0)
    assert durations(demand, Fraction(2), Mode.SAMPLED, source()).take(1000).min() >= 0
    assert durations(demand, Fraction(2), Mode.BEST, source()).take(1) == 0


def test_branches_are_taken_in_proportion_to_their_weights():
    stream = choices([1, 0, 0.5, Fraction(5, 2), 0], Mode.SAMPLED, Equidistant())
    assert np.bincount(stream.take(20_000)).tolist() == [5000, 0, 2500, 12_500]


class Equidistant:
    def words(self, _count):
        return EQUIDISTANT


def test_without_sampling_the_most_probable_branch_is_taken():
    for mode in (Mode.WORST, Mode.BEST, Mode.AVERAGE):
        assert choices([1, 2, 2], mode, source()).take(3).tolist() == [1, 1, 1]


def test_orders_are_random_in_all_modes():
    found = permutations(source()).take(1000)
    assert found.min() >= 0
    assert len(set(found.tolist())) == 1000


@pytest.mark.parametrize(
    ("distribution", "text"),
    [
        (Uniform(lower=2, upper=1), "minimum of a distribution is greater"),
        (Boundaries(lower=2, upper=1), "minimum of a distribution is greater"),
        (Gauss(mean=1.0, deviation=1.0, lower=2, upper=1), "minimum of a distribution is greater"),
        (Statistics(lower=0, average=3, upper=2), "average"),
        (Statistics(lower=0, average=float("nan"), upper=2), "average"),
        (Weibull(lower=0, average=3, upper=2), "average"),
        (Weibull(lower=0, average=0, upper=2), "average"),
        (Weibull(lower=0, average=1, upper=2, exceeding=0.0), "probability"),
        (Weibull(lower=0, average=1, upper=2, exceeding=1000.0), "probability"),
        (Weibull(lower=0, average=1, upper=10**6), "no Weibull distribution"),
        (Gauss(mean=float("inf"), deviation=1.0), "normal"),
        (Gauss(mean=0.0, deviation=-1.0), "normal"),
        (Beta(alpha=0.0, beta=1.0, lower=0, upper=1), "beta"),
        (Beta(alpha=1.0, beta=float("nan"), lower=0, upper=1), "beta"),
        (Histogram(()), "histogram"),
        (Histogram((Bucket(lower=0, upper=1, occurrences=-1),)), "histogram"),
        (Constant(2**70), "out of range"),
    ],
)
def test_contradictory_parameters_are_refused(distribution, text):
    with pytest.raises(UnknownError, match=text):
        values(distribution, Mode.SAMPLED, source())


def test_demands_that_cannot_be_are_refused():
    with pytest.raises(UnknownError, match="negative"):
        durations(Uniform(lower=-1, upper=1), Fraction(1), Mode.SAMPLED, source())
    with pytest.raises(UnknownError, match="exceeds the supported range"):
        durations(Constant(2**60), Fraction(100), Mode.SAMPLED, source())
    with pytest.raises(UnknownError, match="no maximum"):
        durations(Gauss(mean=1.0, deviation=1.0), Fraction(1), Mode.WORST, source())


@pytest.mark.parametrize("weights", [[0, 0], [-1, 2], [float("nan")], []])
def test_invalid_weights_are_refused(weights):
    with pytest.raises(UnknownError, match="branch"):
        choices(weights, Mode.SAMPLED, source())


def test_what_is_not_specified_is_an_assumption():
    assert "equally probable" in sampling_assumption(Boundaries(lower=0, upper=1))
    assert "truncated normal" in sampling_assumption(Statistics(lower=0, average=1, upper=2))
    assert "standard deviations" in sampling_assumption(Gauss(mean=0.0, deviation=1.0))
    assert sampling_assumption(Uniform(lower=0, upper=1)) is None
    assert sampling_assumption(Boundaries(lower=1, upper=1)) is None


# Random words are those of Philox, and the arithmetic on them is exact.


MASK = 2**64 - 1
WORDS = st.integers(0, MASK)


def philox(counter, key):
    """Philox 4x64 with 10 rounds, after Salmon et al., section 3.3."""
    c0, c1, c2, c3 = counter
    k0, k1 = key
    for _ in range(10):
        high0, low0 = divmod(0xD2E7470EE14C6C93 * c0, 2**64)
        high1, low1 = divmod(0xCA5A826395121157 * c2, 2**64)
        c0, c1, c2, c3 = high1 ^ c1 ^ k0, low1, high0 ^ c3 ^ k1, low0
        k0, k1 = (k0 + 0x9E3779B97F4A7C15) & MASK, (k1 + 0xBB67AE8584CAA73B) & MASK
    return [c0, c1, c2, c3]


def test_the_reference_gives_the_published_answer():
    # Known answers of the library Random123.
    assert philox((0, 0, 0, 0), (0, 0)) == [0x16554D9ECA36314C, 0xDB20FE9D672D0FDC, 0xD7E772CEE186176B, 0x7E68B68AEC7BA23B]


@pytest.mark.parametrize(("seed", "place"), [(1, "stimulus timer"), (2**70, "stimulus timer"), (1, "µ")])
def test_words_are_those_of_the_cipher(seed, place):
    digest = blake2b(f"{seed} {place}".encode(), digest_size=16).digest()
    key = (int.from_bytes(digest[:8], "little"), int.from_bytes(digest[8:], "little"))
    expected = [word for number in range(1, 5) for word in philox((number, 0, 0, 0), key)]
    assert RandomSource(seed, place).words(16).tolist() == expected


def test_words_do_not_depend_on_how_many_are_taken_at_a_time():
    source = RandomSource(1, "a")
    parts = np.concatenate([source.words(count) for count in (0, 1, 2, 5, 13, 79)])
    assert parts.tolist() == RandomSource(1, "a").words(100).tolist()


@given(st.lists(WORDS, min_size=1, max_size=5), WORDS)
def test_a_product_with_a_fraction_is_rounded_down(words, factor):
    fractions = np.array(words, np.uint64)
    expected = [word * factor >> 64 for word in words]
    assert scaled(fractions, factor).tolist() == expected
    assert scaled(fractions, np.full(len(words), factor, np.uint64)).tolist() == expected


@given(WORDS, st.integers(0, 2**32 - 1), st.integers(0, 2**32 - 1))
def test_dither_rounds_up_where_the_fraction_is_large_enough(word, factor, dither):
    found = int(scaled(np.array([word], np.uint64), factor, np.array([dither], np.uint64))[0])
    assert found == ((word * factor >> 32) + dither) >> 32


@given(st.integers(1, 2**32 - 1), st.data())
def test_equal_parts_of_all_words_give_each_value(span, data):
    # The words from value * 2**64 / span on, rounded up, give that value.
    value = data.draw(st.integers(0, span - 1))
    first, last = -(-value * 2**64 // span), -(-(value + 1) * 2**64 // span) - 1
    assert scaled(np.array([first, last], np.uint64), span).tolist() == [value, value]


@given(st.lists(WORDS, min_size=1))
def test_the_table_of_the_identity_keeps_its_28_bits_and_is_monotonic(words):
    table = tabulated(lambda p: p)
    ordered = np.sort(np.array(words, np.uint64))
    found = table.fractions(ordered)
    assert all(abs(int(a) - int(b)) <= 2**36 for a, b in zip(found, ordered, strict=True))
    assert (np.diff(found.astype(object)) >= 0).all()


def test_the_last_bits_of_a_quantile_function_do_not_matter():
    def quantiles(p):
        return -np.log1p(-p * 0.999) / 7

    def other_machine(p):
        return np.nextafter(quantiles(p), np.where(p * 2**20 % 2 < 1, 0, 1))

    words = RandomSource(1, "words").words(10_000)
    assert (tabulated(quantiles).fractions(words) == tabulated(other_machine).fractions(words)).all()
