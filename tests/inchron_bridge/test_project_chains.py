"""Event chains as graphs: sets of events and branches are written; foreign graphs are read, or stay unknown."""

import re
from dataclasses import replace
from itertools import pairwise, product
from pathlib import Path

import pytest
from support import SHARED, model_text

from amalthea_uros.inchron.ids import NAMESPACE
from amalthea_uros.inchron.read import parse_project, read_project
from amalthea_uros.inchron.write import project_text
from amalthea_uros.inchron_bridge.build import build_project
from amalthea_uros.inchron_bridge.extract import extract_project
from amalthea_uros.perf import events as perf
from amalthea_uros.perf.constraints import ChainSynchronization, Constraints, LatencyConstraint
from amalthea_uros.perf.software import Label, Software
from amalthea_uros.perf.system import System
from amalthea_uros.services.analyze import analyze_files
from amalthea_uros.services.export import export
from amalthea_uros.services.subject import open_system
from amalthea_uros.timing.dataflow.chains import sequences, unfold

LABELS = "abcdef"


def system_of(*chains, sets=()):
    """A system with labels and the events of writing them."""
    writes = [perf.LabelEvent(name=name, label=name, change=perf.LabelChange.WRITE) for name in LABELS]
    software = Software(labels=tuple(Label(name=name) for name in LABELS))
    return System(software=software, events=perf.Events(events=(*writes, *sets), chains=chains))


def graph_of(chain, *sets):
    """The graph of a chain of writes to labels, as each node with its predecessors, and its last nodes; with the graph."""
    built = build_project(system_of(chain, sets=sets))
    (graph,) = built.model["eventChains"]
    nodes = {node.name: sorted(before.name for before in node["predecessors"]) for node in graph["nodes"]}
    return nodes, [node.name for node in graph["terminalNodes"]], graph


def test_a_set_inside_becomes_steps_that_a_barrier_joins():
    both = perf.EventSet(name="both", events=("b", "c"))
    parts = (perf.Segment(stimulus="a", response="both"), perf.Segment(stimulus="both", response="d"))
    nodes, ends, graph = graph_of(perf.EventChain(name="C", stimulus="a", response="d", items=perf.Sequence(parts)), both)
    assert nodes == {"a": [], "b": ["a"], "c": ["a"], "both_sync": ["b", "c"], "d": ["both_sync"]}
    assert ends == ["d"]
    assert next(node for node in graph["nodes"] if node.name == "both_sync")["minItems"] == 0  # all of them


def test_a_set_at_the_end_becomes_several_ends():
    both = perf.EventSet(name="both", events=("b", "c"))
    nodes, ends, _ = graph_of(perf.EventChain(name="C", stimulus="a", response="both"), both)
    assert (nodes, ends) == ({"a": [], "b": ["a"], "c": ["a"]}, ["b", "c"])


def test_branches_may_have_branches_and_ends_of_their_own():
    inner = perf.Parallel(items=(line("b", "c", "e"), line("b", "d", "e")), completed=2)
    deep = perf.Segment(stimulus="a", response="f", items=perf.Sequence((seg("a", "b"), seg("b", "e", inner), seg("e", "f"))))
    outer = perf.Parallel(items=(deep, seg("b", "f")), completed=1)
    nodes, _, graph = graph_of(perf.EventChain(name="C", stimulus="a", response="f", items=outer))
    assert nodes == {
        "a": [],
        "b": ["a"],
        "c": ["b"],
        "d": ["b"],
        "C_sync": ["c", "d"],
        "e": ["C_sync"],
        "b_0": ["a"],
        "C_sync_0": ["b_0", "e"],
        "f": ["C_sync_0"],
    }
    needed = {node.name: node["minItems"] for node in graph["nodes"] if "sync" in node.name}
    assert needed == {"C_sync": 2, "C_sync_0": 1}


def test_a_barrier_has_the_name_of_the_segment_with_the_branches():
    inner = perf.Parallel(items=(line("a", "b", "d"), line("a", "c", "d")), completed=1)
    parts = (perf.Segment(stimulus="a", response="d", items=inner, name="P"), seg("d", "e"))
    nodes, _, _ = graph_of(perf.EventChain(name="C", stimulus="a", response="e", items=perf.Sequence(parts)))
    assert nodes == {"a": [], "b": ["a"], "c": ["a"], "P_sync": ["b", "c"], "d": ["P_sync"], "e": ["d"]}


