"""What INCHRON's importer does with a model is what its rules say of it.

The vectors were run through the importer; what it refuses, crashes at, warns of, loses or changes has to be told, and a model that it
takes over as it is must have no error.
"""

import json
import re

import pytest
from excerpts import model
from support import SHARED, model_text

from amalthea_uros import check, load
from amalthea_uros.diagnostics import Severity, ToolEffect
from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.model import Model
from amalthea_uros.validate import registry
from amalthea_uros.validate.rule import RuleProfile

FOLDER = SHARED / "vectors" / "am2inc"
TABLE = SHARED / "reference" / "inchron-constraints.md"
VERDICTS = json.loads((FOLDER / "verdicts.json").read_text()) if FOLDER.exists() else {}
RULES = list(registry.ids([RuleProfile.INCHRON]))

#: Models that are taken over as they are, apart from what an information tells.
SOUND = {
    "01_ns_2_0_0",
    "01_ns_2_1_0",
    "01_ns_3_3_0",
    "20_ticks_const",
    "26_callbackserver_ok",
    "26_server_ok",
    "27_runnable_unused",
    "27_task_nograph",
    "30_jitter_uni",
    "31_burst",
    "31_burst_count0_ok",
    "31_burst_nodist",
    "31_relper_gauss",
    "31_relper_uni",
    "31_single",
    "44_two_os_shared_runnable",
    "45_ips_untriggered",
    "45_unlinked_stim",
    "50_cache_l1",
    "50_cache_l2",
    "50_conn_ok",
    "50_pu_two_freq",
    "50_system_only_pus",
    "62_counter",
    "70_only_root",
}

#: Each of the chain models has the same events, some of which are not converted.
EVENTS = {"INC-EV-KIND", "INC-EV-TYPE", "INC-EV-LABEL-RUN"}

#: Each of the mode models has a label with a bad initial value, and one without a mode.
MODES = {"INC-SW-MODE-VALUE", "INC-SW-MODE-MISSING"}

#: What has to be told of each of the others.
CAUSES = {
    # Other versions are read, but only as far as they agree with 3.2.0.
    "01_ns_0_9_9": {"INC-IO-VERSION"},
    "01_ns_1_0_0": {"INC-IO-VERSION"},
    "01_ns_1_1_0": {"INC-IO-VERSION"},
    "01_ns_3_4_0": {"INC-IO-VERSION"},
    "10_chain_all": EVENTS,
    "10_chain_dup_event": EVENTS,
    "10_chain_first_stim_ne_chain": EVENTS | {"INC-EC-SEQ"},
    "10_chain_gap": EVENTS | {"INC-EC-SEQ"},
    "10_chain_missing_stim": EVENTS | {"INC-EC-ENDS"},
    "10_chain_par_badresp": EVENTS | {"INC-EC-PAR"},
    "10_chain_par_badstim": EVENTS | {"INC-EC-PAR"},
    "10_chain_par_ok": EVENTS,
    "10_chain_unmapped_preempt": EVENTS,
    "10_event_unalloc_entity": EVENTS | {"INC-MAP-TASK-ONCE", "INC-MAP-SCHED"},
    "10_lat_nobounds": EVENTS | {"INC-LC-MAX"},
    "20_ticks_beta": {"INC-SW-TICKS-BETA"},
    "20_ticks_bounds_default": {"INC-SW-TICKS-BOUNDS"},
    "20_ticks_stat": {"INC-SW-TICKS-STAT"},
    "21_execneed": {"INC-SW-NEED"},
    "22_label_nosize": {"INC-SW-LABELSIZE"},
    "22_label_unaccessed_event": EVENTS,
    "22_label_undef": {"INC-SW-ACCESS"},
    "23_call_norunnable": {"INC-SW-REF"},
    "23_channel": {"INC-SW-CHANNEL"},
    "23_ipt_nostim": {"INC-SW-REF"},
    "23_semaphore": {"INC-OS-SEMA-TYPE"},
    "23_semaphore_undef": {"INC-SW-ACCESS"},
    "24_group": {"INC-SW-GROUP"},
    "25_localmode": MODES | {"INC-IO-XMIID", "INC-IO-LOCALLABEL"},
    "25_modelabelaccess": MODES | {"INC-SW-MODE-NUMSET"},
    "25_switch_conj_channelfill": MODES | {"INC-SW-CONDKIND"},
    "25_switch_default": MODES,
    "25_switch_enum_ne": MODES | {"INC-SW-RELATION"},
    "25_switch_nocond": MODES | {"INC-SW-CONDSET"},
    "25_switch_num_lt": MODES | {"INC-SW-RELATION"},
    "26_callbackserver_badtype": {"INC-SW-DISPATCH"},
    "27_activations": {"INC-SW-ACTIVATION"},
    "27_runnable_nograph": {"INC-SW-GRAPH"},
    "30_jitter_beta": {"INC-ST-JITTER"},
    "30_jitter_bounds": {"INC-ST-JITTER"},
    "31_burst_zerocount": {"INC-ST-BURST"},
    "31_custom": {"INC-ST-TYPE", "INC-ST-ORDER"},
    "31_relper_bounds": {"INC-ST-RELPER"},
    "31_relper_mixunit": {"INC-ST-RELPER-UNIT"},
    "31_relper_none": {"INC-ST-RELPER"},
    "31_variablerate": {"INC-ST-TYPE", "INC-ST-ORDER"},
    "32_execcond": MODES,
    "40_alloc_nosched": {"INC-MAP-TASK"},
    "40_alloc_notask": {"INC-MAP-TASK"},
    "40_osoverhead": {"INC-OS-OVERHEAD"},
    "40_prio_string": {"INC-OS-PRIO-TYPE"},
    "40_sched_computation": {"INC-OS-OVERHEAD"},
    "40_sched_param_nokey": {"INC-OS-PARAM-KEY"},
    "40_task_twice": {"INC-MAP-TASK-ONCE"},
    "41_isr_unalloc": {"INC-MAP-TASK-ONCE"},
    "43_memmap_noelem": {"INC-MAP-MEMORY"},
    "44_prio_wrongname": {"INC-OS-ALGOPARAM"},
    "44_unalloc_task_only": {"INC-MAP-TASK-ONCE"},
    "46_multi_stim_unsupported_first": {"INC-ST-TYPE", "INC-ST-ORDER"},
    "50_conn_noports": {"INC-HW-CONN-IFACE"},
    "50_conn_unsupported": {"INC-HW-CONN-IFACE"},
    "50_pu_nofreq": {"INC-HW-PU-CLOCK"},
    "50_pu_onefreq": {"INC-HW-PU-CLOCK"},
    "50_undef_unit": {"INC-HW-FREQ-VALUE"},
    "60_namespace_dup": {"INC-IO-XMIID"},
    "61_dangling_ref": {"INC-IO-REF"},
    "70_unknown_attr": {"INC-IO-FEATURE"},
    "70_unknown_elem": {"INC-IO-FEATURE"},
}

#: The policy of all schedulers of the vectors is OSEK, except for these.
OTHER_POLICY = {
    *("01_ns_0_9_9", "01_ns_1_0_0", "01_ns_1_1_0", "23_semaphore", "40_osoverhead", "40_sched_computation"),
    *("40_sched_param_nokey", "41_isr_unalloc", "44_prio_wrongname", "44_two_os_shared_runnable", "70_only_root"),
}

