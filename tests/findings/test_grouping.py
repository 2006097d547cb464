"""One flaw, one finding: which findings are shown together, and which ones stay apart."""

from graphlib import TopologicalSorter
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.findings.flaws import CONSEQUENCES, FLAWS
from amalthea_uros.findings.grouping import group
from amalthea_uros.metamodel.versions import facts, newest_version
from amalthea_uros.validate import registry
from tests.growth import SIZES, growth

ERROR, WARNING, INFO = Severity.ERROR, Severity.WARNING, Severity.INFO
REQUIRED = "AM-EMF-INTRINSIC/required-feature"
DATATYPE = "AM-EMF-INTRINSIC/datatype"
PROXY = "AM-EMF-INTRINSIC/proxy-resolves"


def finding(rule, message="", name="T", line=1, severity=WARNING, file="m.amxmi"):
    return Finding(rule, severity, message, Location(Path(file), line, 1), object=name)


def shown(*findings):
    """What is shown: the id, the other ids of the flaw, and the ids of the consequences."""
    return [
        (found.shown.rule, list(found.also), [finding.rule for finding in found.consequences])
        for found in group(list(findings))
    ]


def test_rules_of_several_profiles_report_one_flaw():
    clock = finding("TIM-CLOCK", "the clock of 'C' is not known", "C")
    importer = finding("INC-HW-PU-CLOCK", "'C' has no frequency domain", "C", severity=ERROR)
    (found,) = group([importer, clock])
    # The one that says most, with the highest severity.
    assert (found.shown.rule, found.shown.message, found.shown.severity) == ("TIM-CLOCK", clock.message, ERROR)
    assert found.same == (clock, importer)


@pytest.mark.parametrize("change", [{"name": "D"}, {"line": 2}, {"file": "other.amxmi"}])
def test_another_object_line_or_file_is_another_flaw(change):
    assert len(shown(finding("TIM-CLOCK", name="C"), finding("INC-HW-PU-CLOCK", **({"name": "C"} | change)))) == 2


def test_two_flaws_of_one_object_stay_apart():
    assert shown(finding("TIM-STIMULUS"), finding("TIM-ALLOCATION"), finding("TIM-DEMAND")) == [
        ("TIM-STIMULUS", [], []),
        ("TIM-ALLOCATION", [], []),
        ("TIM-DEMAND", [], []),
    ]


def test_a_rule_that_finds_two_things_at_an_object_found_two_flaws():
    found = shown(finding(REQUIRED, "the T has no task"), finding(REQUIRED, "the T has no scheduler"), finding("INC-MAP-TASK"))
    assert found == [(REQUIRED, ["INC-MAP-TASK"], []), (REQUIRED, [], [])]


def test_a_general_rule_is_the_same_flaw_only_where_it_is_about_the_feature():
    period = finding("TIM-PERIOD", "the stimulus 'S' has no recurrence")
    assert shown(period, finding(REQUIRED, "the PeriodicStimulus has no recurrence")) == [("TIM-PERIOD", [REQUIRED], [])]
    assert len(shown(period, finding(REQUIRED, "the PeriodicStimulus has no other"))) == 2


def test_a_number_beyond_its_limit_is_the_same_flaw_in_the_schema():
    schema = [finding("XSD001", f'attribute {each}="0.0" is not a number greater than 0', "path") for each in ("alpha", "beta")]
    rule = [finding(DATATYPE, f"the {each} of the TimeBetaDistribution is 0.0, but must be ...") for each in ("alpha", "beta")]
    assert shown(*schema, *rule) == [(DATATYPE, ["XSD001"], [])] * 2
    of_schema = facts(newest_version()).classes.values()
    limited = {each.name for of in of_schema for each in of.features if each.type in facts(newest_version()).numbers}
    joined = {about for flaw in FLAWS for source in flaw.sources if source.id == "XSD001" for about in source.about}
    assert joined == limited


