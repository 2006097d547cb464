"""The rules of the profile app4mc about allocations: each branch of their conditions, bounds, and what is not stated."""

import pytest
from excerpts import assert_said, call, cases, messages, process, runnable

SYSTEM = """<hwModel><structures name="ECU"><modules t="ProcessingUnit" name="a"/>
<modules t="ProcessingUnit" name="b"/><modules t="Memory" name="RAM"/>
<modules t="Memory" name="ROM"/></structures></hwModel>
<osModel><schedulerDefinitions name="Grouping"/><operatingSystems name="OS">{}</operatingSystems></osModel>{}
<mappingModel>{}</mappingModel>"""


def scheduler(name, parent="", features="", content=""):
    above = f'<parentAssociation parent="{parent}?type=TaskScheduler"/>' if parent else ""
    return f'<taskSchedulers name="{name}" {features}>{above}{content}</taskSchedulers>'


def serves(name, *cores, kind="TaskScheduler"):
    units = f' responsibility="{" ".join(f"{core}?type=ProcessingUnit" for core in cores)}"' if cores else ""
    return f'<schedulerAllocation scheduler="{name}?type={kind}"{units}/>'


def runs(task, on="", *cores):
    where = f' scheduler="{on}?type=TaskScheduler"' if on else ""
    units = f' affinity="{" ".join(f"{core}?type=ProcessingUnit" for core in cores)}"' if cores else ""
    return f'<taskAllocation task="{task}?type=Task"{where}{units}/>'


TASKS = "<swModel>{}</swModel>".format("".join(f'<tasks name="{name}"/>' for name in "TU"))


def mapped(schedulers, *mapping, software=TASKS):
    return SYSTEM.format(schedulers, software, "".join(mapping))


S, R = scheduler("S"), scheduler("R")
AFFINITIES = [
    ("DOC-Task-Affinity-Intersection", mapped(schedulers, *mapping), said)
    for schedulers, mapping, said in (
        (S, [serves("S", "a"), runs("T", "S")], []),
        (S, [serves("S", "a"), runs("T", "S", "a", "b")], []),
        (S, [serves("S", "a"), runs("T", "S", "b")], ["'S' is responsible for no processing unit of its affinity"]),
        (S, [serves("S", "a"), serves("S", "b"), runs("T", "S", "b")], []),
        (S, [serves("S"), runs("T", "S")], ["task 'T' cannot run: 'S' is responsible for no processing unit"]),
        (S, [runs("T", "S")], ["responsible for no processing unit"]),
        (S, [runs("T", "S", "a")], ["responsible for no processing unit"]),
        (S, [runs("T")], []),
        (S, ['<taskAllocation scheduler="S?type=TaskScheduler"/>'], []),
        (S, [runs("T", "gone")], []),
        # A scheduler without processing units of its own decides for those of the one above.
        (scheduler("S", "R") + R, [serves("R", "a"), runs("T", "S", "a")], []),
        (scheduler("S", "R") + R, [serves("S"), serves("R", "a"), runs("T", "S", "a")], []),
        (scheduler("S", "R") + R, [serves("R", "a"), runs("T", "S", "b")], ["no processing unit of its affinity"]),
        (scheduler("S", "R") + scheduler("R", "Q") + scheduler("Q"), [serves("Q", "a"), runs("T", "S"), runs("U", "R")], []),
        (scheduler("S", "R") + R, [serves("S", "b"), serves("R", "a"), runs("T", "S", "b")], []),
        (scheduler("S", "R") + scheduler("R", "S"), [runs("T", "S"), runs("U", "R")], ["'T'", "'U'"]),
    )
]
ALLOCATIONS = [
    ("DOC-Task-Single-Scheduler", mapped(S + R, *mapping), said)
    for mapping, said in (
        ([], []),
        ([runs("T", "S"), runs("U", "R")], []),
        ([runs("T", "S"), runs("T", "R")], ["'T' is allocated to 'S' and 'R'"] * 2),
        ([runs("T", "S"), runs("T", "S", "a")], []),
        ([runs("T", "S"), runs("T")], []),
        (['<taskAllocation scheduler="S?type=TaskScheduler"/>', '<taskAllocation scheduler="R?type=TaskScheduler"/>'], []),
    )
]

DEFINED = 'definition="D?type=SchedulerDefinition"'


def defined(name, features, schedulers, *mapping):
    return mapped(schedulers, *mapping).replace(
        '<schedulerDefinitions name="Grouping"/>', f'<schedulerDefinitions name="{name}" {features}/>'
    )