#: The rules reported for a vector that tests another rule.
BESIDES = {
    "10_chain_par_badresp": {"INC-EC-PAR-ITEMS"},
    "10_chain_par_badstim": {"INC-EC-PAR-ITEMS"},
    "23_channel": {"INC-SW-PROCCHAIN"},
    "25_switch_conj_channelfill": {"INC-SW-PROCCHAIN"},
    "27_runnable_unused": {"INC-SW-LABELSIZE"},
    "27_task_nograph": {"INC-SW-PREEMPTION"},
    "40_task_twice": {"INC-MAP-SCHED"},
    "41_isr_unalloc": {"INC-MAP-SCHED"},
    "44_two_os_shared_runnable": {"INC-MAP-SCHED"},
    "44_unalloc_task_only": {"INC-MAP-SCHED"},
    "50_cache_l1": {"INC-HW-MEM-SIZE"},
    "50_cache_l2": {"INC-HW-MEM-SIZE"},
    "50_conn_ok": {"INC-HW-CONN-PORTS", "INC-HW-MEM-SIZE"},
    "50_undef_unit": {"INC-ST-UNIT"},
    "60_namespace_dup": {"INC-IO-NAME"},
} | {
    name: {"INC-MAP-SCHED", "INC-MAP-TASK-ONCE"}
    for name in VERDICTS
    if name.startswith(("40_alloc_no", "40_prio_string", "43_memmap_noelem", "44_prio_wrongname", "46_multi"))
}

#: An empty file is refused by every tool, no rule is needed for that.
NO_MODEL = {"70_empty"}

#: What the importer says, the rules of which one tells the same, and what the message of its finding has to hold of it.
COMPLAINTS = [
    (r"Conversion not implemented: am320::model::(\w+(?:Event|Set))\.", {"INC-EV-KIND"}),
    (r"Conversion not implemented: am320::model::(\w+Stimulus)\.", {"INC-ST-TYPE"}),
    (r"Conversion not implemented: am320::model::(Channel\w+)\.", {"INC-SW-CHANNEL"}),
    (r"Conversion not implemented: am320::model::(ExecutionNeed)\.", {"INC-SW-NEED"}),
    (r"Ignoring EventChain '(\w+)': Event '(\w+)' can not be mapped", {"INC-EV-TYPE"}),
    (r"Ignoring EventChain '(\w+)': The stimulus is missing", {"INC-EC-ENDS"}),
    (r"Ignoring EventChain '(\w+)': The (?:stimulus|response) of sub-EventChain '(\w+)'", {"INC-EC-PAR"}),
    (r"Ignoring ModeLabel '(\w+)' without reference to a Mode", {"INC-SW-MODE-MISSING"}),
    (r"Cannot convert initial value of NumericMode-Label '(\w+)'", {"INC-SW-MODE-VALUE"}),
    (r"Ignoring object w/o container of type Condition", {"INC-SW-CONDSET"}),
    (r"Ignoring object w/o container of type Scheduler", {"INC-MAP-TASK"}),
    (r"Runnable '(\w+)' does not have an ActivityGraph", {"INC-SW-GRAPH"}),
    (r"PeriodicStimulus '(\w+)': Jitter with unsupported", {"INC-ST-JITTER"}),
    (r"Unsupported ITimeDeviation", {"INC-ST-RELPER"}),
    (r"Group '\w+' in IExecutable '\w+' uses random execution order", {"INC-SW-GROUP"}),
    (r"Missing object of type 'am320::model::Runnable'", {"INC-SW-REF", "INC-IO-REF", "INC-IO-XMIID"}),
    (r"Cannot resolve reference: (A/\S+)", {"INC-IO-XMIID"}),
    (r"Cannot resolve reference: (Does\S+)", {"INC-IO-REF"}),
    (r"LocalModeLabel::getNamePrefixSegments", {"INC-IO-XMIID"}),
    (r"EClassImpl: (\w+) EStructuralFeature not found: (\w+)", {"INC-IO-FEATURE"}),
]

#: Follows another message, or lists what would be known.
FURTHER = re.compile(r"\t|\[am2inc\] Terminating with error")


def told(model):
    return [finding for finding in check(model, RULES) if finding.severity is not Severity.INFO]


def vector(name):
    if not VERDICTS:
        pytest.skip("the verdicts are not at hand")
    return load(FOLDER / f"{name}.amxmi")


@pytest.mark.parametrize("name", sorted([*SOUND, *CAUSES]))
def test_what_goes_wrong_is_told_and_nothing_else(name):
    policy = set() if name in OTHER_POLICY else {"INC-OS-ALGORITHM"}
    assert {finding.rule for finding in told(vector(name))} == CAUSES.get(name, set()) | BESIDES.get(name, set()) | policy


@pytest.mark.skipif(not VERDICTS, reason="the verdicts are not at hand")
def test_all_verdicts_are_looked_at():
    assert sorted(VERDICTS) == sorted([*SOUND, *CAUSES, *NO_MODEL])
    for name, verdict in VERDICTS.items():
        assert name not in SOUND or (verdict["exit"], verdict["messages"]) == (0, [])


@pytest.mark.parametrize("name", sorted(set(VERDICTS) - NO_MODEL))
def test_each_complaint_is_told(name):
    found = told(vector(name))
    for message in VERDICTS[name]["messages"]:
        if FURTHER.match(message):
            continue
        (match, rules), *_ = [(match, rules) for pattern, rules in COMPLAINTS if (match := re.search(pattern, message))]
        parts = [re.sub("ExecutionNeed", "execution need", part) for part in match.groups()]
        assert any(finding.rule in rules and all(part in finding.message for part in parts) for finding in found), message


#: Rules on losses that the table of constraints does not list.
BESIDE_THE_TABLE = {
    *("INC-IO-RANGE", "INC-OS-CONSISTENCY", "INC-SW-GROUPNAME", "INC-SW-LIMIT", "INC-SW-STABILITY", "INC-SW-TICKS-STAT"),
}


@pytest.mark.skipif(not TABLE.exists(), reason="the reference table is not at hand")
def test_there_is_a_rule_for_each_row():
    rows = re.findall(r"^\| (INC-[A-Z-]+) \|", TABLE.read_text(), re.MULTILINE)
    assert sorted([*rows, *BESIDE_THE_TABLE]) == sorted(RULES)


# An error means that the importer refuses the model, crashes at it or writes a broken one, everything else is a warning.


def errors(model):
    return {finding.rule for finding in check(model, RULES) if finding.severity is Severity.ERROR}


@pytest.mark.parametrize("name", sorted(set(VERDICTS) - NO_MODEL))
def test_an_error_is_what_the_importer_fails_at(name):
    found = check(vector(name), RULES)
    assert any(each.severity is Severity.ERROR for each in found) == (VERDICTS[name]["exit"] != 0)
    assert {each.effect for each in found if each.severity is Severity.ERROR} <= {ToolEffect.FAILS}
    assert not {each.effect for each in found if each.severity is not Severity.ERROR} & {None, ToolEffect.FAILS}


#: What the importer makes of the object of a rule, as projects that it wrote show.
SEEN = {
    ToolEffect.CHANGES: (
        "20_ticks_beta",
        "20_ticks_bounds_default",
        "20_ticks_stat",
        "22_label_undef",
        "25_switch_num_lt",
    ),
    ToolEffect.DROPS: (
        "10_chain_par_badresp",
        "21_execneed",
        "23_channel",
        "31_variablerate",
        "44_prio_wrongname",
        "70_unknown_attr",
    ),
    ToolEffect.KEEPS: ("25_switch_nocond", "27_runnable_nograph", "23_semaphore_undef"),
}


@pytest.mark.parametrize(("effect", "name"), [(effect, name) for effect, names in SEEN.items() for name in names])
def test_the_effect_is_what_the_importer_makes_of_the_object(effect, name):
    own = CAUSES[name] - MODES - EVENTS - {"INC-ST-ORDER"}
    assert {finding.effect for finding in told(vector(name)) if finding.rule in own} == {effect}


#: Rules with errors that no vector shows, and what was seen instead.
SEEN_ELSEWHERE = {
    "INC-EC-CYCLE": "a chain that refers to itself crashed",
    "INC-EC-ENDS": "a chain with items but without a stimulus of its own crashed; the vector has no items",
    "INC-EC-PAR-ITEMS": "exit 0, with a barrier that nothing leads to",
    "INC-EC-SET": "failed assertions at segments; exit 0, with a graph without a start, at an end",
    "INC-HW-CACHE-PLACE": "a cache in a structure without cores crashed",
    "INC-HW-FREQ-VALUE": "two cores of a domain without a value crashed",
    "INC-IO-SAMEVERSION": "two files of 2.2 and 3.2 were refused; each vector is one file",
    "INC-IO-SUBMODEL-ONCE": "two software models crashed, or the tasks of one were gone; each vector is one file",
    "INC-IO-VERSION": "700 of 782 files of ITEA 1.1 to AMALTHEA 1.1 were refused; the vectors are newer than 0.9.7, and pass",
    "INC-SW-SERVER": "calls and accesses without a target were refused",
}