def test_references_of_one_object_belong_together_by_their_target():
    def reference(rule, target):
        return finding(rule, f"'stimuli' refers to '{target}?type=SingleStimulus'", "" if rule.startswith("XMI") else "T")

    findings = [reference(rule, target) for target in "AB" for rule in ("INC-IO-REF", PROXY)]
    findings += [reference("XMI020", "A"), reference("XMI023", "B")]
    found = group(findings)
    assert [[item.rule for item in each.same] for each in found] == [
        [PROXY, "XMI020", "INC-IO-REF"],
        ["XMI023", PROXY, "INC-IO-REF"],
    ]
    for each, target in zip(found, "AB", strict=True):
        assert all(f"'{target}?type" in item.message for item in each.same)


def test_hops_of_a_chain_belong_together_wherever_they_are_reported():
    # The path of the description has the functions, each in a line of its own; the chain of the model has their events.
    hops = [("Sense", "Act", 22), ("Act", "Last", 23)]
    description = [finding("UR130", f"nothing carries the effect from '{a}' to '{b}'", "", line) for a, b, line in hops]
    model = [
        finding("TIM-CHAIN-CARRIED", "nothing carries the effect from 'Sense_start' to 'Act_finish'", "C.items[0]", 19),
        finding("TIM-CHAIN-CARRIED", "nothing carries the effect from 'Act_finish' to 'Last_finish'", "C.items[1]", 19),
    ]
    assert [each.same for each in group([*model, *description])] == [(model[0], description[0]), (model[1], description[1])]


def test_a_version_that_the_importer_does_not_know_is_the_cause_of_unknown_features():
    version = finding("INC-IO-VERSION", "am2inc does not know AMALTHEA 0.9.9", "", severity=ERROR)
    features = [finding("INC-IO-FEATURE", f"Task has no '{name}'", name, line) for line, name in enumerate("abc", 2)]
    other = finding("INC-IO-FEATURE", "Task has no 'd'", "d", file="other.amxmi")
    assert shown(version, *features, other) == [
        ("INC-IO-VERSION", [], ["INC-IO-FEATURE"] * 3),
        ("INC-IO-FEATURE", [], []),
    ]


def test_a_flaw_that_one_of_its_rules_reports_anyway_is_no_consequence():
    version = finding("INC-IO-VERSION", "am2inc does not know AMALTHEA 0.9.9", "")
    unknown = [finding(rule, "Task has no 'x'", line=3) for rule in ("XSD001", "INC-IO-FEATURE")]
    assert shown(version, *unknown) == [("INC-IO-VERSION", [], []), ("XSD001", ["INC-IO-FEATURE"], [])]


def test_objects_of_files_that_were_not_read_cannot_be_found():
    def dangling(name, line):
        return [finding(rule, f"x refers to '{name}?type=Task'", "A", line) for rule in (PROXY, "INC-IO-REF")]

    unread = finding("XMI025", "2 references to 2 objects of other files: 'S?type=Task', ...", "", 2)
    # This one is not a reference to another file.
    misspelled = finding("XMI020", "x refers to 'U?type=Task'", "", 5)
    assert shown(unread, *dangling("S", 3), *dangling("T", 4), *dangling("U", 5), misspelled) == [
        ("XMI025", [], [PROXY, "INC-IO-REF"] * 2),
        (PROXY, ["XMI020", "INC-IO-REF"], []),
    ]


def test_the_severity_is_the_highest_also_of_the_consequences():
    version = finding("XMI007", "AMALTHEA 3.4.0 is newer", "", severity=WARNING)
    feature = finding("INC-IO-FEATURE", "no 'x'", line=2, severity=ERROR)
    (found,) = group([version, feature])
    assert found.shown.severity is ERROR


def test_the_tables_name_findings_that_exist():
    sources = [source for flaw in FLAWS for source in flaw.sources]
    sources += [source for item in CONSEQUENCES for source in (item.cause, *item.effects)]
    assert not [source.id for source in sources if registry.kind(source.id) is None]