GROUP = 'definition="Grouping?type=SchedulerDefinition"'
PARENT, ONE = 'requiresParentScheduler="true"', 'hasExactlyOneChild="true"'
PARENTS = [
    ("DOC-Grouping-Parent", content, said)
    for content, said in (
        (mapped(S), []),
        (mapped(scheduler("S", features=GROUP)), ["'S' has no parent scheduler, but Grouping requires one"]),
        (mapped(scheduler("S", "R", GROUP) + R), []),
        (mapped(scheduler("S", features=GROUP, content="<parentAssociation/>")), ["no parent scheduler"]),
        (defined("D", PARENT, scheduler("S", features=DEFINED)), ["'S' has no parent scheduler, but D requires one"]),
        (defined("D", PARENT, scheduler("S", "R", DEFINED) + R), []),
        (defined("D", 'requiresParentScheduler="false"', scheduler("S", features=DEFINED)), []),
        (
            defined("D", ONE, scheduler("S", features=DEFINED)),
            ["'S' schedules 0 tasks and schedulers, but D requires exactly one"],
        ),
        (defined("D", ONE, scheduler("S", features=DEFINED), runs("T", "S")), []),
        (defined("D", ONE, scheduler("S", features=DEFINED), runs("T", "S"), runs("T", "S", "a")), []),
        (defined("D", ONE, scheduler("S", features=DEFINED) + scheduler("R", "S")), []),
        (defined("D", ONE, scheduler("S", features=DEFINED), runs("T", "S"), runs("U", "S")), ["schedules 2"]),
        (defined("D", ONE, scheduler("S", features=DEFINED) + scheduler("R", "S"), runs("T", "S")), ["schedules 2"]),
        (
            defined("D", ONE, scheduler("S", features=DEFINED), '<taskAllocation scheduler="S?type=TaskScheduler"/>'),
            ["schedules 0"],
        ),
        (defined("D", "", scheduler("S", features=DEFINED), runs("T", "S"), runs("U", "S")), []),
    )
]

# Constraints.


def sequence(*groups, scope=()):
    """A constraint on groups of runnables; R runs in T, S (called by R2) and R2 in U, P is in a prototype, nothing runs Q."""
    content = "".join(
        f'<runnableGroups runnables="{" ".join(f"{name}?type=Runnable" for name in group)}"/>' for group in groups
    )
    within = f' processScope="{" ".join(scope)}"' if scope else ""
    software = (
        process("tasks", "T", call("R"))
        + process("tasks", "U", call("R2"))
        + "".join(map(runnable, "RSPQ"))
        + runnable("R2", call("S"))
        + '<processPrototypes name="X"><runnableCalls runnable="P?type=Runnable"/></processPrototypes>'
    )
    return (
        f"<swModel>{software}</swModel><constraintsModel>"
        f'<runnableSequencingConstraints name="C"{within}>{content}</runnableSequencingConstraints></constraintsModel>'
    )


IN_T, IN_U = "T?type=Task", "U?type=Task"
SEQUENCES = [
    ("DOC-ProcessScope", content, said)
    for content, said in (
        (sequence(), ["'C' has 0 runnable groups,"]),
        (sequence(["R", "S"]), ["'C' has 1 runnable group,"]),
        (sequence(["R"], ["S"]), []),
        (sequence(["R"], ["S"], scope=[IN_T]), ["'C' has 1 runnable group in its process scope"]),
        (sequence(["R2"], ["S"], scope=[IN_T]), ["'C' has 0 runnable groups in its process scope"]),
        (sequence(["R"], ["S"], scope=[IN_T, IN_U]), []),
        (sequence(["R2"], ["S"], scope=[IN_U]), []),
        (sequence(["R"], ["S"], ["R2"], scope=[IN_U]), []),
        (sequence(["R"], ["S", "R"], scope=[IN_T]), []),
        (sequence(["R"], ["Q"], scope=[IN_T]), []),
        (sequence(["R"], ["P"], scope=["X?type=ProcessPrototype"]), []),
        (sequence(["R"], ["S"], scope=[IN_T, "gone?type=Task"]), []),
    )
]

SECTION = '<swModel><sections name="s"/><sections name="t"/></swModel><constraintsModel>{}</constraintsModel>'


def section_in(memories, section="s"):
    allowed = f' memories="{" ".join(f"{name}?type=Memory" for name in memories)}"' if memories else ""
    return f'<physicalSectionConstraints name="C" section="{section}?type=Section"{allowed}/>'


