"""A comparison with a measurement as Markdown."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.compare.results import Comparison
from amalthea_uros.report.compared import (
    BOUNDS,
    DISTRIBUTIONS,
    LIMITS,
    MISSING,
    PREDICTIONS,
    bound_cells,
    bound_tests,
    closing_line,
    distribution_rows,
    hidden,
    hidden_missing,
    limit_cells,
    missing_cells,
    missing_rows,
    prediction_cells,
    prediction_groups,
    subject_line,
)
from amalthea_uros.report.markdown_text import escaped, table


def lines(result: Comparison) -> Iterator[str]:
    """Whether the model holds, then the tables."""
    yield from (
        "# Comparison with a measurement",
        "",
        f"**{escaped(closing_line(result))}**",
        "",
        escaped(subject_line(result)),
    )
    sections = (
        ("Predictions", PREDICTIONS, [*map(prediction_cells, prediction_groups(result))], (2, 3, 4, 6, 7)),
        ("Bounds of the analysis", BOUNDS, [*map(bound_cells, bound_tests(result))], range(2, 7)),
        ("Distributions", DISTRIBUTIONS, [*distribution_rows(result)], range(2, 8)),
        ("Limits, as measured", LIMITS, [*map(limit_cells, result.limits)], (3, 4)),
        ("Not compared", MISSING, [*map(missing_cells, missing_rows(result))], ()),
    )
    for title, headings, rows, right in sections:
        if rows:
            yield from ("", f"## {title}", "")
            yield from table(headings, rows, right)
    for rest in filter(None, (hidden(result), hidden_missing(result))):
        yield from ("", escaped(rest))
    if result.assumptions:
        yield from ("", "## Assumptions", "")
        yield from (f"- {escaped(sentence)}" for sentence in result.assumptions)