@pytest.mark.skipif(not VERDICTS, reason="the verdicts are not at hand")
def test_each_rule_with_errors_rests_on_something_seen():
    failing = [name for name in set(VERDICTS) - NO_MODEL if VERDICTS[name]["exit"]]
    shown = set().union(*(errors(vector(name)) for name in failing))
    assert not shown & set(SEEN_ELSEWHERE)
    assert shown | set(SEEN_ELSEWHERE) == {rule for rule in RULES if registry.kind(rule).severity is Severity.ERROR}


# What no vector shows


def graph(items, more=""):
    """A runnable that consists of items."""
    return f'<swModel><runnables name="R"><activityGraph>{items}</activityGraph></runnables>{more}</swModel>'


def ticks(content):
    return graph(f'<items t="Ticks">{content}</items>')


def condition(entry, more=""):
    return graph(
        f'<items t="Switch"><entries name="e"><condition>{entry}</condition></entries></items>',
        '<modes t="EnumMode" name="M"><literals name="on"/><literals name="off"/></modes>'
        '<modes t="NumericMode" name="N"/>'
        '<modeLabels name="ML" mode="M?type=EnumMode"/><modeLabels name="OL" mode="M?type=EnumMode"/>'
        f'<modeLabels name="NL" mode="N?type=NumericMode"/><modeLabels name="No"/><channels name="C"/>{more}',
    )


def value(label, text):
    return condition(f'<entries t="ModeValueCondition" label="{label}?type=ModeLabel" value="{text}" relation="EQUAL"/>')


def labels(first, second):
    names = f'label1="{first}?type=ModeLabel" label2="{second}?type=ModeLabel"'
    return condition(f'<entries t="ModeLabelCondition" {names} relation="EQUAL"/>')


def access(label, attributes):
    more = condition("").partition("</runnables>")[2].removesuffix("</swModel>")
    return graph(f'<items t="ModeLabelAccess" data="{label}?type=ModeLabel" {attributes}/>', more)


def cores(domain, *names):
    modules = "".join(f'<modules t="ProcessingUnit" name="{n}" frequencyDomain="D?type=FrequencyDomain"/>' for n in names)
    return f'<hwModel><structures name="ECU">{modules}</structures>{domain}</hwModel>'


def domain(content=""):
    return f'<domains t="FrequencyDomain" name="D">{content}</domains>'


def structure(name, *inner):
    return f'<structures name="{name}">{"".join(inner)}</structures>'


def core(name):
    return f'<modules t="ProcessingUnit" name="{name}"/>'


def scheduler(content, more=""):
    system = f'<operatingSystems name="OS"><taskSchedulers name="S">{content}</taskSchedulers></operatingSystems>'
    return f"<osModel>{system}{more}</osModel>"


def parameter(name, content):
    key = f' key="{name}?type=SchedulingParameterDefinition"' if name else ""
    return f"<schedulingParameters{key}>{content}</schedulingParameters>"


def allocation(name, content):
    """A task with a scheduling parameter."""
    defined = f'<osModel><schedulingParameterDefinitions name="{name}"/></osModel>' if name else ""
    mapped = f'<taskAllocation task="T?type=Task">{parameter(name, content)}</taskAllocation>'
    return f'<swModel><tasks name="T"/></swModel>{defined}<mappingModel>{mapped}</mappingModel>'


PRIORITY, DEADLINE = (f'<schedulingParameterDefinitions name="{name}"/>' for name in ("priority", "deadline"))
BELOW = '<parentAssociation parent="S?type=TaskScheduler">{}</parentAssociation>'
INTEGER = '<value t="IntegerObject" value="3"/>'
LONG = '<value t="LongObject" value="3"/>'


def stimulus(kind, content="", attributes=""):
    return f'<stimuliModel><stimuli t="{kind}" name="S" {attributes}>{content}</stimuli></stimuliModel>'


def distance(content):
    return stimulus("RelativePeriodicStimulus", content)


def events(constraints, more=""):
    """Three events that are converted, and what is said of them."""
    return (
        '<swModel><tasks name="T"/><isrs name="I"/><runnables name="R"/><labels name="L"/></swModel><eventModel>'
        '<events t="ProcessEvent" name="a" entity="T?type=Task" eventType="start"/>'
        '<events t="RunnableEvent" name="b" entity="R?type=Runnable" eventType="terminate"/>'
        '<events t="LabelEvent" name="c" entity="L?type=Label" eventType="read"/>'
        '<events t="ProcessEvent" name="odd" entity="I?type=ISR" eventType="resume"/>'
        f"{more}</eventModel><constraintsModel>{constraints}</constraintsModel>"
    )


IDS = {"a": "a?type=ProcessEvent", "b": "b?type=RunnableEvent", "c": "c?type=LabelEvent", "odd": "odd?type=ProcessEvent"}


def chain(ends, *items, name="C", attributes=""):
    """A chain between two events, such as "ab"."""
    first, last = ends
    stimulus_, response = (
        f'{key}="{IDS.get(end, end)}"' if end else "" for key, end in (("stimulus", first), ("response", last))
    )
    return f'<eventChains name="{name}" {attributes} {stimulus_} {response}>{"".join(items)}</eventChains>'


def segment(ends, *items):
    inner = chain(ends, *items, name="s").replace("<eventChains", "<eventChain").replace("</eventChains", "</eventChain")
    return f'<items t="EventChainContainer">{inner}</items>'


def reference(name):
    return f'<items t="EventChainReference" eventChain="{name}?type=EventChain"/>'


PARALLEL = 'itemType="parallel"'
LATENCY = '<timingConstraints t="EventChainLatencyConstraint" name="LC" scope="C?type=EventChain"/>'
SET = '<events t="EventSet" name="set" events="a?type=ProcessEvent odd?type=ProcessEvent"/>'
BAD_SET = "set?type=EventSet"


def server(policy, is_server="true"):
    kind = f'<customProperties key="callbackServer"><value t="BooleanObject" value="{is_server}"/></customProperties>'
    dispatched = f'<customProperties key="dispatchingPolicy">{policy}</customProperties>'
    group = f'<activityGraph><items t="Group" name="G">{dispatched}</items></activityGraph>'
    return f'<swModel><tasks name="T">{kind}{group}</tasks></swModel>'


def text(content):
    return f'<value t="StringObject" value="{content}"/>'


def stated(content):
    return f'<swModel><labels name="L"><customProperties key="k">{content}</customProperties></labels></swModel>'


def ports(content):
    return f'<hwModel><structures name="ECU">{content}</structures></hwModel>'


def mapped(element):
    mapping = f'<memoryMapping abstractElement="{element}" memory="RAM?type=Memory"/>'
    software = '<swModel><runnables name="R"/><labels name="L"/></swModel>'
    return f"{software}{ports(MEMORY.format(''))}<mappingModel>{mapping}</mappingModel>"


def consistent(attributes, content=""):
    system = f'<operatingSystems name="OS"><osDataConsistency {attributes}>{content}</osDataConsistency></operatingSystems>'
    return f"<osModel>{system}</osModel>"


MEMORY = '<modules t="Memory" name="RAM"><ports name="p" {}/></modules>'