def test_synchronized_chains_are_one_graph_from_their_common_event():
    chains = tuple(perf.EventChain(name=name, stimulus="a", response=name) for name in "bc")
    limit = ChainSynchronization(name="S", chains=("b", "c"), tolerance=5 * 10**9)
    constraints = Constraints(constraints=(limit,))
    system = replace(system_of(*chains), constraints=constraints)
    built = build_project(system)
    (requirement,) = built.model["requirements"]
    graph = requirement["eventChain"]
    assert [(node.name, [each.name for each in node["predecessors"]]) for node in graph["nodes"]] == [
        ("a", []),
        ("b", ["a"]),
        ("c", ["a"]),
    ]
    assert [step.owner.name for step in requirement["start"]] == [step.owner.name for step in requirement["end"]] == ["b", "c"]
    assert (requirement["orSemanticsStart"], requirement["orSemanticsEnd"]) == (True, False)
    assert extract_project(parse_project(Path(), project_text(built.model, NAMESPACE))).system.constraints == constraints


def seg(stimulus, response, items=None):
    return perf.Segment(stimulus=stimulus, response=response, items=items)


def line(*events):
    return seg(events[0], events[-1], perf.Sequence(tuple(seg(*pair) for pair in pairwise(events))))


#: A chain of two events of tasks without types, and a limit of it.
UNTYPED = """\
<swModel><tasks name="A"/><tasks name="B"/></swModel>
<eventModel>
  <events xsi:type="am:ProcessEvent" name="a" entity="A?type=Task"/>
  <events xsi:type="am:ProcessEvent" name="b" entity="B?type=Task"/>
</eventModel>
<constraintsModel>
  <eventChains name="C" stimulus="a?type=ProcessEvent" response="b?type=ProcessEvent"/>
  <timingConstraints xsi:type="am:EventChainLatencyConstraint" name="L" scope="C?type=EventChain" type="Reaction">
    <maximum value="5" unit="ms"/>
  </timingConstraints>
</constraintsModel>
"""


@pytest.mark.parametrize("name", ["10_chain_gap", "10_chain_par_badresp", "10_chain_par_badstim"])
def test_chains_that_the_importer_drops_or_changes_are_graphs(name, tmp_path):
    found = list((SHARED / "vectors").glob(f"am2inc/{name}.amxmi"))
    if not found:
        pytest.skip("no vectors")
    text = export(found[0], tmp_path / "project.iprx").text
    assert "<eventChains " in text
    assert open_system(tmp_path / "project.iprx").system.events == open_system(found[0]).system.events


def test_events_without_a_type_become_a_graph_for_each_type(tmp_path):
    """As in the analysis, each may be an activation, a start or an end, so that a limit is met only if it is for all of them."""
    path = tmp_path / "model.amxmi"
    path.write_text(model_text(UNTYPED))
    text = export(path, tmp_path / "project.iprx").text
    graphs = read_project(tmp_path / "project.iprx").model["eventChains"]
    ends = [tuple(node["first"]["traceEvent"].name for node in graph["nodes"]) for graph in graphs]
    assert ends == list(product(("Activate", "Start", "Terminate"), repeat=2))
    assert text.count("<requirements ") == 9
    given, read = open_system(path), open_system(tmp_path / "project.iprx")
    assert (read.system, read.findings) == (given.system, ())


#: Three tasks on a core; the chain of the description is replaced by graphs of their starts.
DESCRIPTION = """\
amuros: 1
name: small
hardware: {platform: generic, cores: [{name: Core, frequency: 1 MHz}]}
tasks:
  - {name: A, period: 10 ms, priority: 4, execution_time: 1 ms, writes: [x]}
  - {name: B, period: 10 ms, priority: 3, execution_time: 1 ms, reads: [x], writes: [y]}
  - {name: C, period: 10 ms, priority: 2, execution_time: 1 ms, reads: [x], writes: [z]}
  - {name: D, period: 10 ms, priority: 1, execution_time: 1 ms, reads: [y, z]}
chains:
  - {name: chain, path: [A, B, D], reaction: 50 ms}
"""


