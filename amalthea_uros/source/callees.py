"""The function of the sources that a call calls."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence

from amalthea_uros.source.files import SourceFile
from amalthea_uros.source.program import CodeFunction


class Callees:
    """Functions by their names, classes and files, and by the number of their parameters, which distinguishes overloads."""

    def __init__(self, functions: Iterable[CodeFunction]) -> None:
        self._found: dict[tuple[str | int | None, ...], list[CodeFunction]] = defaultdict(list)
        for function in functions:
            for around in (None, id(function.file), *filter(None, [function.owner])):
                for number in (None, len(function.parameters)):
                    self._found[function.name, around, number].append(function)

    def of(self, name: str, number: int, owners: Sequence[str], file: SourceFile) -> CodeFunction | None:
        """The function of the first class that has one of a name, else that of the same file, else the only one.

        Parameters
        ----------
        number : of arguments
        owners : classes; "" for none
        file : where the call is
        """
        for around in (*filter(None, owners), id(file), None):
            close = self._found.get((name, around, None), ())
            if len(close) > 1:
                close = self._found.get((name, around, number), ())
            if len(close) == 1:
                return close[0]
        return None