#: Rule, how often it tells something, and of what.
CASES = [
    # Several processing units of one domain without a value: a crash. One of them: 1000 MHz.
    ("INC-HW-FREQ-VALUE", 1, cores(domain(), "A", "B")),
    ("INC-HW-FREQ-VALUE", 1, cores(domain(), "A")),
    ("INC-HW-FREQ-VALUE", 1, cores(domain('<defaultValue value="0" unit="MHz"/>'), "A")),
    ("INC-HW-FREQ-VALUE", 1, cores(domain('<defaultValue value="9" unit="_undefined_"/>'), "A")),
    ("INC-HW-FREQ-VALUE", 0, cores(domain('<defaultValue value="9" unit="MHz"/>'), "A", "B")),
    ("INC-HW-FREQ-VALUE", 0, cores(domain())),
    ("INC-HW-CACHE-PLACE", 1, ports('<modules t="Cache" name="L2"/>')),
    ("INC-HW-CACHE-PLACE", 1, ports('<modules t="Cache" name="L2"/>' + structure("uC", core("A")))),
    ("INC-HW-CACHE-PLACE", 0, ports(core("A") + '<modules t="Cache" name="L2"/>')),
    # Nesting that says nothing: around one CPU, or around all of them.
    ("INC-HW-PU-STRUCT", 0, ports(structure("uC", core("A"), core("B")))),
    ("INC-HW-PU-STRUCT", 0, ports(structure("u1", core("A")) + structure("u2", core("B")))),
    (
        "INC-HW-PU-STRUCT",
        1,
        ports(structure("g", structure("u1", core("A")), structure("u2", core("B"))) + structure("u3", core("C"))),
    ),
    ("INC-HW-PU-STRUCT", 1, ports(structure("u1", core("A"), structure("u2", core("B"))))),
    # Ports of structures are not converted, those of modules are, if they have a type.
    ("INC-HW-BITWIDTH", 0, ports('<ports name="p"/>')),
    ("INC-HW-BITWIDTH", 1, ports(MEMORY.format('portType="responder"'))),
    ("INC-HW-BITWIDTH", 0, ports(MEMORY.format('portType="responder" bitWidth="32"'))),
    ("INC-HW-CONN-PORTS", 1, ports(MEMORY.format('bitWidth="32"'))),
    ("INC-HW-CONN-PORTS", 0, ports(MEMORY.format('portType="responder"') + '<ports name="p"/>')),
    ("INC-HW-MEM-SIZE", 1, ports('<modules t="Memory" name="RAM"/>')),
    (
        "INC-HW-ACCESS",
        1,
        '<hwModel><definitions t="MemoryDefinition" name="D">'
        '<accessLatency t="DiscreteValueConstant" value="9"/></definitions></hwModel>',
    ),
    ("INC-HW-ACCESS", 0, '<hwModel><definitions t="MemoryDefinition" name="D"/></hwModel>'),
    # Scheduling parameters, by where they stand.
    ("INC-OS-PARAM-KEY", 1, scheduler(parameter("", INTEGER))),
    ("INC-OS-PARAM-KEY", 0, allocation("", INTEGER)),
    ("INC-OS-ALGOPARAM", 1, allocation("", INTEGER)),
    ("INC-OS-ALGOPARAM", 0, scheduler(parameter("", INTEGER))),
    ("INC-OS-ALGOPARAM", 1, allocation("Priority", INTEGER)),
    ("INC-OS-ALGOPARAM", 0, allocation("deadline", '<value t="Time" value="3" unit="ms"/>')),
    ("INC-OS-ALGOPARAM", 1, scheduler(parameter("deadline", INTEGER), DEADLINE)),
    ("INC-OS-ALGOPARAM", 0, scheduler(parameter("priority", INTEGER), PRIORITY)),
    ("INC-OS-ALGOPARAM", 1, scheduler(BELOW.format(parameter("priority", INTEGER)), PRIORITY)),
    ("INC-OS-PRIO-TYPE", 1, allocation("priority", LONG)),
    ("INC-OS-PRIO-TYPE", 1, allocation("priority", "")),
    ("INC-OS-PRIO-TYPE", 1, scheduler(parameter("priority", LONG), PRIORITY)),
    ("INC-OS-PRIO-TYPE", 0, scheduler(BELOW.format(parameter("priority", LONG)), PRIORITY)),
    ("INC-OS-DEADLINE-TYPE", 1, allocation("deadline", INTEGER)),
    ("INC-OS-DEADLINE-TYPE", 0, scheduler(parameter("deadline", INTEGER), DEADLINE)),
    # Overheads without Ticks are harmless.
    ("INC-OS-OVERHEAD", 0, '<osModel><osOverheads name="O"><apiOverhead/></osOverheads></osModel>'),
    (
        "INC-OS-OVERHEAD",
        1,
        '<osModel><osOverheads name="O"><apiOverhead><apiActivateTask/></apiOverhead></osOverheads></osModel>',
    ),
    ("INC-OS-OVERHEAD", 1, scheduler('<computationItems t="LabelAccess"/>')),
    ("INC-OS-SEMA-TYPE", 0, '<osModel><semaphores name="S" semaphoreType="_undefined_" ownership="false"/></osModel>'),
    # The default of the ownership is true, so that canonical form, which states it, means the same.
    ("INC-OS-SEMA-TYPE", 1, '<osModel><semaphores name="S" ownership="true"/></osModel>'),
    ("INC-OS-SEMA-TYPE", 1, '<osModel><semaphores name="S"/></osModel>'),
    ("INC-OS-SEMA-TYPE", 1, '<osModel><semaphores name="S" priorityCeilingProtocol="true"/></osModel>'),
    ("INC-MAP-SCHED", 1, "<mappingModel><schedulerAllocation/></mappingModel>"),
    (
        "INC-MAP-SCHED",
        1,
        scheduler("") + '<mappingModel><schedulerAllocation scheduler="S?type=TaskScheduler"/></mappingModel>',
    ),
    ("INC-MAP-MEMORY", 1, mapped("R?type=Runnable")),
    ("INC-MAP-MEMORY", 0, mapped("L?type=Label")),
    # Stimuli
    ("INC-ST-TYPE", 1, stimulus("ArrivalCurveStimulus")),
    ("INC-ST-TYPE", 1, stimulus("EventStimulus")),
    ("INC-ST-TYPE", 0, stimulus("InterProcessStimulus")),
    ("INC-ST-BURST", 0, stimulus("PeriodicBurstStimulus")),
    ("INC-ST-BURST", 1, stimulus("PeriodicBurstStimulus", '<occurrenceMinDistance value="9"/>', 'occurrenceCount="0"')),
    (
        "INC-ST-BURST",
        0,
        stimulus("PeriodicBurstStimulus", '<occurrenceMinDistance value="9" unit="ms"/>', 'occurrenceCount="0"'),
    ),
    ("INC-ST-PERIOD", 1, stimulus("PeriodicSyntheticStimulus", '<recurrence value="0" unit="ms"/>')),
    ("INC-ST-PERIOD", 1, stimulus("PeriodicStimulus", '<recurrence value="9" unit="_undefined_"/>')),
    ("INC-ST-RELPER", 1, distance('<nextOccurrence t="TimeConstant"/>')),
    ("INC-ST-RELPER", 0, distance('<nextOccurrence t="TimeGaussDistribution"/>')),
    ("INC-ST-JITTER", 1, stimulus("PeriodicStimulus", '<jitter t="TimeGaussDistribution"/>')),
    ("INC-ST-JITTER", 1, stimulus("PeriodicStimulus", '<jitter t="TimeHistogram"/>')),
    ("INC-ST-JITTER", 0, stimulus("PeriodicStimulus", '<jitter t="TimeConstant"/>')),
    # Ticks: only what is read of them matters.
    ("INC-SW-TICKS-DEFAULT", 1, ticks("")),
    ("INC-SW-TICKS-DEFAULT", 1, ticks('<extended><value t="DiscreteValueConstant" value="1"/></extended>')),
    ("INC-SW-TICKS-DEFAULT", 1, ticks('<default t="DiscreteValueConstant"/><extended/>')),
    ("INC-SW-TICKS-DEFAULT", 0, ticks('<default t="DiscreteValueConstant"/>')),
    ("INC-SW-TICKS-BETA", 1, ticks('<extended><value t="DiscreteValueBetaDistribution"/></extended>')),
    ("INC-SW-TICKS-BETA", 0, ticks('<extended/><extended><value t="DiscreteValueBetaDistribution"/></extended>')),
    (
        "INC-SW-TICKS-BETA",
        0,
        ticks('<default t="DiscreteValueConstant"/><extended><value t="DiscreteValueBetaDistribution"/></extended>'),
    ),
    (
        "INC-SW-TICKS-BOUNDS",
        0,
        graph('<items t="ExecutionNeed"><needs key="k"><value t="DiscreteValueBoundaries"/></needs></items>'),
    ),
    ("INC-SW-TICKS-GAUSS", 1, ticks('<default t="DiscreteValueGaussDistribution" lowerBound="1"/>')),
    ("INC-SW-TICKS-INT", 2, ticks('<default t="DiscreteValueGaussDistribution" mean="1.5" sd="0.5"/>')),
    ("INC-SW-TICKS-INT", 1, ticks('<default t="DiscreteValueWeibullEstimatorsDistribution" average="1.5"/>')),
    ("INC-SW-TICKS-INT", 0, ticks('<default t="DiscreteValueGaussDistribution" mean="2" sd="1"/>')),
    ("INC-SW-TICKS-INT", 0, ticks('<default t="DiscreteValueBetaDistribution" alpha="1.5" beta="0.5"/>')),
    # Items
    ("INC-SW-REF", 1, graph('<items t="SetEvent"/>')),
    ("INC-SW-REF", 1, graph('<items t="ModeLabelAccess" access="read"/>')),
    ("INC-SW-REF", 0, '<swModel><processPrototypes name="P"><runnableCalls/></processPrototypes></swModel>'),
    ("INC-SW-EVENTMASK", 1, graph('<items t="WaitEvent"><eventMask/></items>')),
    ("INC-SW-SERVER", 1, graph('<items t="GetResultServerCall"/>')),
    ("INC-SW-SERVER", 1, graph('<items t="SenderReceiverRead"/>')),
    ("INC-SW-SERVER", 1, graph('<items t="SenderReceiverWrite"/>')),
    ("INC-SW-SERVER", 0, graph('<items t="SenderReceiverRead" label="L?type=Label"/>', '<labels name="L"/>')),
    ("INC-SW-ACCESS", 1, graph('<items t="SemaphoreAccess" access="request"/>')),
    ("INC-SW-ACCESS", 1, access("ML", 'access="increment"')),
    ("INC-SW-ACCESS", 0, access("NL", 'access="increment"')),
    ("INC-SW-ACCESS", 1, access("NL", "")),
    ("INC-SW-ACCESS", 0, access("ML", 'access="read"')),
    ("INC-SW-PROCCHAIN", 1, '<swModel><sections name="S"/></swModel>'),
    ("INC-SW-PROCCHAIN", 1, '<componentsModel><components name="C"/></componentsModel>'),
    ("INC-SW-PROCCHAIN", 1, stimulus("VariableRateStimulus", "<scenario/>")),
    # Conditions and modes
    ("INC-SW-CONDKIND", 1, condition('<entries t="ChannelFillCondition"/>')),
    ("INC-SW-CONDKIND", 1, condition('<entries t="LocalModeCondition"/>')),
    ("INC-SW-CONDKIND", 1, condition('<entries t="ModeValueCondition" value="on"/>')),
    ("INC-SW-CONDKIND", 1, condition('<entries t="ModeLabelCondition" label1="ML?type=ModeLabel"/>')),
    ("INC-SW-CONDKIND", 1, labels("ML", "NL")),
    ("INC-SW-CONDKIND", 1, labels("NL", "No")),
    ("INC-SW-CONDKIND", 0, labels("No", "NL")),
    ("INC-SW-CONDKIND", 0, labels("ML", "OL")),
    ("INC-SW-CONDKIND", 0, value("ML", "on")),
    ("INC-SW-CONDSET", 1, condition("")),
    ("INC-SW-CONDSET", 1, graph('<items t="WhileLoop"/>')),
    ("INC-SW-CONDSET", 0, value("ML", "on")),
    ("INC-SW-MODE-VALUE", 0, value("ML", "on")),
    ("INC-SW-MODE-VALUE", 1, value("ML", "up")),
    ("INC-SW-MODE-VALUE", 1, value("ML", "")),
    ("INC-SW-MODE-VALUE", 0, value("NL", "-3")),
    ("INC-SW-MODE-VALUE", 1, value("NL", "3.5")),
    ("INC-SW-MODE-VALUE", 1, value("NL", "2147483648")),
    ("INC-SW-MODE-VALUE", 0, value("NL", "2147483647")),
    ("INC-SW-MODE-VALUE", 0, access("ML", 'access="set" value="off"')),
    ("INC-SW-MODE-VALUE", 1, access("ML", 'access="set" value="up"')),
    ("INC-SW-MODE-VALUE", 0, access("NL", 'access="set" value="up"')),
    ("INC-SW-MODE-NUMSET", 1, access("NL", 'access="set" value="5"')),
    ("INC-SW-MODE-NUMSET", 0, access("NL", 'access="decrement" step="5"')),
    ("INC-SW-MODE-NUMSET", 0, access("ML", 'access="set" value="on"')),
    # Custom properties matter in tasks that are callback servers, and in their groups.
    ("INC-SW-DISPATCH", 1, server(text("random"))),
    ("INC-SW-DISPATCH", 1, server(INTEGER)),
    ("INC-SW-DISPATCH", 0, server(text("Priority"))),
    ("INC-SW-DISPATCH", 0, server(text("random"), "false")),
    # Constraints
    ("INC-CO-KIND", 1, '<constraintsModel><dataCoherencyGroups name="G"/></constraintsModel>'),
    ("INC-CO-KIND", 1, '<constraintsModel><dataStabilityGroups name="G"/></constraintsModel>'),
    ("INC-CO-KIND", 1, '<constraintsModel><physicalSectionConstraints name="P"/></constraintsModel>'),
    ("INC-CO-KIND", 0, '<constraintsModel><timingConstraints t="EventChainLatencyConstraint" name="L"/></constraintsModel>'),
    # Events and chains; one with an event that is not converted is dropped, and its latency with it.
    ("INC-EV-KIND", 1, events("", '<events t="SemaphoreEvent" name="s"/>')),
    ("INC-EV-KIND", 1, events("", '<events t="ModeLabelEvent" name="s"/>')),
    ("INC-EV-KIND", 0, events(chain("ab"))),
    ("INC-EV-KIND", 2, events(chain(("s?type=CustomEvent", "s?type=CustomEvent")), '<events t="CustomEvent" name="s"/>')),
    ("INC-EV-TYPE", 1, events(chain("ab"))),
    ("INC-EV-TYPE", 2, events(chain(("a", "odd")))),
    ("INC-EV-TYPE", 2, events(chain(("a", BAD_SET)), SET)),
    ("INC-EV-TYPE", 2, events(chain("ab", segment(("a", "odd")), segment(("odd", "b"))))),
    ("INC-EV-TYPE", 1, events(chain("ab", segment(("a", "odd")), segment("cb")))),
    ("INC-EV-LABEL-RUN", 1, events("", '<events t="LabelEvent" name="l" runnable="R?type=Runnable"/>')),
    ("INC-EC-CYCLE", 2, events(chain("ab", reference("D")) + chain("ab", reference("C"), name="D"))),
    (
        "INC-EC-CYCLE",
        3,
        events(chain("ab", reference("C")) + chain("ab", reference("C"), name="D") + chain("ab", reference("D"), name="E")),
    ),
    ("INC-EC-CYCLE", 1, events(chain("ab", segment("ab", reference("C"))))),
    ("INC-EC-CYCLE", 0, events(chain("ab", reference("D"), reference("D")) + chain("ab", name="D"))),
    ("INC-EC-SEQ", 0, events(chain("ab", segment("ac"), segment("cb")))),
    ("INC-EC-SEQ", 1, events(chain("ab", segment("ac"), segment("cc")))),
    ("INC-EC-SEQ", 1, events(chain("ab", segment("cb"), attributes=PARALLEL))),
    ("INC-EC-SEQ", 1, events(chain("ab", '<items t="EventChainReference"/>'))),
    ("INC-EC-SEQ", 0, events(chain("ab", segment("cb"), segment("cb"), attributes=PARALLEL))),
    ("INC-EC-PAR", 0, events(chain("ab", segment("cb"), attributes=PARALLEL))),
    ("INC-EC-PAR", 2, events(chain("ab", segment("cb"), segment("ac"), attributes=PARALLEL))),
    ("INC-EC-PAR", 1, events(chain("ab", segment("ab"), '<items t="EventChainReference"/>', attributes=PARALLEL))),
    ("INC-EC-PAR-ITEMS", 0, events(chain("ab", segment("ab"), attributes=PARALLEL))),
    ("INC-EC-PAR-ITEMS", 2, events(chain("ab", segment("ab"), segment("ab"), attributes=PARALLEL))),
    ("INC-EC-SEQ", 0, events(chain("ab", reference("X")))),
    ("INC-LC-SCOPE", 0, events(chain("ab") + LATENCY)),
    ("INC-LC-SCOPE", 1, events(LATENCY)),
    ("INC-LC-SCOPE", 1, events(chain("ab", reference("X")) + LATENCY)),
    ("INC-LC-SCOPE", 1, events(chain(("x?type=EventSet", "b")) + LATENCY)),
    ("INC-LC-SCOPE", 1, events(chain(("a", "")) + LATENCY)),
    ("INC-LC-SCOPE", 1, events(chain(("a", "odd")) + LATENCY)),
    ("INC-LC-SCOPE", 1, events(chain(("a", BAD_SET)) + LATENCY, SET)),
    ("INC-LC-SCOPE", 1, events(chain("ab", segment("ac"), segment(("odd", "b"))) + LATENCY)),
    ("INC-LC-SCOPE", 0, events(chain("ab", segment(("odd", "c")), segment("cb")) + LATENCY)),
    ("INC-LC-SCOPE", 1, events(chain("ab", segment("ac", segment(("a", ""))), segment("cb")) + LATENCY)),
    ("INC-LC-SCOPE", 1, events(chain("ab", segment("ab"), segment("ac"), attributes=PARALLEL) + LATENCY)),
    ("INC-LC-SCOPE", 1, events(chain("ab", reference("D")) + chain(("a", ""), name="D") + LATENCY)),
    # How data is protected
    ("INC-SW-STABILITY", 1, graph('<items t="LabelAccess" dataStability="customProtection"/>')),
    ("INC-SW-STABILITY", 0, graph('<items t="LabelAccess" dataStability="inherited"/>')),
    ("INC-SW-STABILITY", 1, '<swModel><labels name="L" dataStability="handledByModelElements"/></swModel>'),
    ("INC-SW-STABILITY", 0, '<swModel><labels name="L"/></swModel>'),
    ("INC-OS-CONSISTENCY", 1, consistent('mode="customProtection"')),
    ("INC-OS-CONSISTENCY", 1, consistent("", '<dataStability enabled="true"/>')),
    ("INC-OS-CONSISTENCY", 0, consistent("")),
    # Names
    (
        "INC-IO-NAME",
        2,
        '<commonElements><namespaces name="A"/><namespaces name="B"/></commonElements><swModel>'
        '<labels name="L" namespace="A?type=Namespace"/><labels name="L" namespace="B?type=Namespace"/></swModel>',
    ),
    (
        "INC-IO-NAME",
        0,
        '<commonElements><namespaces name="A"/></commonElements><swModel>'
        '<labels name="L" namespace="A?type=Namespace"/><labels name="M" namespace="A?type=Namespace"/></swModel>',
    ),
    # What the metamodel knows
    ("INC-IO-FEATURE", 1, '<swModel><tasks name="T" prio="1"/></swModel>'),
    ("INC-IO-FEATURE", 1, '<swModel><tasks name="T" preemption="never"/></swModel>'),
    ("INC-IO-FEATURE", 1, graph('<items t="Sleep"/>')),
    ("INC-IO-FEATURE", 1, graph('<items t="Task"/>')),
    ("INC-IO-FEATURE", 1, graph("<items/>")),
    ("INC-IO-FEATURE", 0, '<swModel xmlns:x="y"><!-- a comment --><?and an instruction?></swModel>'),
    ("INC-IO-FEATURE", 0, '<swModel><channels name="C"><elementType t="TypeRef"/></channels></swModel>'),
    ("INC-IO-FEATURE", 0, stated('<value t="MapObject"/>')),
]


