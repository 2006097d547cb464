"""How the steps of an action grow with its input."""

import sys

SIZES = (50, 100, 200)


def steps(action, *arguments):
    """The number of lines of Python that an action executes, each as often as it is executed."""
    count = 0

    def trace(_frame, _event, _argument):
        nonlocal count
        count += 1
        return trace

    before = sys.gettrace()
    sys.settrace(trace)
    try:
        action(*arguments)
    finally:
        sys.settrace(before)
    return count


def growth(action, inputs):
    """How many times more steps the second doubling adds than the first one: 2 for a linear number, 4 for a square.

    Parameters
    ----------
    inputs : three of them, each twice as large as the one before
    """
    action(inputs[0])  # fills the caches that do not depend on the input
    small, medium, large = (steps(action, one) for one in inputs)
    return (large - medium) / (medium - small)
