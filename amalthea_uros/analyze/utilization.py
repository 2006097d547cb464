"""The load up to which tasks meet their deadlines without a closer look.

C. L. Liu and J. W. Layland, "Scheduling algorithms for multiprogramming in a hard-real-time environment", Journal of the ACM 20(1),
1973, theorem 5.
"""

from __future__ import annotations


def liu_layland(count: int) -> float:
    """The load up to which so many tasks under rate-monotonic priorities always end within their periods."""
    return count * (2 ** (1 / count) - 1)
