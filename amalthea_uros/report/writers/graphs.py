"""The data flow of a system as a graph for other programs: Mermaid and Graphviz."""

from __future__ import annotations

from typing import IO

from amalthea_uros.perf.software import Isr
from amalthea_uros.perf.system import System
from amalthea_uros.report.basics.escape import visible
from amalthea_uros.report.pictures.flows import Flow, SystemFlows
from amalthea_uros.services.report import ReportContent
from amalthea_uros.timing.dataflow.links import LinkKind

#: More names at an arrow are counted.
_MOST_NAMES = 3
_NO_CORE = "no core, or several ones"
# Mermaid decodes numeric entities in quoted texts, and otherwise takes quotes, markup, Markdown and these entities for syntax.
# See "Entity codes to escape characters", https://mermaid.js.org/syntax/flowchart.html.
_PLAIN = frozenset("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789 ,.:_")


def write_mermaid(content: ReportContent, stream: IO[str]) -> None:
    """Write the graph of a report for Mermaid."""
    stream.write(mermaid(content.system))


def write_dot(content: ReportContent, stream: IO[str]) -> None:
    """Write the graph of a report for Graphviz."""
    stream.write(dot(content.system))


def mermaid(system: System) -> str:
    """The processes on their cores and the flows between them as a flowchart of Mermaid."""
    shown = SystemFlows.of(system)
    lines = ["flowchart LR"]
    ids = _ids(shown)
    for number, (core, processes) in enumerate(shown.cores.items()):
        lines.append(f'  subgraph core{number}["{_mermaid_text(core or _NO_CORE)}"]')
        for process in processes:
            start, end = ("([", "])") if isinstance(process, Isr) else ("[", "]")
            label = f"{_mermaid_text(process.name)}<br/>{_mermaid_text(shown.activation(process.name))}"
            lines.append(f'    {ids[process.name]}{start}"{label}"{end}')
        lines.append("  end")
    for flow in shown.flows:
        arrow = "-->" if flow.kind is LinkKind.DATA else "-.->"
        lines += (f'  {ids[flow.source]} {arrow}|"{_mermaid_text(_label(flow))}"| {ids[target]}' for target in flow.targets)
    for number, source in enumerate(shown.sources):
        lines.append(f'  source{number}(("{_mermaid_text(source.name)}"))')
        lines += (f"  source{number} --> {ids[target]}" for target in source.targets)
    return "\n".join((*lines, *([f"  %% {_one_line(shown.problem)}"] if shown.problem else []))) + "\n"


def dot(system: System) -> str:
    """The same as a graph of Graphviz."""
    shown = SystemFlows.of(system)
    lines = ["digraph {", "  rankdir=LR;", "  node [shape=box];"]
    ids = _ids(shown)
    for number, (core, processes) in enumerate(shown.cores.items()):
        lines += (f"  subgraph cluster_core{number} {{", f"    label={_dot_text(core or _NO_CORE)};")
        for process in processes:
            shape = ", style=rounded" if isinstance(process, Isr) else ""
            lines.append(f"    {ids[process.name]} [label={_dot_text(process.name, shown.activation(process.name))}{shape}];")
        lines.append("  }")
    for flow in shown.flows:
        style = "" if flow.kind is LinkKind.DATA else ", style=dashed"
        lines += (f"  {ids[flow.source]} -> {ids[target]} [label={_dot_text(_label(flow))}{style}];" for target in flow.targets)
    for number, source in enumerate(shown.sources):
        lines.append(f"  source{number} [label={_dot_text(source.name)}, shape=plaintext];")
        lines += (f"  source{number} -> {ids[target]};" for target in source.targets)
    return "\n".join((*lines, *([f"  // {_one_line(shown.problem)}"] if shown.problem else []), "}")) + "\n"


def _ids(shown: SystemFlows) -> dict[str, str]:
    """Names that are keywords nowhere."""
    return {name: f"process{number}" for number, name in enumerate(shown.system.processes)}


def _label(flow: Flow) -> str:
    more = len(flow.names) - _MOST_NAMES
    return ", ".join((*flow.names[:_MOST_NAMES], *([f"and {more} more"] if more > 0 else [])))


def _mermaid_text(content: str) -> str:
    """A text within quotes: every character but letters, digits and a few others as its code."""
    return "".join(each if each in _PLAIN else f"#{ord(each)};" for each in visible(content))


def _dot_text(*lines: str) -> str:
    r"""A quoted text of some lines; a backslash is itself, and no escape such as ``\N``, the name of a node."""
    escaped = (visible(line).replace("\\", "\\\\").replace('"', '\\"') for line in lines)
    # Graphviz decodes entities of HTML in texts.
    return '"' + "\\n".join(line.replace("&", "&amp;") for line in escaped) + '"'


def _one_line(content: str) -> str:
    return " ".join(visible(content).split())