def test_no_finding_is_the_cause_of_its_cause():
    effects = {}
    for item in CONSEQUENCES:
        effects.setdefault(item.cause.id, set()).update(source.id for source in item.effects)
    TopologicalSorter(effects).prepare()


def test_names_that_only_start_alike_are_different():
    scheduler = finding("AM-Mapping-Scheduler-ProcessingUnit", "no scheduler allocation refers to 'S'", "S")
    task = finding("DOC-Task-Affinity-Intersection", "task 'T' cannot run: 'S_1' is responsible for no processing unit", "T", 2)
    assert len(shown(scheduler, task)) == 2


@given(
    st.lists(
        st.builds(
            finding,
            st.sampled_from(sorted({s.id for flaw in FLAWS for s in flaw.sources} | {c.effects[0].id for c in CONSEQUENCES})),
            st.sampled_from(["", "'A'", "'B' of 'A'", "no recurrence", "no nextOccurrence of 'A_start'"]),
            st.sampled_from(["", "T", "U"]),
            st.integers(1, 2),
            st.sampled_from(list(Severity)),
        )
    )
)
def test_nothing_is_lost_and_nothing_is_shown_twice(findings):
    found = group(findings)
    every = [item for each in found for item in (*each.same, *each.consequences)]
    assert sorted(map(repr, every)) == sorted(map(repr, findings))


#: Findings of a size in one file, most of them at one place.
AT_ONE_PLACE = {
    "many objects of a file in one line": lambda n: [
        finding(rule, name=f"C{i}") for i in range(n) for rule in ("TIM-CLOCK", "INC-HW-PU-CLOCK")
    ],
    "equal objects": lambda n: [finding(rule) for rule in ("AM-EMF-INTRINSIC/unique-id", "INC-IO-NAME") for _ in range(n)],
    "one name at many objects": lambda n: [
        finding(rule, "x refers to 'None?type=Task'", f"T{i}") for rule in (PROXY, "INC-IO-REF") for i in range(n)
    ],
    "many names, and one that all have": lambda n: [
        finding(rule, f"'L' has no attribute 'a{i}'") for rule in ("XSD001", "XMI010") for i in range(n)
    ],
    "objects that only some know": lambda n: [
        finding(rule, name=name and f"{name}{i}")
        for rule, name in [("TIM-CLOCK", "C"), ("INC-HW-PU-CLOCK", "")]
        for i in range(n)
    ],
    "effects of any of many causes": lambda n: [finding(rule, line=i) for rule in ("EMF-ID", "XMI022") for i in range(n)],
    "effects of causes with names": lambda n: [
        finding(rule, f"the id 'i{i}'", line=i) for rule in ("EMF-ID", "XMI022") for i in range(n)
    ],
}


@pytest.mark.parametrize("name", AT_ONE_PLACE)
def test_steps_grow_with_the_number_of_findings(name):
    assert growth(group, [AT_ONE_PLACE[name](size) for size in SIZES]) < 2.5


def test_the_object_itself_is_nearer_than_an_unknown_one():
    unknown, known = finding("TIM-CLOCK", name=""), finding("TIM-CLOCK", name="C")
    importer = finding("INC-HW-PU-CLOCK", name="C")
    assert [found.same for found in group([unknown, known, importer])] == [(unknown,), (known, importer)]


@given(st.lists(st.integers(1, 30), min_size=1, max_size=10), st.lists(st.integers(1, 30), max_size=10))
def test_an_effect_belongs_to_the_cause_in_the_nearest_line(lines_of_causes, lines_of_effects):
    causes = [finding("EMF-ID", name=f"C{i}", line=line) for i, line in enumerate(lines_of_causes)]
    effects = [finding("XMI022", name=f"E{i}", line=line) for i, line in enumerate(lines_of_effects)]
    nearest = [min(causes, key=lambda cause: abs(cause.location.line - effect.location.line)) for effect in effects]
    found = {each.same: each.consequences for each in group([*causes, *effects])}
    assert found == {
        (cause,): tuple(effect for effect, its in zip(effects, nearest, strict=True) if its is cause) for cause in causes
    }