@pytest.fixture
def project(tmp_path):
    """Makes a project whose only chain is a graph of nodes, each as its class, and what comes before it; A is first, D is last."""
    (tmp_path / "app.yaml").write_text(DESCRIPTION)
    path = tmp_path / "project.iprx"
    text = export(tmp_path / "app.yaml", path).text
    starts = dict(zip("ABCD", re.findall(r'intrinsicId="(\S+)" name="Start"', text), strict=True))

    def made(start="s_A", end="s_D", more="", **nodes):
        lines = []
        for name, (kind, before, *rest) in nodes.items():
            head = f'<nodes xsi:type="model:EventGraph{kind}" intrinsicId="{name}" name="{name}" predecessors="{before}"'
            step = f'<first intrinsicId="s_{name}" traceEvent="{starts.get(name)}"/>' if kind == "TraceEvent" else ""
            lines.append(f"{head} {rest[0] if rest else ''}>{step}{rest[1] if len(rest) > 1 else ''}</nodes>")
        chain = (
            f'<eventChains xsi:type="model:EventGraph" intrinsicId="G" name="G" initialNode="A" terminalNodes="D">'
            f"{''.join(lines)}</eventChains>{more}"
            '<requirements xsi:type="requirement:EventChainTimingRequirement" intrinsicId="_q" name="limit" eventChain="G" '
            f'start="{start}" end="{end}"><interval><lowerLimit/><upperLimit value="90" unit="ms"/></interval></requirements>'
        )
        path.write_text(re.sub(r"<eventChains.*</requirements>", lambda _: chain, text, flags=re.DOTALL))
        return path

    return made


def ways(path):
    """The ways through each chain, as letters of tasks, and the chains of the limits."""
    system = extract_project(read_project(path)).system
    found = {
        chain.name: {"".join(event[0] for event in way) for way in sequences(unfold(chain, system)[0])}
        for chain in system.events.chains
    }
    return found, [limit.chain for limit in system.constraints.constraints]


def test_nested_branches_are_read(project):
    path = project(
        A=("TraceEvent", ""),
        B=("TraceEvent", "A"),
        C=("TraceEvent", "A"),
        join=("SynchronizationBarrier", "B C", 'minItems="2"'),
        D=("TraceEvent", "join"),
    )
    assert ways(path) == ({"G": {"ABD", "ACD"}}, ["G"])
    assert [each.reason for each in analyze_files(path).analysis.chains] == [""]


def test_a_limit_on_some_steps_is_one_on_a_chain_of_them(project):
    path = project(end="s_B", A=("TraceEvent", ""), B=("TraceEvent", "A"), D=("TraceEvent", "B"))
    assert ways(path) == ({"G": {"ABD"}, "G_0_1": {"AB"}}, ["G_0_1"])


def test_a_decision_makes_several_chains_and_limits(project):
    condition = '<globalConditions intrinsicId="_if" name="if"><conjunctions intrinsicId="_and"/></globalConditions>'
    path = project(
        more=condition,
        A=("TraceEvent", ""),
        way=("Decision", "A", 'condition="_if" trueBranch="B" falseBranch="C"'),
        B=("TraceEvent", "way"),
        C=("TraceEvent", "way"),
        D=("TraceEvent", "B C"),
    )
    assert ways(path) == ({"G_true": {"ABD"}, "G_false": {"ACD"}}, ["G_true", "G_false"])
    assert "INC009" in [finding.rule for finding in open_system(path).findings]


def test_a_limit_of_a_chain_that_is_not_understood_is_not_met(project):
    timeout = ("Timeout", "A", 'defaultBranch="B" timeoutBranch="D"', '<timeout value="1"/>')
    path = project(A=("TraceEvent", ""), late=timeout, B=("TraceEvent", "late"), D=("TraceEvent", "B"))
    opened = open_system(path)
    assert [(chain.name, chain.stimulus) for chain in opened.system.events.chains] == [("G", None)]
    assert [finding.rule for finding in opened.findings if "EventGraphTimeout" in finding.message] == ["INC006"]
    analysis = analyze_files(path).analysis
    assert [(each.name, str(each.verdict)) for each in analysis.requirements] == [("limit", "unknown")]


