"""Results as tables: records, data frames, and what notebooks display.

The rooms that hold results do not know the room that shows them, so the public package connects the two when it is imported.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Protocol, TypeAlias

if TYPE_CHECKING:
    import pandas as pd

#: A value of a table; times are whole picoseconds, in columns whose names end with `_ps`.
Cell: TypeAlias = str | int | float | bool | None
Record: TypeAlias = dict[str, Cell]


class Shown:
    """A result that can be shown as a table."""

    __slots__ = ()

    def to_records(self, *, full: bool = False) -> list[Record]:
        """The result as rows of a table, with the names of the JSON output; times are whole picoseconds in columns `..._ps`.

        Parameters
        ----------
        full : with all metrics, terms, methods and sources, which are many columns
        """
        return presenter().records(self, full)

    def to_dataframe(self, *, full: bool = False) -> pd.DataFrame:
        """The records as a data frame; needs the package pandas.

        Parameters
        ----------
        full : as for `to_records`

        Raises
        ------
        ImportError : pandas is not installed; the text says how to install it.
        """
        try:
            import pandas as pd
        except ImportError as error:
            raise ImportError("a data frame needs pandas; install it with: pip install amuros[pandas]") from error
        return pd.DataFrame(self.to_records(full=full))

    def __str__(self) -> str:
        """What the command line prints of such a result, or a short text."""
        return presenter().text(self)

    def _repr_html_(self) -> str:
        """What notebooks display."""
        return presenter().html(self)


class Presenter(Protocol):
    """How results are shown."""

    def records(self, result: object, full: bool) -> list[Record]:
        """The rows of a table, with the most important columns or all."""

    def text(self, result: object) -> str:
        """A text for people."""

    def html(self, result: object) -> str:
        """A part of a page."""


_load: Callable[[], Presenter] | None = None


def present_by(load: Callable[[], Presenter]) -> None:
    """Set what shows results; it is loaded when something is shown."""
    global _load
    _load = load


def presenter() -> Presenter:
    """What shows results."""
    assert _load is not None, "the public package sets it"
    return _load()