@pytest.mark.parametrize(("rule", "times", "excerpt"), CASES, ids=[f"{rule}-{i}" for i, (rule, *_) in enumerate(CASES)])
def test_a_case(rule, times, excerpt, tmp_path):
    assert len(check(model(excerpt, tmp_path), [rule])) == times


NOTHING = '<events t="EventSet" name="set"/>'
ONE = NOTHING.replace("/>", ' events="b?type=RunnableEvent"/>')
TWO = NOTHING.replace("/>", ' events="a?type=ProcessEvent b?type=RunnableEvent"/>')


def at_segment(first="a", later=BAD_SET):
    """A chain of two segments, with the stimuli of both."""
    return chain("ab", segment((first, "c")), segment((later, "b")))


def allocated(attributes):
    return (
        '<swModel><tasks name="T"/></swModel><osModel><operatingSystems name="OS"><taskSchedulers name="S"/></operatingSystems>'
        f"</osModel><mappingModel><taskAllocation {attributes}/></mappingModel>"
    )


@pytest.mark.parametrize(
    ("rule", "severities", "excerpt"),
    [
        # Chains without an end of their own: those with items are read as if they had one.
        ("INC-EC-ENDS", ["error"], events(chain(("", "b"), segment("ab")))),
        ("INC-EC-ENDS", ["error"], events(chain(("a", ""), reference("D")) + chain("ab", name="D"))),
        ("INC-EC-ENDS", ["warning"], events(chain(("", "b")))),
        ("INC-EC-ENDS", ["warning"], events(chain("ab", segment(("", "c")), segment("cb")))),
        # Sets: of the ends, and of the stimuli of later segments, which are all that is read of segments.
        ("INC-EC-SET", ["error"], events(chain(("a", BAD_SET)), NOTHING)),
        ("INC-EC-SET", ["error"], events(chain((BAD_SET, "b")), NOTHING)),
        ("INC-EC-SET", ["warning"], events(chain((BAD_SET, "b")), TWO)),
        ("INC-EC-SET", [], events(chain(("a", BAD_SET)), ONE)),
        ("INC-EC-SET", ["error"], events(at_segment(), NOTHING)),
        ("INC-EC-SET", [], events(at_segment(), TWO)),
        ("INC-EC-SET", ["error"], events(chain("ab", segment("ac"), segment((BAD_SET, "b"), segment("cb"))), TWO)),
        ("INC-EC-SET", [], events(at_segment(), ONE)),
        ("INC-EC-SET", [], events(at_segment(BAD_SET, "c"), NOTHING)),
        # A set with an event that is not converted: the chain is dropped before.
        ("INC-EC-SET", [], events(at_segment(), SET)),
        ("INC-EC-SET", [], events(at_segment())),
        # Branches without items break the graph, unless the chain is dropped.
        ("INC-EC-PAR-ITEMS", ["error", "error"], events(chain("ab", segment("ab"), segment("ab"), attributes=PARALLEL))),
        ("INC-EC-PAR-ITEMS", ["warning", "warning"], events(chain("ab", segment("ab"), segment("ac"), attributes=PARALLEL))),
        ("INC-MAP-TASK", ["error"], allocated('scheduler="S?type=TaskScheduler"')),
        ("INC-MAP-TASK", ["warning"], allocated('task="T?type=Task"')),
        ("INC-ST-RELPER", ["error"], distance('<nextOccurrence t="TimeConstant"/>')),
        ("INC-ST-RELPER", ["warning"], distance("")),
        ("INC-IO-FEATURE", ["warning"], '<swModel><tasks name="T" prio="1"/></swModel>'),
        ("INC-IO-FEATURE", ["error"], '<swModel><tasks name="T" preemption="never"/></swModel>'),
        ("INC-IO-FEATURE", ["error"], '<swModel><threads name="T"/></swModel>'),
        # References that lead to nothing, by feature.
        ("INC-IO-REF", ["error"], graph('<items t="RunnableCall" runnable="X?type=Runnable"/>')),
        ("INC-IO-REF", ["error"], graph('<items t="LabelAccess" data="X?type=Label"/>')),
        ("INC-IO-REF", ["error"], value("X", "on")),
        ("INC-IO-REF", ["error"], cores("", "A")),
        ("INC-IO-REF", ["error"], allocated('task="X?type=Task"')),
        # A process without a stimulus is only not activated.
        ("INC-IO-REF", ["warning"], '<swModel><tasks name="T" stimuli="S?type=SingleStimulus"/></swModel>'),
        # What is not a number is read as another one, what is not a literal is refused.
        ("INC-IO-FEATURE", ["warning"], '<swModel><tasks name="T" multipleTaskActivationLimit="many"/></swModel>'),
        ("INC-IO-FEATURE", ["error"], '<swModel><tasks name="T" preemption="sometimes"/></swModel>'),
        # Numbers of 32 bits end at 2147483647, those of 64 bits at 9223372036854775807.
        ("INC-IO-RANGE", [], '<swModel><tasks name="T" multipleTaskActivationLimit="2147483647"/></swModel>'),
        ("INC-IO-RANGE", ["warning"], '<swModel><tasks name="T" multipleTaskActivationLimit="2147483648"/></swModel>'),
        ("INC-IO-RANGE", ["warning"], allocation("priority", '<value t="IntegerObject" value="-2147483649"/>')),
        ("INC-IO-RANGE", [], stimulus("PeriodicStimulus", '<recurrence value="9223372036854775807" unit="ps"/>')),
        ("INC-IO-RANGE", ["warning"], stimulus("PeriodicStimulus", '<recurrence value="9223372036854775808" unit="ps"/>')),
        ("INC-IO-RANGE", ["warning"], ticks('<default t="DiscreteValueConstant" value="9223372036854775808"/>')),
        (
            "INC-IO-RANGE",
            ["warning"],
            '<swModel><labels name="L"><size value="9223372036854775808" unit="B"/></labels></swModel>',
        ),
        ("INC-SW-GROUPNAME", ["info"], graph('<items t="Group" name="G"><items t="Switch"/></items>')),
        ("INC-SW-GROUPNAME", ["info"], graph('<items t="Group" name="G"><items t="Group" name="H"/></items>')),
        ("INC-SW-GROUPNAME", [], graph('<items t="Group" name="G"><items t="Ticks"/><items t="Switch"/></items>')),
        # The first call of the sequence suspends interrupts.
        ("INC-SW-GROUPNAME", [], graph('<items t="Group" name="G" interruptible="false"><items t="Switch"/></items>')),
        ("INC-IO-REF", ["error"], '<mappingModel><memoryMapping abstractElement="X?type=Label"/></mappingModel>'),
        ("INC-IO-REF", ["error"], events(chain(("x?type=ProcessEvent", "b")))),
        ("INC-IO-REF", ["error"], events(chain(("a", "x?type=ProcessEvent")))),
        ("INC-IO-REF", ["warning"], allocated('task="T?type=Task" scheduler="X?type=TaskScheduler"')),
        ("INC-IO-REF", ["warning"], allocated('task="T?type=Task" affinity="X?type=ProcessingUnit"')),
        ("INC-IO-REF", ["warning"], ports('<modules t="Memory" name="RAM" definition="X?type=MemoryDefinition"/>')),
        ("INC-IO-REF", ["warning"], f"<mappingModel><taskAllocation>{parameter('X', INTEGER)}</taskAllocation></mappingModel>"),
        ("INC-IO-REF", ["warning"], events("", '<events t="ProcessEvent" name="e" entity="X?type=Task" eventType="start"/>')),
        # A parameter of a scheduler, unlike one of an allocation, has to have a key.
        ("INC-IO-REF", ["error"], scheduler(parameter("X", INTEGER))),
    ],
)
def test_a_severity(rule, severities, excerpt, tmp_path):
    assert [finding.severity.value for finding in check(model(excerpt, tmp_path), [rule])] == severities


