"""A system: its tasks and ISRs on their cores, what activates them, and what flows between them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import pairwise

from amalthea_uros._internal.plural import counted
from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.perf.software import Isr, Process
from amalthea_uros.perf.system import System
from amalthea_uros.report.pictures.flows import ChainPath, Flow, SystemFlows
from amalthea_uros.report.pictures.page import (
    MARGIN,
    MARK,
    PALETTE,
    TOP,
    WIDTH,
    Entry,
    draw_verdict,
    nothing,
    picture_of,
    swatch,
    verdict_entries,
)
from amalthea_uros.report.pictures.svg import Markup, element, number, path_of, rect_at, text_at, tipped
from amalthea_uros.report.pictures.system_layout import BOX, DrawnWire, Layout, LayoutWire, Point, lay_out
from amalthea_uros.report.wording.cells import load_text
from amalthea_uros.timing.activation.load import activation_rates, loads
from amalthea_uros.timing.dataflow.links import LinkKind
from amalthea_uros.timing.scheduling.allocation import allocated_cores
from amalthea_uros.units import Rounding

#: With more processes, the picture shows cores and the flows between them; with more flows, one line for all data of a process.
MOST_PROCESSES, MOST_FLOWS = 40, 40
#: No more cores, flows between cores, and event chains are drawn.
MOST_CORES, MOST_CORE_FLOWS, MOST_CHAINS = 40, 60, len(PALETTE)
#: Pixels.
_GAP, _INSET, _HEAD, _SHIFT, _CHIP = 10, 9, 6.0, 2.5, 4
_NO_CORE = "no core, or several ones"
_DASHES = {
    LinkKind.TRIGGER: "7 3",
    LinkKind.OS_EVENT: "2 3",
    LinkKind.SERVER_CALL: "2 3",
    LinkKind.MESSAGE: "9 3 2 3",
}
_MEANINGS = {
    LinkKind.DATA: "data",
    LinkKind.TRIGGER: "activation",
    LinkKind.OS_EVENT: "OS event",
    LinkKind.SERVER_CALL: "server call",
    LinkKind.MESSAGE: "messages of a topic",
}


@dataclass(frozen=True, slots=True)
class _Box:
    """The content of a box.

    Attributes
    ----------
    lines : below the name
    chains : the numbers of the chains that pass it
    """

    name: str
    lines: tuple[str, ...]
    verdict: Verdict | None = None
    chains: tuple[int, ...] = ()
    is_round: bool = False


@dataclass(frozen=True, slots=True)
class _Band:
    """A core with its boxes."""

    header: str
    nodes: tuple[_Box, ...]


@dataclass(frozen=True, slots=True)
class _Content:
    """What a picture shows, before it has a layout; there is a kind for each wire."""

    bands: tuple[_Band, ...]
    wires: tuple[LayoutWire, ...]
    kinds: tuple[LinkKind, ...]
    notes: tuple[str, ...]
    chains: tuple[ChainPath, ...] = field(default=())


def draw_system(system: System, analysis: Analysis | None = None) -> Markup:
    """The processes of a system in boxes, on their cores and the most urgent first, and the flows between them.

    Large systems are shown by their cores.

    Parameters
    ----------
    analysis : shows loads and verdicts, too
    """
    shown = SystemFlows.of(system, analysis)
    is_large = len(system.processes) > MOST_PROCESSES
    return _drawn(_of_cores(shown, analysis) if is_large else _of_processes(shown, analysis), _subtitle(shown))


# Content


def _of_processes(shown: SystemFlows, analysis: Analysis | None) -> _Content:
    chains = [chain for chain in shown.chains if chain.processes]
    own_loads = {} if analysis is None else _loads(analysis)
    bands = tuple(
        _Band(_core_text(core, analysis), tuple(_node(each, shown, analysis, own_loads, chains) for each in processes))
        for core, processes in shown.cores.items()
    )
    is_dense = len(shown.flows) > MOST_FLOWS
    flows = list(_united(shown.flows)) if is_dense else shown.flows
    wires = [LayoutWire(flow.source, flow.targets, _names(flow, is_dense)) for flow in flows]
    outer = [LayoutWire(source.name, source.targets, source.name, is_outer=True) for source in shown.sources]
    kinds = [
        *(flow.kind for flow in flows),
        *(LinkKind.TRIGGER if source.is_stimulus else LinkKind.DATA for source in shown.sources),
    ]
    return _Content(bands, (*wires, *outer), tuple(kinds), tuple(_notes(shown, is_dense)), tuple(chains[:MOST_CHAINS]))


def _node(
    process: Process,
    shown: SystemFlows,
    analysis: Analysis | None,
    own_loads: Mapping[str, Fraction],
    chains: Sequence[ChainPath],
) -> _Box:
    priority, load = shown.placement(process.name).priority, own_loads.get(process.name)
    details = (
        *([] if priority is None else [f"priority {priority}"]),
        *([] if load is None else [f"load {_percent(load)}"]),
    )
    return _Box(
        process.name,
        (shown.activation(process.name), ", ".join(details)),
        None if analysis is None else analysis[process.name].verdict,
        tuple(index for index, chain in enumerate(chains[:MOST_CHAINS]) if process.name in chain.processes),
        isinstance(process, Isr),
    )


def _loads(analysis: Analysis) -> dict[str, Fraction]:
    """The worst-case load by each process, where it is known."""
    context = analysis.solution.context
    rates = activation_rates(context.system, context.activations)
    found = loads(allocated_cores(context.system), rates, context.demand_model, uncertain=())
    return {process: load for of_core in found.values() for process, load in of_core.items()}


def _percent(load: Fraction) -> str:
    return "< 0.01 %" if 0 < load < Fraction(1, 10_000) else load_text(load, Rounding.UP)


def _core_text(core: str | None, analysis: Analysis | None) -> str:
    """A core with its load, as far as it is known."""
    found = (each for each in (analysis.processors if analysis is not None else ()) if each.name == core)
    for result in found:
        least = f"at least {load_text(result.at_least, Rounding.DOWN)}"
        return f"{core}, load {least if result.worst is None else _percent(result.worst)}"
    return core or _NO_CORE


def _of_cores(shown: SystemFlows, analysis: Analysis | None) -> _Content:
    """One box for each core, and the numbers of flows between them."""
    cores = sorted(shown.cores.items(), key=lambda item: -len(item[1]))[:MOST_CORES]
    core_of = {process.name: core or _NO_CORE for core, processes in shown.cores.items() for process in processes}
    between = Counter(
        (core_of[flow.source], core_of[target]) for flow in shown.flows for target in flow.targets for _ in flow.names
    )
    drawn = {core or _NO_CORE for core, _ in cores}
    most = [ends for ends, _ in between.most_common() if ends[0] != ends[1] and drawn.issuperset(ends)]
    wires = tuple(
        LayoutWire(source, (target,), f"{between[source, target]:,}") for source, target in sorted(most[:MOST_CORE_FLOWS])
    )
    bands = tuple(_Band(_core_text(core, analysis), (_core_node(core or _NO_CORE, own, between),)) for core, own in cores)
    notes = [
        f"Only cores are shown: there are {counted(len(shown.system.processes), 'process')}. Numbers at arrows count flows."
    ]
    if len(shown.cores) > len(cores):
        notes.append(f"{counted(len(shown.cores) - len(cores), 'core')} with fewer processes not shown.")
    if len(most) > len(wires):
        notes.append(f"{counted(len(most) - len(wires), 'connection')} of cores with fewer flows not shown.")
    return _Content(bands, wires, (LinkKind.DATA,) * len(wires), (*notes, *_problems(shown)))


def _core_node(core: str, processes: Sequence[Process], between: Counter[tuple[str, str]]) -> _Box:
    isrs = sum(isinstance(process, Isr) for process in processes)
    numbers = _counts((len(processes) - isrs, "task"), (isrs, "ISR"))
    return _Box(core, (numbers, f"{counted(between[core, core], 'flow')} within"))


def _counts(*numbers: tuple[int, str]) -> str:
    return ", ".join(counted(count, noun) for count, noun in numbers if count)


def _united(flows: Iterable[Flow]) -> Iterator[Flow]:
    """One flow for all of a kind that come from the same process."""
    found: dict[tuple[LinkKind, str], list[Flow]] = {}
    for flow in flows:
        found.setdefault((flow.kind, flow.source), []).append(flow)
    for (kind, source), own in found.items():
        names = tuple(name for flow in own for name in flow.names)
        yield Flow(kind, source, names, tuple(dict.fromkeys(to for flow in own for to in flow.targets)))


def _names(flow: Flow, is_dense: bool) -> str:
    return f"{len(flow.names):,}" if is_dense and len(flow.names) > 1 else ", ".join(flow.names)


def _notes(shown: SystemFlows, is_dense: bool) -> Iterator[str]:
    if is_dense:
        yield "Data of a process are drawn as one line, with their number: not each target reads all of them."
    if empty := [core for core in shown.system.cores if core not in shown.cores]:
        yield f"Without processes: {', '.join(empty)}."
    if (left_out := sum(bool(chain.processes) for chain in shown.chains) - MOST_CHAINS) > 0:
        yield f"{counted(left_out, 'event chain')} not shown."
    for chain in shown.chains[:MOST_CHAINS]:
        if chain.reason:
            yield f"Event chain {chain.name} not shown: {chain.reason}."
    yield from _problems(shown)


def _problems(shown: SystemFlows) -> list[str]:
    return [f"No flows are shown: {shown.problem}."] if shown.problem else []


def _subtitle(shown: SystemFlows) -> str:
    system = shown.system
    tasks, isrs = (len(system.software.tasks), "task"), (len(system.software.isrs), "ISR")
    flows, chains = (len(shown.flows), "flow"), (len(system.chains), "event chain")
    cores = (len(system.cores.keys() - system.network.wire_cores), "core")
    return _counts(cores, (len(system.network.wires), "wire"), tasks, isrs, flows, chains) or "no processes"


# Drawing


def _drawn(content: _Content, subtitle: str) -> Markup:
    bands = [[node.name for node in band.nodes] for band in content.bands]
    layout = lay_out(bands, content.wires, MARGIN, TOP)
    width = max(WIDTH, layout.right + MARGIN)
    by_ends = {
        (wire.wire.source, target): way for wire in layout.wires if not wire.wire.is_outer for target, way in wire.ways.items()
    }
    body = (
        *(_frame(band, top, size, width) for band, (top, size) in zip(content.bands, layout.bands, strict=True)),
        *(_chain(chain, index, content.chains[:index], by_ends) for index, chain in enumerate(content.chains)),
        *(_wire(wire, kind) for wire, kind in zip(layout.wires, content.kinds, strict=True)),
        *(_box(node, layout) for band in content.bands for node in band.nodes),
        *(() if content.bands else (nothing("the model has no processes"),)),
    )
    bottom = layout.bottom + _GAP + (0 if content.bands else 30)
    return picture_of("System", subtitle, body, bottom, _legend(content), content.notes, width)


def _frame(band: _Band, top: float, height: float, width: float) -> Markup:
    frame = rect_at("frame", MARGIN, top, width - 2 * MARGIN, height, rx=6)
    return tipped(band.header, frame, text_at(band.header, MARGIN + _INSET, top + 17, "header", room=width - 4 * MARGIN))


def _box(node: _Box, layout: Layout) -> Markup:
    """A box with its lines; ISRs have round ends."""
    box = layout.boxes[node.name]
    outline = rect_at("box", box.left, box.top, BOX, box.height, rx=16 if node.is_round else 3)
    room = BOX - 2 * _INSET
    left, for_name = box.left + _INSET, room - (MARK + 4 if node.verdict else 0)
    parts = [text_at(node.name, left, box.top + 17, "header", room=for_name)]
    for line, content in enumerate(filter(None, node.lines)):
        parts.append(text_at(content, left, box.top + 31 + 13 * line, "small muted", room=room))
    parts += [
        element("circle", class_=f"c{chain}", cx=box.right - 12 - 11 * place, cy=box.top + box.height, r=_CHIP)
        for place, chain in enumerate(reversed(node.chains))
    ]
    mark = draw_verdict(node.verdict, box.right - MARK, box.top + 13)
    tip = ", ".join(filter(None, (node.name, *node.lines, str(node.verdict or ""))))
    return tipped(tip, outline, *parts, mark)


def _wire(drawn: DrawnWire, kind: LinkKind) -> Markup:
    """A line to each target with an arrow at its end, and its names above its start."""
    way = "".join(_path(points) for points in drawn.ways.values())
    heads = "".join(_head(*points[-2:]) for points in drawn.ways.values())
    (x, y), wire = drawn.start, drawn.wire
    label = text_at(wire.label, x + 5, y - 3, "small", room=drawn.room - 6)
    to = f"to {', '.join(wire.targets)}"
    tip = f"{wire.label}, {to}" if wire.is_outer else f"{wire.source} {to}: {wire.label}"
    start = [element("circle", class_="head", cx=x, cy=y, r=3)] if wire.is_outer else []
    line = path_of("flow", way, stroke_dasharray=_DASHES.get(kind, "none"))
    return tipped(tip, line, path_of("head", heads), *start, label)


def _path(points: Sequence[Point]) -> str:
    (x, y), *others = points
    return f"M{number(x)} {number(y)}" + "".join(f"L{number(x)} {number(y)}" for x, y in others)


def _head(before: Point, end: Point) -> str:
    """The last part of a line is horizontal."""
    back = -_HEAD if end[0] > before[0] else _HEAD
    return f"M{number(end[0])} {number(end[1])}l{back:g} -3.2v6.4z"


def _chain(
    chain: ChainPath, index: int, before: Sequence[ChainPath], by_ends: Mapping[tuple[str, str], Sequence[Point]]
) -> Markup:
    """The lines along a chain in its colour, beside those of the chains before that use them, too."""
    used = Counter(ends for other in before for ends in set(pairwise(other.processes)))
    ways = (_beside(by_ends[ends], _SHIFT * used[ends]) for ends in pairwise(chain.processes) if ends in by_ends)
    path = "".join(map(_path, ways))
    line = path_of(f"t{index} way", path)
    return tipped(_chain_text(chain), line) if path else Markup("")


def _beside(way: Sequence[Point], shift: float) -> list[Point]:
    """A way a little lower, and its track a little farther to the right."""
    (first_x, first_y), *inner, (last_x, last_y) = way
    return [(first_x, first_y + shift), *((x + shift, y + shift) for x, y in inner), (last_x, last_y + shift)]


def _chain_text(chain: ChainPath) -> str:
    return f"event chain {chain.name}: {', '.join(chain.processes)}"


def _legend(content: _Content) -> Iterator[Entry]:
    for kind in dict.fromkeys(content.kinds):
        line = path_of("flow", "M-10 0H9", stroke_dasharray=_DASHES.get(kind, "none"))
        yield True, Markup(line + path_of("head", "M9 0l-6 -3.2v6.4z")), _MEANINGS[kind]
    for index, chain in enumerate(content.chains):
        key = path_of(f"t{index} way", "M-9 0H9"), element("circle", class_=f"c{index}", r=_CHIP)
        yield True, tipped(_chain_text(chain), *key), f"event chain {chain.name}"
    nodes = [node for band in content.bands for node in band.nodes]
    yield any(node.is_round for node in nodes), swatch("box", rx=6), "ISR"
    yield from verdict_entries({node.verdict for node in nodes})
