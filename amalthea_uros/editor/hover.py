"""What the analysis says about the object whose name is at a position."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from io import StringIO

from amalthea_uros._internal.files import overlaid
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.results.processes import ProcessResult
from amalthea_uros.editor.document import TextDocument
from amalthea_uros.errors import AmurosError
from amalthea_uros.judge.summary import urgency
from amalthea_uros.report.documents.explanation import explanation_document
from amalthea_uros.report.wording.answer import answer_lines, headline
from amalthea_uros.report.writers.terminal import Terminal
from amalthea_uros.report.writers.text import write_document
from amalthea_uros.services.analyze import AnalysisResult, analyze_files
from amalthea_uros.services.explain import explain
from amalthea_uros.services.first_answer import answer_about, first_answer
from amalthea_uros.timing.response import Response
from amalthea_uros.units import Rounding, Time, rounded_time_text, time_text

#: In characters. The analysis of larger texts takes too long to be repeated while somebody types.
MAX_LENGTH = 1_000_000
TOO_LARGE = "The file is too large to be analyzed while it is edited; save it and run `amuros analyze`."


def analysis_of(document: TextDocument) -> AnalysisResult | None:
    """The analysis of a text; None if it has errors, or is a YAML file of another program."""
    with overlaid(document.contents):
        if not document.is_ours:
            return None
        try:
            return analyze_files(document.files)
        except AmurosError:
            return None  # the diagnostics say why


def hover_text(result: AnalysisResult, name: str) -> str:
    """The verdict on an object, its response time or latencies, and what they consist of; "" if it has none.

    Markdown; what is not ours is in a block of code.
    """
    analysis = result.analysis
    return "\n\n".join([*_answer(result, name), *_verdicts(analysis, name), *_explained(result, name)])


def _answer(result: AnalysisResult, name: str) -> Iterator[str]:
    """Of the name of the description, the one answer of the analysis; of a chain, that about its most urgent limit."""
    analysis, changed = result.analysis, result.changed
    assembly = None if changed is None else changed.opened.assembly
    if assembly is not None and name == assembly.description.name:
        answer = first_answer(result)
        if answer is not None:
            yield from _code(answer_lines(answer))
    elif name in result.system.chains:
        limits = [each for each in analysis.requirements if each.object == name]
        if limits:
            # Its explanation, which follows, tries the changes.
            about = answer_about(result, min(limits, key=urgency), with_changes=False)
            yield from _code([headline(about)])


def _verdicts(analysis: Analysis, name: str) -> Iterator[str]:
    if name in analysis.processes.names:
        yield _process(analysis.processes[name])
    elif name in analysis.callbacks.names:
        callback = analysis.callbacks[name]
        yield f"**callback**: {_response(callback.response, callback.deadline)}"
        yield from _code([f"called by {callback.process}", callback.reason])
    limits = [requirement for requirement in analysis.requirements if name in (requirement.object, requirement.name)]
    for requirement in limits:
        limit = (
            ""
            if requirement.limit is None
            else f" {'at most' if requirement.is_upper else 'at least'} {time_text(requirement.limit)}"
        )
        yield f"**{requirement.verdict}**: {requirement.quantity}{limit}"
        yield from _code([requirement.reason])


def _process(process: ProcessResult) -> str:
    verdict = process.failure or process.verdict or "no deadline"
    kind = " (the period)" if process.is_implicit else ""
    deadline = "" if process.deadline is None else f", deadline {time_text(process.deadline)}{kind}"
    return f"**{verdict}**: {_response(process.response, process.deadline)}{deadline}"


def _response(response: Response | None, limit: Time | None) -> str:
    if response is None:
        return "the response time is unknown"
    if response.worst is None:
        return "the response time has no upper bound"
    return f"worst-case response time {rounded_time_text(response.worst, Rounding.UP, limit)} ({response.claim})"


def _explained(result: AnalysisResult, name: str) -> Iterator[str]:
    system = result.system
    if name in system.processes or name in system.chains:
        stream = StringIO()
        write_document(explanation_document(explain(result, name)), Terminal(stream))
        yield from _code(stream.getvalue().splitlines())


def _code(lines: Iterable[str]) -> Iterator[str]:
    """Lines as a block of code, which no name can end."""
    shown = [line.replace("```", "'''") for line in lines if line]
    if shown:
        yield "\n".join(["```text", *shown, "```"])
