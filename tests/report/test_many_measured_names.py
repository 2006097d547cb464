"""A measurement of thousands of names is shown in steps that grow with their number only."""

from types import SimpleNamespace

from growth import SIZES, growth

from amalthea_uros.measure.series import Series
from amalthea_uros.report.documents.measurement import methods


class ComparedName(str):
    """A name that counts how often it is compared."""

    __slots__ = ()
    comparisons = 0

    def __eq__(self, other):
        ComparedName.comparisons += 1
        return str.__eq__(self, other)

    __hash__ = str.__hash__


def _measured(count):
    series = [
        Series(kind="process", name=ComparedName(f"Task_{n // 2}"), quantity="time", statistics=None, method="by events")
        for n in range(2 * count)
    ]
    return SimpleNamespace(series=series)


def test_what_was_measured_alike_is_found_without_comparing_every_name():
    assert list(methods(_measured(4))) == ["Task_0, Task_1, Task_2 and 1 more: by events"]
    assert growth(lambda measured: list(methods(measured)), [_measured(size) for size in SIZES]) < 2.2
    ComparedName.comparisons = 0
    list(methods(_measured(1000)))
    # Each name is compared once with the one that is found for it.
    assert ComparedName.comparisons <= 2 * 1000
