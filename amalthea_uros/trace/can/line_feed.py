"""The lines of a text file for a reader of python-can: one at a time, so that it is known which it has read, and what it left out."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from amalthea_uros.trace.problems import Place


class LineFeed:
    """A file that a reader of python-can takes its lines from.

    Parameters
    ----------
    prepare : gives the line that the reader gets
    left_out : called with a line of which the reader has made nothing

    Attributes
    ----------
    is_at_end : whether all lines have been read
    failure : why no more lines can be read; None: all could be
    """

    def __init__(self, lines: Iterator[str], prepare: Callable[[str], str], left_out: Callable[[str, Place], None]) -> None:
        self._lines, self._prepare, self._left_out = lines, prepare, left_out
        self._number, self._text, self._is_used = 0, "", True
        self._first: list[str] = []
        self.is_at_end = False
        self.failure: Exception | None = None

    def __iter__(self) -> Iterator[str]:
        return self

    def __next__(self) -> str:
        if self._first:
            return self._first.pop()
        self._settle()
        try:
            self._text = next(self._lines)
        except StopIteration:
            self.is_at_end = True
            raise
        except Exception as error:  # readers of python-can take it for their own
            self.is_at_end, self.failure = True, error
            raise
        self._number += 1
        self._is_used = False
        return self._prepare(self._text)

    @property
    def place(self) -> Place:
        """Where the line is that was read last."""
        return Place(self._number, 1, self._text.rstrip("\r\n")[:200])

    def use(self) -> None:
        """State that something was made of the last line."""
        self._is_used = True

    def push(self, line: str) -> None:
        """Let a line be the next, which is not in the file."""
        self._first.append(line)

    def close(self) -> None:
        """Readers call it at the end; the lines are closed by those who opened them."""
        self._settle()

    def _settle(self) -> None:
        if not self._is_used:
            self._is_used = True
            self._left_out(self._text, self.place)
