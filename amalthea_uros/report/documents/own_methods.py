"""Bounds of the methods of users, as a document."""

from __future__ import annotations

from typing import TYPE_CHECKING

from amalthea_uros.report.basics.document import ResultDocument, Sentences, document, section, table
from amalthea_uros.report.wording.cells import at_most, words

if TYPE_CHECKING:
    from amalthea_uros.services.own_methods import MethodBounds


def methods_document(result: MethodBounds) -> ResultDocument:
    """Each bound beside the tightest one of the analysis."""
    rows = [
        (
            row.method,
            row.object,
            words(row.quantity),
            at_most(row.value),
            at_most(row.analyzed),
            str(row.claim or ""),
            str(row.standing),
        )
        for row in result.rows
    ]
    note = "No verdict follows from methods of users: nothing checks that their values are bounds."
    headings = ("method", "object", "quantity", ">bound", ">analysis", "claim", "comparison")
    return document((section("Methods of users", table("", headings, rows), Sentences([note])),))