def lies(memory, *sections):
    where = f' memory="{memory}?type=Memory"' if memory else ""
    return f'<physicalSectionMapping name="P" origin="{" ".join(f"{each}?type=Section" for each in sections)}"{where}/>'


SECTIONS = [
    ("DOC-PhysicalSection", mapped("", *mapping, software=SECTION.format("".join(constraints))), said)
    for constraints, mapping, said in (
        ([section_in(["RAM"])], [lies("RAM", "s")], []),
        ([section_in(["RAM", "ROM"])], [lies("ROM", "s")], []),
        ([section_in(["RAM"])], [lies("ROM", "s")], ["section 's' is mapped to 'ROM', which 'C' does not allow"]),
        ([section_in(["RAM"])], [lies("ROM", "t")], []),
        ([section_in(["RAM"])], [lies("ROM", "t", "s")], ["'s' is mapped to 'ROM'"]),
        (
            [section_in(["RAM"]), section_in(["ROM"], "t")],
            [lies("ROM", "t", "s"), lies("RAM", "t")],
            ["'s' is mapped to 'ROM'", "'t' is mapped to 'RAM'"],
        ),
        ([section_in(["RAM"]), section_in(["ROM"])], [lies("RAM", "s")], ["'RAM'"]),
        ([section_in([])], [lies("ROM", "s")], []),
        ([section_in(["RAM"])], [lies("", "s")], []),
        ([], [lies("ROM", "s")], []),
    )
]


def group(kind, feature, cls, names):
    return f't="{kind}" {feature}="{" ".join(f"{name}?type={cls}" for name in names)}"'


def data(*names):
    return group("LabelEntityGroup", "labels", "Label", names)


def tasks(*names):
    return group("ProcessEntityGroup", "processes", "Task", names)


def runnables(*names):
    return group("RunnableEntityGroup", "runnables", "Runnable", names)


TAGGED = 't="TagGroup" tag="tag?type=Tag"'


def target(kind, feature, cls, names):
    return f"<target {group(kind, feature, cls, names)}/>" if names else f'<target t="{kind}"/>'


def on_memories(*names):
    return target("TargetMemory", "memories", "Memory", names)


def on_cores(*names):
    return target("TargetCore", "cores", "ProcessingUnit", names)


def on_schedulers(*names):
    return target("TargetScheduler", "schedulers", "TaskScheduler", names)


def affinity(kind, on, *groups):
    name = "group" if "Pairing" in kind else "groups"
    content = "".join(f"<{name} {each}/>" for each in groups)
    return f'<affinityConstraints t="{kind}Constraint" name="C">{on}{content}</affinityConstraints>'


SOFTWARE = """<commonElements><tags name="tag"/></commonElements><swModel>
<isrs name="I"/><tasks name="T" tags="tag?type=Tag"/><tasks name="V"/>
<tasks name="U" tags="tag?type=Tag"><activityGraph>{}</activityGraph></tasks>
<runnables name="R" tags="tag?type=Tag"/><runnables name="Q" tags="tag?type=Tag"><activityGraph>{}</activityGraph></runnables>
<labels name="L"/><labels name="M" section="s?type=Section"/><labels name="N"/><sections name="s"/></swModel>
<constraintsModel>{}</constraintsModel>"""


def constrained(constraint, *mapping):
    """Tasks T and U, the latter of which calls Q and with it R; V is not allocated; S decides for core a, R for b, Both for both."""
    schedulers = S + R + scheduler("Both") + '<interruptControllers name="IC"/>'
    served = serves("S", "a") + serves("R", "b") + serves("Both", "a", "b") + serves("IC", "a", kind="InterruptController")
    return mapped(schedulers, served, *mapping, software=SOFTWARE.format(call("Q"), call("R"), constraint))


def lie(**memories):
    """Labels in memories."""
    frame = '<memoryMapping abstractElement="{}?type=Label" memory="{}?type=Memory"/>'
    return [frame.format(label, memory) for label, memory in memories.items()]


def carries(scheduler, name):
    return f'<runnableAllocation scheduler="{scheduler}?type=TaskScheduler" entity="{name}?type=Runnable"/>'