@pytest.mark.parametrize(("version", "severity"), [("0.9.6", "error"), ("0.9.7", "warning"), ("1.1.0", "warning")])
def test_files_before_the_oldest_metamodel(version, severity, tmp_path):
    (finding,) = check(model("<swModel/>", tmp_path, version), ["INC-IO-VERSION"])
    assert finding.severity.value == severity


def test_no_object_is_called_none(tmp_path):
    nameless = "<swModel><tasks/><isrs/><runnables/><labels/></swModel><mappingModel><taskAllocation/></mappingModel>"
    found = check(model(nameless, tmp_path), RULES)
    assert "'' is not allocated" in {finding.message for finding in found}
    assert not [finding for finding in found if "None" in finding.message]


LESS = condition('<entries t="ModeValueCondition" label="NL?type=ModeLabel" value="1" relation="LESS_THAN"/>')
OLD_LESS = LESS.replace("Switch", "ModeSwitch")


@pytest.mark.parametrize(
    ("rule", "version", "times", "excerpt"),
    [
        # Each file is read with the metamodel of its version, or with that of 3.2.0.
        ("INC-SW-GRAPH", "2.2.0", 0, '<swModel><runnables name="R"/></swModel>'),
        ("INC-SW-GRAPH", "1.1.0", 1, '<swModel><runnables name="R"/></swModel>'),
        ("INC-SW-RELATION", "1.2.0", 0, OLD_LESS),
        ("INC-SW-RELATION", "2.2.0", 1, LESS),
        (
            "INC-SW-SERVER",
            "2.2.0",
            1,
            graph('<items t="SynchronousServerCall" serverRunnable="Q?type=Runnable"/>', '<runnables name="Q"/>'),
        ),
        ("INC-SW-DISPATCH", "2.2.0", 0, server(text("random"))),
        ("INC-SW-CONDSET", "2.2.0", 1, graph('<items t="ModeSwitch"><entries name="e"/></items>')),
        ("INC-ST-BURST", "1.1.0", 0, stimulus("PeriodicBurstStimulus")),
        ("INC-IO-FEATURE", "2.2.0", 0, graph('<items t="ModeSwitch"/>')),
        ("INC-IO-FEATURE", "1.1.0", 1, graph('<items t="ModeSwitch"/>')),
        ("INC-IO-FEATURE", "1.1.0", 1, scheduler('<schedulingAlgorithm t="OSEK"/>')),
        ("INC-IO-FEATURE", "1.1.0", 0, scheduler("")),
        ("INC-IO-FEATURE", "1.1.0", 0, graph('<items t="Switch"/>')),
        ("INC-IO-FEATURE", "1.1.0", 0, '<osModel><semaphores name="S" semaphoreType="Mutex"/></osModel>'),
        ("INC-IO-FEATURE", "2.2.0", 1, '<osModel><semaphores name="S" semaphoreType="Mutex"/></osModel>'),
        *[
            ("INC-IO-VERSION", version, 0, "")
            for version in ("1.2.0", "2.0.0", "2.1.0", "2.2.0", "3.0.0", "3.1.0", "3.2.0", "3.3.0")
        ],
        *[("INC-IO-VERSION", version, 1, "") for version in ("0.9.8", "1.0.0", "1.1.0", "3.4.0")],
    ],
)
def test_a_version(rule, version, times, excerpt, tmp_path):
    assert len(check(model(excerpt, tmp_path, version), [rule])) == times


