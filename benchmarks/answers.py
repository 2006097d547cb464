"""Counts what the analysis can say about the models of a folder: `python benchmarks/answers.py FOLDER`.

Of files with processes and runnables that execute something: how many processes have a bounded response time, how many at least an
execution time, how many chains have a latency, and what the reasons for unknown response times are, with the files in which they occur.
"""

from __future__ import annotations

import re
import sys
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

from amalthea_uros import analyze_files
from amalthea_uros.analyze.results.processes import ProcessResult
from amalthea_uros.errors import ReadError


@dataclass
class Answers:
    """What is known of the processes and chains of many files.

    Attributes
    ----------
    complete, partial : files of which all, or some processes have a bounded response time
    timed : processes with an execution time, on their core or on each kind of core
    gained, stated : processes that have a bounded response time with the values that the analysis proposes, and how many values
    commands : files for which it proposes some
    with_processes, answered : files with processes, also those that execute nothing, and those of them with a bounded response time or
        with proposals
    reasons, files_of : why response times are unknown: in how many processes and files; names in the texts are left out
    """

    files: int = 0
    complete: int = 0
    partial: int = 0
    processes: int = 0
    bounded: int = 0
    timed: int = 0
    gained: int = 0
    stated: int = 0
    commands: int = 0
    with_processes: int = 0
    answered: int = 0
    chains: int = 0
    with_latency: int = 0
    reasons: Counter[str] = field(default_factory=Counter)
    files_of: Counter[str] = field(default_factory=Counter)

    def add(self, path: Path, with_proposals: bool) -> None:
        """Count a file, if its processes execute runnables."""
        try:
            result = analyze_files(path, with_missing=with_proposals)
        except ReadError:
            return
        processes, system = result.analysis.processes, result.system
        bounded = [each for each in processes if each.wcrt is not None]
        has_proposals = result.missing is not None and bool(result.missing.changes)
        self.with_processes += bool(processes)
        self.answered += bool(bounded) or has_proposals
        if not processes or not any(runnable.activities for runnable in system.runnables.values()):
            return
        self.files += 1
        self.complete += len(bounded) == len(processes)
        self.partial += 0 < len(bounded) < len(processes)
        self.processes += len(processes)
        self.bounded += len(bounded)
        self.timed += sum(map(_is_timed, processes))
        if result.missing is not None and has_proposals:
            self.gained += len(result.missing.gained)
            self.stated += len(result.missing.changes)
            self.commands += 1
        self.chains += len(result.analysis.chains)
        self.with_latency += sum(bool(chain.values) for chain in result.analysis.chains)
        reasons = Counter(_kind(each.reason) for each in processes if each.wcrt is None)
        self.reasons += reasons
        self.files_of.update(reasons.keys())


def _is_timed(process: ProcessResult) -> bool:
    return process.wcet is not None or any(need.worst is not None for need in process.needs)


def _kind(reason: str) -> str:
    """A reason without names and numbers."""
    return re.sub(r"[\d.,]+ %", "... %", re.sub(r"'[^']*'", "'...'", reason))


def count(paths: Iterable[Path], with_proposals: bool = True) -> Answers:
    """What is known of some files, and with the values that the analysis proposes, which takes about as long again."""
    answers = Answers()
    for path in paths:
        answers.add(path, with_proposals)
    return answers


def lines(answers: Answers) -> Iterator[str]:
    """The counts, and the reasons with the most processes first."""
    yield f"{answers.files} files: {answers.complete} with all response times, {answers.partial} with some"
    yield f"{answers.processes} processes: {answers.bounded} with a bounded response time, {answers.timed} with an execution time"
    yield f"{answers.gained} more with {answers.stated} values that the analysis proposes for {answers.commands} files"
    yield f"{answers.with_processes} files with processes: {answers.answered} with a response time or such values"
    yield f"{answers.chains} chains: {answers.with_latency} with latencies"
    for reason, number in answers.reasons.most_common():
        yield f"{number:5} in {answers.files_of[reason]:3} files: {reason}"


if __name__ == "__main__":
    print(*lines(count(sorted(Path(sys.argv[1]).rglob("*.amxmi")))), sep="\n")
