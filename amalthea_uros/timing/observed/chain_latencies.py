"""End-to-end latencies of a route of a chain, from the occurrences of its stimulus and of its response.

For the same schedule, the maxima are those of immediate forward and backward job chains (M. Günzel and others, RTAS 2021, ECRTS 2023),
and of the inputs that reach the end (N. Feiertag and others 2008):

- at each stimulus: the reduced reaction time up to the first response that shows this stimulus or a newer one, and the reaction time,
  which starts at the stimulus before: an event just after that one has to wait for this one. The mean of the reaction time is that of
  these worst events, not of events at any time
- at each response: the reduced data age since the stimulus that it shows, and the data age up to the next response
- at each stimulus that some response shows: last-to-first up to the first of these responses, and first-to-last from the stimulus
  that was shown before to the last one

A response that comes before the stimulus that its job shows, such as the start of a job that reads later, does not answer it: it shows
the latest stimulus before it.

What needs a stimulus before the first one, or a response after the end of the run, is not observed.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.timing.basics.quantities import ChainQuantity

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Numbers = NDArray[np.int64]

#: So many of the latest stimuli are kept: a response that comes later is not evaluated, but counted.
WINDOW = 2**16

#: The quantities that are noted.
MEASURED = (
    ChainQuantity.REACTION_TIME,
    ChainQuantity.REDUCED_REACTION_TIME,
    ChainQuantity.DATA_AGE,
    ChainQuantity.REDUCED_DATA_AGE,
    ChainQuantity.FIRST_TO_LAST,
    ChainQuantity.LAST_TO_FIRST,
)
#: Other names of what is noted.
SAME = {
    ChainQuantity.FIRST_TO_FIRST: ChainQuantity.REDUCED_REACTION_TIME,
    ChainQuantity.LAST_TO_LAST: ChainQuantity.REDUCED_DATA_AGE,
}

#: Takes values of a quantity, and the number and the time of the stimulus of each.
Note: TypeAlias = "Callable[[ChainQuantity, Numbers, Numbers, Numbers], None]"


@dataclass(frozen=True, slots=True, kw_only=True)
class _Input:
    """A stimulus that responses show.

    Attributes
    ----------
    number, time : of the stimulus
    previous : time of the stimulus that was shown before; -1 if there was none
    last_response : the latest response so far that shows it
    """

    number: int
    time: int
    previous: int
    last_response: int


@dataclass(slots=True)
class ObservedRouteLatencies:
    """The latencies of a route, part by part.

    Attributes
    ----------
    note : takes the values
    stimuli, responses : numbers of occurrences
    not_evaluated : number of stimuli and responses for which the time of the stimulus is no longer kept
    answered : number of the newest stimulus to which there was a response, -1 if there is none
    """

    note: Note
    stimuli: int = 0
    responses: int = 0
    not_evaluated: int = 0
    answered: int = -1
    #: The times of the latest stimuli.
    _times: Numbers = field(default_factory=lambda: np.empty(0, np.int64))
    #: Number and time of the stimulus that the latest response shows; -1 if it shows none, or one that is not evaluated.
    _latest: tuple[int, int] = (-1, 0)
    _input: _Input | None = None

    def add(self, is_response: NDArray[np.bool_], times: Numbers, stamps: Numbers) -> None:
        """Take occurrences in, in the order of time.

        Parameters
        ----------
        stamps : for a response the number of the newest stimulus whose effect it shows, or -1 as long as it shows none
        """
        # How many stimuli there were before each response.
        before = self.stimuli + np.cumsum(~is_response)[is_response]
        self._times = np.concatenate([self._times, times[~is_response]])
        self.stimuli += len(times) - len(before)
        self.responses += len(before)
        if len(before):
            self._evaluate(times[is_response], stamps[is_response], before - WINDOW)
        self._times = self._times[-WINDOW:].copy()

    @property
    def unanswered(self) -> Numbers:
        """The times of the stimuli to which there was no response so far, as far as they are kept."""
        return self._times[max(0, self.answered + 1 - self._first_kept) :]

    @property
    def _first_kept(self) -> int:
        """The number of the first stimulus whose time is kept."""
        return self.stimuli - len(self._times)

    def _time_of(self, stimuli: Numbers) -> Numbers:
        return self._times[stimuli - self._first_kept]

    def _evaluate(self, times: Numbers, stamps: Numbers, kept: Numbers) -> None:
        """Evaluate responses.

        Parameters
        ----------
        kept : for each response the number of the first stimulus for which it is evaluated
        """
        # The latest stimulus that has come before the response.
        possible = np.searchsorted(self._times, times, side="right") - 1 + self._first_kept
        stamps = np.minimum(stamps, possible)
        newest = np.maximum.accumulate(np.maximum(stamps, self.answered))
        is_evaluated = (stamps >= 0) & (stamps >= kept)
        self.not_evaluated += int(np.count_nonzero((stamps >= 0) & ~is_evaluated))
        self._react(times, newest, kept)
        self._age(times, np.where(is_evaluated, stamps, -1))
        # An output can be older than one before it, if jobs overtake each other; the newest one counts.
        is_newest = is_evaluated & (stamps == newest)
        self._follow_inputs(times[is_newest], stamps[is_newest])
        self.answered = int(newest[-1])

    def _react(self, times: Numbers, newest: Numbers, kept: Numbers) -> None:
        """From each stimulus to the first response that shows it or a newer one."""
        first, end = self.answered + 1, int(newest[-1]) + 1
        stimuli = np.arange(max(first, min(int(kept[0]), end)), end)
        answers = np.searchsorted(newest, stimuli)
        is_kept = stimuli >= kept[answers]
        stimuli, answers = stimuli[is_kept], answers[is_kept]
        self.not_evaluated += end - first - len(stimuli)
        starts = self._time_of(stimuli)
        self.note(ChainQuantity.REDUCED_REACTION_TIME, times[answers] - starts, stimuli, starts)
        has_previous = stimuli > np.maximum(kept[answers], 0)
        stimuli, answers = stimuli[has_previous], answers[has_previous]
        previous = self._time_of(stimuli - 1)
        self.note(ChainQuantity.REACTION_TIME, times[answers] - previous, stimuli, starts[has_previous])

    def _age(self, times: Numbers, stamps: Numbers) -> None:
        """From the stimulus that each response shows to this response and to the next one."""
        is_shown = stamps >= 0
        starts = np.zeros_like(times)
        starts[is_shown] = self._time_of(stamps[is_shown])
        self.note(ChainQuantity.REDUCED_DATA_AGE, times[is_shown] - starts[is_shown], stamps[is_shown], starts[is_shown])
        number, start = self._latest
        self._latest = int(stamps[-1]), int(starts[-1])
        stamps, starts = np.concatenate([[number], stamps[:-1]]), np.concatenate([[start], starts[:-1]])
        is_shown = stamps >= 0
        self.note(ChainQuantity.DATA_AGE, times[is_shown] - starts[is_shown], stamps[is_shown], starts[is_shown])

    def _follow_inputs(self, times: Numbers, stamps: Numbers) -> None:
        """From each stimulus that responses show to the first of them, and from the one shown before to the last of them."""
        if len(times) == 0:
            return
        starts, before = self._time_of(stamps), self._input
        if before is not None:
            times, stamps, starts = (
                np.concatenate([[first], rest])
                for first, rest in ((before.last_response, times), (before.number, stamps), (before.time, starts))
            )
        firsts = np.flatnonzero(np.diff(stamps, prepend=-1))
        stamps, starts = stamps[firsts], starts[firsts]
        new = slice(0 if before is None else 1, None)
        self.note(ChainQuantity.LAST_TO_FIRST, times[firsts[new]] - starts[new], stamps[new], starts[new])
        previous = np.concatenate([[-1 if before is None else before.previous], starts[:-1]])
        is_over = previous[:-1] >= 0
        lasts = times[firsts[1:] - 1] - previous[:-1]
        self.note(ChainQuantity.FIRST_TO_LAST, lasts[is_over], stamps[:-1][is_over], starts[:-1][is_over])
        self._input = _Input(
            number=int(stamps[-1]), time=int(starts[-1]), previous=int(previous[-1]), last_response=int(times[-1])
        )