CALL = '<items t="RunnableCall" runnable="{}?type=Runnable"/>'
SPACE = '<commonElements><namespaces name="A"/></commonElements>'


def member(called, identifier=""):
    task = f'<tasks name="T"><activityGraph>{CALL.format(called)}</activityGraph></tasks>'
    return f'{SPACE}<swModel>{task}<runnables {identifier} name="R" namespace="A?type=Namespace"/></swModel>'


LOCAL = '<swModel><tasks {} name="T"><localLabels {} name="l"/><activityGraph>{}</activityGraph></tasks>{}</swModel>'
ID = 'xmi:id="{}"'
OF_TASK, OF_LABEL = ID.format("T?type=Task"), ID.format("T/l?type=LocalModeLabel")


@pytest.mark.parametrize(
    ("excerpt", "found"),
    [
        # Without ids a member of a namespace is found under its plain name only, and nothing if there are local labels.
        (member("A/R"), {"INC-IO-XMIID"}),
        (member("A/R", ID.format("A/R?type=Runnable")), set()),
        (member("R"), set()),
        (member("R", ID.format("A/R?type=Runnable")), {"INC-IO-REF"}),
        (member("Q"), {"INC-IO-REF"}),
        (LOCAL.format("", "", "", ""), {"INC-IO-XMIID"}),
        (LOCAL.format(OF_TASK, OF_LABEL, "", ""), set()),
        (LOCAL.format(OF_TASK, OF_LABEL, CALL.format("R"), '<runnables name="R"/>'), {"INC-IO-XMIID"}),
        (LOCAL.format(OF_TASK, OF_LABEL, CALL.format("R"), f'<runnables {ID.format("R?type=Runnable")} name="R"/>'), set()),
        (
            f'<swModel><tasks name="T"><activityGraph>{CALL.format("R")}</activityGraph></tasks><runnables name="R"/></swModel>',
            set(),
        ),
    ],
)
def test_ids_are_missed_where_names_do_not_do(excerpt, found, tmp_path):
    findings = check(model(excerpt, tmp_path), ["INC-IO-XMIID", "INC-IO-REF"])
    assert {finding.rule for finding in findings} == found
    assert len(findings) == len(found)


