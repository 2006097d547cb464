"""Random words are those of Philox, and the arithmetic on them is exact."""

from hashlib import blake2b

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from amalthea_uros.simulate.sampling.quantile_table import tabulated
from amalthea_uros.simulate.sampling.words import RandomSource, scaled

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