@pytest.mark.parametrize(
    "nodes",
    [
        {"A": ("TraceEvent", "D"), "D": ("TraceEvent", "A")},
        {"A": ("TraceEvent", ""), "B": ("TraceEvent", "A"), "C": ("TraceEvent", "A"), "D": ("TraceEvent", "B C")},
        {"A": ("TraceEvent", ""), "B": ("TraceEvent", "A"), "D": ("TraceEvent", "A")},
        {"A": ("TraceEvent", ""), "B": ("TraceEvent", ""), "j": ("SynchronizationBarrier", "A B"), "D": ("TraceEvent", "j")},
        {"A": ("SubGraph", "", 'subGraph="G"'), "D": ("TraceEvent", "A")},
    ],
    ids=["circle", "join without barrier", "dead end", "barrier without a way", "contains itself"],
)
def test_graphs_that_mean_nothing_certain_stay_unknown(project, nodes):
    opened = open_system(project(start="s_D", **nodes))
    assert [(chain.name, chain.stimulus) for chain in opened.system.events.chains] == [("G", None)]


@pytest.fixture
def begun_by_several():
    """A chain that begins with a and b, each of which has to occur, with a limit, as a project."""
    both = perf.EventSet(name="both", events=("a", "b"))
    parts = perf.Sequence((seg("both", "c"), seg("c", "d")))
    chain = perf.EventChain(name="C", stimulus="both", response="d", items=parts)
    limit = LatencyConstraint(name="L", chain="C", maximum=5 * 10**9)
    system = replace(system_of(chain, sets=(both,)), constraints=Constraints(constraints=(limit,)))
    return system, build_project(system).model


def test_a_set_at_the_start_becomes_a_graph_for_each_event(begun_by_several):
    system, model = begun_by_several
    lines = {graph.name: [node["first"]["traceEvent"].owner.name for node in graph["nodes"]] for graph in model["eventChains"]}
    assert lines == {"C": ["c", "a", "d"], "C_2": ["c", "b", "d"]}
    limits = {each.name: (each["eventChain"].name, each["interval"]["upperLimit"]["value"]) for each in model["requirements"]}
    assert limits == {"L": ("C", 5), "L_2": ("C_2", 5)}
    again = extract_project(parse_project(Path(), project_text(model, NAMESPACE))).system
    assert (again.events, again.constraints) == (system.events, system.constraints)


def test_a_limit_that_somebody_changed_is_one_of_its_graph_alone(begun_by_several):
    _, model = begun_by_several
    model["requirements"][1]["interval"]["upperLimit"]["value"] = 4
    found = extract_project(parse_project(Path(), project_text(model, NAMESPACE))).system
    limits = {each.chain: each.maximum for each in found.constraints.constraints}
    assert limits == {"C_alone": 5 * 10**9, "C_2_alone": 4 * 10**9}
    steps = {chain.name: sequences(unfold(chain, found)[0]) for chain in found.events.chains}
    assert steps == {"C": [("a", "c", "d"), ("b", "c", "d")], "C_alone": [("a", "c", "d")], "C_2_alone": [("b", "c", "d")]}


def test_a_graph_that_somebody_changed_is_a_chain_of_its_own(begun_by_several):
    _, model = begun_by_several
    second = model["eventChains"][1]
    second["nodes"][0]["first"]["traceEvent"] = next(
        each["traceEvents"][1] for each in model.walk() if each.kind == "memory.DataObject" and each.name == "e"
    )
    found = extract_project(parse_project(Path(), project_text(model, NAMESPACE))).system
    assert {chain.name: sequences(unfold(chain, found)[0]) for chain in found.events.chains} == {
        "C": [("a", "c", "d")],
        "C_2": [("b", "e", "d")],
    }
    assert {each.chain for each in found.constraints.constraints} == {"C", "C_2"}