APART, TOGETHER = (runs("T", "S"), runs("U", "R")), (runs("T", "S"), runs("U", "S"))
SERVES_I = '<isrAllocation isr="I?type=ISR" controller="IC?type=InterruptController"/>'
ISR_AND_T = 't="ProcessEntityGroup" processes="I?type=ISR T?type=Task"'
AFFINITY_CASES = [
    # Pairs of labels.
    ("DataPairing", on_memories(), [data("L", "N")], lie(L="RAM", N="RAM"), []),
    (
        "DataPairing",
        on_memories(),
        [data("L", "N")],
        lie(L="RAM", N="ROM"),
        ["the objects paired by 'C' have no common target: 'L' is on 'RAM', 'N' is on 'ROM'"],
    ),
    ("DataPairing", "", [data("L", "N")], lie(L="RAM", N="ROM"), ["no common target"]),
    ("DataPairing", on_memories("RAM"), [data("L", "N")], lie(L="RAM", N="RAM"), []),
    ("DataPairing", on_memories("ROM"), [data("L", "N")], lie(L="RAM", N="RAM"), ["no common target"]),
    ("DataPairing", on_memories("RAM", "ROM"), [data("L", "N")], lie(L="RAM", N="ROM"), ["no common target"]),
    ("DataPairing", on_memories("ROM"), [data("L")], lie(L="RAM"), ["no common target"]),
    # What is nowhere is not judged.
    ("DataPairing", on_memories(), [data("L", "N")], lie(L="RAM"), []),
    ("DataPairing", on_memories("ROM"), [data("L", "N")], [], []),
    ("DataPairing", on_memories("ROM"), [data("L")], ['<memoryMapping abstractElement="L?type=Label"/>'], []),
    ("DataPairing", on_memories("ROM"), [data("gone")], [], []),
    ("DataPairing", on_memories("ROM"), [], lie(L="RAM"), []),
    # A label lies where its section does, if it is not mapped itself.
    ("DataPairing", on_memories(), [data("L", "M")], [*lie(L="RAM"), lies("ROM", "s")], ["'M' is on 'ROM'"]),
    ("DataPairing", on_memories(), [data("L", "M")], [*lie(L="RAM", M="RAM"), lies("ROM", "s")], []),
    (
        "DataPairing",
        on_memories(),
        [data("L", "N")],
        [*lie(L="RAM"), '<physicalSectionMapping name="P" labels="N?type=Label" memory="ROM?type=Memory"/>'],
        ["'N' is on 'ROM'"],
    ),
    # Two groups that are to be apart, and one that is to stay away.
    (
        "DataSeparation",
        on_memories(),
        [data("L"), data("N")],
        lie(L="RAM", N="RAM"),
        ["'RAM' is shared by 'L' and 'N', which 'C' separates"],
    ),
    ("DataSeparation", on_memories(), [data("L"), data("N")], lie(L="RAM", N="ROM"), []),
    ("DataSeparation", on_memories("ROM"), [data("L"), data("N")], lie(L="RAM", N="RAM"), []),
    ("DataSeparation", on_memories("RAM"), [data("L"), data("N")], lie(L="RAM", N="RAM"), ["'RAM'"]),
    ("DataSeparation", on_memories(), [data("L", "M"), data("N")], lie(L="RAM", M="RAM"), []),
    ("DataSeparation", on_memories(), [data("L"), data("N")], lie(L="RAM"), []),
    (
        "DataSeparation",
        on_memories("RAM"),
        [data("L", "N")],
        lie(L="RAM", N="RAM"),
        ["'RAM' is used by 'L' and 'N', which 'C' forbids"],
    ),
    ("DataSeparation", on_memories("ROM"), [data("L", "N")], lie(L="RAM", N="RAM"), []),
    ("DataSeparation", on_memories(), [data("L")], lie(L="RAM"), ["'RAM' is used by 'L'"]),
    ("DataSeparation", on_memories(), [], lie(L="RAM"), []),
    # Processes run on cores by their schedulers and affinities.
    ("ProcessPairing", on_cores(), [tasks("T", "U")], TOGETHER, []),
    ("ProcessPairing", on_cores(), [tasks("T", "U")], APART, ["'T' is on 'a', 'U' is on 'b'"]),
    ("ProcessPairing", "", [tasks("T", "U")], APART, ["'T' is on 'a', 'U' is on 'b'"]),
    ("ProcessPairing", on_cores("b"), [tasks("T", "U")], TOGETHER, ["'T' is on 'a', 'U' is on 'a'"]),
    ("ProcessPairing", on_cores(), [tasks("T", "U", "V")], TOGETHER, []),
    ("ProcessPairing", on_cores(), [tasks("T", "U")], [runs("T", "Both"), runs("U", "R")], []),
    ("ProcessPairing", on_cores(), [tasks("T", "U")], [runs("T", "Both", "a"), runs("U", "R")], ["'T' is on 'a'"]),
    ("ProcessPairing", on_cores(), [ISR_AND_T], [SERVES_I, runs("T", "S")], []),
    ("ProcessPairing", on_cores(), [ISR_AND_T], [SERVES_I, runs("T", "R")], ["'I' is on 'a', 'T' is on 'b'"]),
    ("ProcessSeparation", on_cores(), [tasks("T"), tasks("U")], APART, []),
    ("ProcessSeparation", on_cores(), [tasks("T"), tasks("U")], TOGETHER, ["'a' is shared by 'T' and 'U'"]),
    (
        "ProcessSeparation",
        on_cores(),
        [tasks("T"), tasks("U")],
        [runs("T", "Both"), runs("U", "Both")],
        ["'a' is shared", "'b' is shared"],
    ),
    ("ProcessSeparation", on_cores("b"), [tasks("T"), tasks("U")], [runs("T", "Both"), runs("U", "Both")], ["'b' is shared"]),
    ("ProcessSeparation", on_cores("a"), [tasks("T", "U", "V")], APART, ["'a' is used by 'T'"]),
    # Schedulers as targets.
    (
        "ProcessPairing",
        on_schedulers(),
        [tasks("T", "U")],
        [runs("T", "S"), runs("U", "Both")],
        ["'T' is on 'S', 'U' is on 'Both'"],
    ),
    ("ProcessSeparation", on_schedulers(), [tasks("T"), tasks("U")], TOGETHER, ["'S' is shared"]),
    ("ProcessSeparation", on_schedulers("R"), [tasks("T"), tasks("U")], TOGETHER, []),
    # Runnables are where they are allocated, or else where the processes are that run them.
    (
        "RunnablePairing",
        on_cores(),
        [runnables("R", "Q")],
        [carries("S", "R"), carries("R", "Q")],
        ["'R' is on 'a', 'Q' is on 'b'"],
    ),
    ("RunnablePairing", on_cores(), [runnables("R", "Q")], [runs("U", "S")], []),
    ("RunnablePairing", on_cores("b"), [runnables("R", "Q")], [runs("U", "S")], ["'R' is on 'a', 'Q' is on 'a'"]),
    (
        "RunnablePairing",
        on_cores(),
        [runnables("R", "Q")],
        [runs("U", "S"), carries("R", "R")],
        ["'R' is on 'b', 'Q' is on 'a'"],
    ),
    (
        "RunnableSeparation",
        on_schedulers(),
        [runnables("R"), runnables("Q")],
        [runs("U", "S")],
        ["'S' is shared by 'R' and 'Q'"],
    ),
    ("RunnableSeparation", on_schedulers(), [runnables("R"), runnables("Q")], [], []),
    # A tag stands for all of the kind that the constraint is about.
    (
        "ProcessSeparation",
        on_cores("a"),
        [TAGGED],
        [*TOGETHER, runs("V", "S"), carries("S", "R")],
        ["'a' is used by 'T' and 'U'"],
    ),
    (
        "RunnableSeparation",
        on_cores("a"),
        [TAGGED],
        [runs("T", "S"), carries("S", "R"), carries("S", "Q")],
        ["'a' is used by 'R' and 'Q'"],
    ),
    ("RunnablePairing", on_cores("b"), ['t="TagGroup"'], [carries("S", "R")], []),
]
AFFINITY = [
    ("DOC-Pairing-Separation", constrained(affinity(kind, on, *groups), *mapping), said)
    for kind, on, groups, mapping, said in AFFINITY_CASES
]


@cases(AFFINITIES, ALLOCATIONS, PARENTS, SEQUENCES, SECTIONS, AFFINITY)
def test_a_case(rule, excerpt, said, tmp_path):
    assert_said(messages(tmp_path, rule, excerpt), said)


@pytest.mark.parametrize(
    ("algorithm", "parent", "grouping", "unallocated"), [("Grouping", "", 1, 0), ("Grouping", "R", 0, 0), ("OSEK", "", 0, 1)]
)
def test_groups_of_old_models_have_a_class_of_their_own(algorithm, parent, grouping, unallocated, tmp_path):
    group = scheduler("S", parent, content=f'<schedulingAlgorithm t="{algorithm}"/>')
    excerpt = f"""<hwModel><structures name="ECU"><modules t="ProcessingUnit" name="a"/></structures></hwModel>
<osModel><operatingSystems name="OS">{group}{R}</operatingSystems></osModel><mappingModel>{serves("R", "a")}</mappingModel>"""
    assert len(messages(tmp_path, "DOC-Grouping-Parent", excerpt, version="1.2.0")) == grouping
    assert len(messages(tmp_path, "AM-Mapping-Scheduler-ProcessingUnit", excerpt, version="1.2.0")) == unallocated