#: Names that references encode, and how.
ENCODED = [("my task", "my+task"), ("E/E", "E%2FE"), ("is on?", "is+on%3F"), ("Z\u00e4hler", "Z%C3%A4hler"), ("a~b", "a%7Eb")]


@pytest.mark.parametrize(("name", "written"), ENCODED)
def test_encoded_names_are_not_found_without_an_id(name, written, tmp_path):
    def severities(identifier, call):
        calls = f'<tasks name="T"><activityGraph>{CALL.format(call)}</activityGraph></tasks>'
        read = model(f'<swModel>{calls}<runnables {identifier} name="{name}"/></swModel>', tmp_path)
        return [finding.severity for finding in check(read, ["INC-IO-XMIID", "INC-IO-REF"])]

    assert severities("", written) == [Severity.ERROR]
    assert severities(ID.format(f"{written}?type=Runnable"), written) == []
    assert severities("", name) == [] or "/" in name  # which separates the parts of a name


def test_an_encoded_name_that_is_not_needed_is_lost(tmp_path):
    mapped_task = allocated('task="T?type=Task" scheduler="S+1?type=TaskScheduler"').replace('name="S"', 'name="S 1"')
    (finding,) = check(model(mapped_task, tmp_path), ["INC-IO-XMIID"])
    assert (finding.severity, "'S+1?type=TaskScheduler'" in finding.message) == (Severity.WARNING, True)


def test_what_was_not_read_is_written_with_ids():
    label, task = am.LocalModeLabel(name="l"), am.Task(name="T")
    task.local_labels.append(label)
    model = Model.of(am.Amalthea(sw_model=am.SWModel(tasks=[task])))
    assert check(model, ["INC-IO-XMIID"]) == []


@pytest.mark.parametrize(
    ("files", "found"),
    [
        ([("2.2.0", "<swModel/>"), ("3.2.0", "<hwModel/>")], {"INC-IO-SAMEVERSION": 1}),
        ([("3.2.0", "<swModel/>"), ("3.3.0", "<hwModel/>")], {}),
        ([("2.1.0", "<swModel/>"), ("2.2.0", "<hwModel/>"), ("3.0.0", "<osModel/>")], {"INC-IO-SAMEVERSION": 2}),
        ([("3.3.0", "<swModel/><hwModel/>"), ("3.3.0", "<swModel/><hwModel/>")], {"INC-IO-SUBMODEL-ONCE": 2}),
        ([("3.3.0", "<swModel/>"), ("3.3.0", "<hwModel/>"), ("3.3.0", "<swModel/>")], {"INC-IO-SUBMODEL-ONCE": 1}),
        ([("3.3.0", '<customProperties key="k"/>'), ("3.3.0", '<customProperties key="k"/>')], {}),
    ],
)
def test_several_files(files, found, tmp_path):
    for number, (version, excerpt) in enumerate(files):
        text_ = model_text(excerpt, version)
        (tmp_path / f"{number}.amxmi").write_text(text_)
    told_of = [finding.rule for finding in check(load(tmp_path), ["INC-IO-SAMEVERSION", "INC-IO-SUBMODEL-ONCE"])]
    assert {rule: told_of.count(rule) for rule in told_of} == found


def two_systems(second, more=""):
    """Tasks T and U, which call A and B, of the systems X and, for U, `second`."""

    def calls(name, *called):
        return f'name="{name}"><activityGraph>{"".join(map(CALL.format, called))}</activityGraph>'

    return (
        f"<swModel><tasks {calls('T', 'A')}</tasks><tasks {calls('U', 'B')}</tasks>"
        f"<runnables {calls('A', 'C')}</runnables><runnables {calls('B', 'C')}</runnables>"
        f"<runnables {calls('C', 'D')}</runnables><runnables {calls('D', 'C')}</runnables></swModel>"
        '<osModel><operatingSystems name="X"><taskSchedulers name="S"/></operatingSystems>'
        '<operatingSystems name="Y"><taskSchedulers name="P"/></operatingSystems></osModel>'
        f'<mappingModel><taskAllocation task="T?type=Task" scheduler="S?type=TaskScheduler"/>'
        f'<taskAllocation task="U?type=Task" scheduler="{second}?type=TaskScheduler"/>{more}</mappingModel>'
    )


@pytest.mark.parametrize(("second", "shared"), [("P", ["C", "D"]), ("S", [])])
def test_runnables_are_shared_through_calls(second, shared, tmp_path):
    found = check(model(two_systems(second), tmp_path), ["INC-MAP-SHAREDRUN"])
    assert [finding.object for finding in found] == shared


@pytest.mark.parametrize(
    ("stimuli", "late"), [("CP", ["P"]), ("PC", []), ("PCP", ["P"]), ("CC", []), ("PCPQ", ["P", "Q"]), ("", [])]
)
def test_stimuli_behind_one_that_is_not_converted(stimuli, late, tmp_path):
    kinds = {"C": "CustomStimulus", "P": "PeriodicStimulus", "Q": "InterProcessStimulus"}
    declared = "".join(f'<stimuli t="{kind}" name="{name}"/>' for name, kind in kinds.items())
    used = " ".join(f"{name}?type={kinds[name]}" for name in stimuli)
    excerpt = f'<stimuliModel>{declared}</stimuliModel><swModel><isrs name="I" stimuli="{used}"/></swModel>'
    found = check(model(excerpt, tmp_path), ["INC-ST-ORDER"])
    assert [finding.message.split("'")[1] for finding in found] == late


def test_a_chain_of_many_chains_is_followed(tmp_path):
    """Far deeper than Python recurses, and with far more ways through it than could be followed one by one."""
    chains = "".join(chain("ab", reference(f"C{i + 1}"), reference(f"C{i + 1}"), name=f"C{i}") for i in range(3000))
    read = model(events(chains + chain(("a", ""), name="C3000") + LATENCY.replace("C?", "C0?")), tmp_path)
    assert check(read, ["INC-EC-CYCLE"]) == []
    assert len(check(read, ["INC-LC-SCOPE"])) == 1
