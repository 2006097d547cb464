"""0.9.2 -> 0.9.3, as far as the pairs of models do not show it."""

import pytest
from inline_models import of_kind, text_property, written
from migration import meaning, migrated

from amalthea_uros.xmi.tree.notes import NoteKind

#: The versions.
STEP = ("0.9.2", "0.9.3")


def hardware(*definitions, category="Instructions"):
    """A hardware model with definitions of processing units, by name and the text of their instructions per cycle."""
    made = [
        f'<definitions t="ProcessingUnitDefinition" name="{name}" features="{category}/F{number}?type=HwFeature"/>'
        for number, (name, _) in enumerate(definitions)
    ]
    features = [f'<features name="F{number}" value="{value}"/>' for number, (_, value) in enumerate(definitions)]
    return f'<hwModel>{"".join(made)}<featureCategories name="{category}">{"".join(features)}</featureCategories></hwModel>'


def runnable(items):
    return f'<swModel><runnables name="R">{items}</runnables></swModel>'


def need(*entries):
    return f'<runnableItems t="ExecutionNeed">{"".join(entries)}</runnableItems>'


def ticks(*entries, tag="runnableItems"):
    return f'<{tag} t="Ticks">{"".join(entries)}</{tag}>'


def default(value, key="Instructions"):
    return f'<default key="{key}"><value t="NeedConstant" value="{value}"/></default>'


def extended(definition, value, key="Instructions"):
    inner = f'<value key="{key}"><value t="NeedConstant" value="{value}"/></value>'
    return f'<extended key="{definition}?type=ProcessingUnitDefinition">{inner}</extended>'


def constant(value, tag="default"):
    return f'<{tag} t="DiscreteValueConstant" value="{value}"/>'


def of_definition(definition, value):
    return f'<extended key="{definition}?type=ProcessingUnitDefinition">{value}</extended>'


def deviation(content, key="Instructions"):
    inner = f'<value t="NeedDeviation"><deviation>{content}</deviation></value>'
    return f'<default key="{key}">{inner}</default>'


def bound(tag, value, kind="LongObject", more=""):
    return f'<{tag} t="{kind}" value="{value}"{more}/>'


# Instructions become ticks


@pytest.mark.parametrize("value", ["0", "-1", "nan", "inf", "NaN", "Infinity", "much", ""])
def test_impossible_instructions_per_cycle_divide_nothing(same, value):
    units = hardware(("P", value))
    notes = same(
        runnable(need(default(10), extended("P", 8))) + units,
        runnable(ticks(constant(10), of_definition("P", constant(8, "value")))) + units,
    )
    assert ("not a number of instructions per cycle; assuming 1", value) in of_kind(notes, NoteKind.DEFAULTED)


@pytest.mark.parametrize(("features", "missing"), [("Instructions/IPC_2.0", ["Instructions/IPC_2.0"]), ("FLOP/x", [])])
def test_instructions_per_cycle_in_a_missing_file_are_reported(tmp_path, features, missing):
    definition = f'<definitions t="ProcessingUnitDefinition" name="P" features="{features}?type=HwFeature"/>'
    content = f"{runnable(need(default(10)))}<hwModel>{definition}</hwModel>"
    _, notes = migrated(written(tmp_path, "0.9.2", content), "0.9.3")
    message = "number of instructions per cycle not found in the files; assuming 1"
    assert of_kind(notes, NoteKind.DEFAULTED) == [(message, name) for name in missing]


@pytest.mark.parametrize("other", ["", '<hwModel><definitions t="MemoryDefinition" name="M"/></hwModel>'])
def test_missing_hardware_is_reported(tmp_path, other):
    _, notes = migrated(written(tmp_path, "0.9.2", runnable(need(default(1), extended("P", 8))) + other), "0.9.3")
    assert of_kind(notes, NoteKind.DEFAULTED) == [
        ("no definition of a processing unit in the files; assuming 1 instruction per cycle", ""),
        ("definition of a processing unit not found in the files; assuming 1 instruction per cycle", ""),
    ]


def test_custom_properties_and_comments_stay(tmp_path):
    content = need(text_property("k", "v"), "<!-- why -->", default(5))
    models, _ = migrated(written(tmp_path, "0.9.2", runnable(content)), "0.9.3")
    item = models.trees[0].root.find("swModel", "runnables", "runnableItems")[0]
    assert [child.tag for child in item.children] == ["customProperties", "default"]
    assert item.children[1].comments == ["<!-- why -->"]


# Deviations


@pytest.mark.parametrize(
    ("distribution", "result"),
    [
        ('t="BetaDistribution" alpha="0.5" beta="2.0"', 'BetaDistribution" alpha="0.5" beta="2.0"'),
        ('t="Boundaries" samplingType="BestCase"', 'Boundaries" samplingType="BestCase"'),
        ('t="UniformDistribution"', 'UniformDistribution"'),
        ('t="WeibullEstimators" pRemainPromille="3"', 'WeibullEstimatorsDistribution" pRemainPromille="3"'),
    ],
)
def test_each_kind_of_values_has_its_classes(same, distribution, result):
    def given(kind):
        return bound("lowerBound", 1, kind) + bound("upperBound", 2, kind) + f"<distribution {distribution}/>"

    times = '<lowerBound value="1"/><upperBound value="2"/>'
    numbers = 'lowerBound="1" upperBound="2"'
    rate = '<stimuli t="VariableRateStimulus" name="V">{}</stimuli>'
    jitter = '<stimuli t="PeriodicStimulus" name="P">{}</stimuli>'
    same(
        runnable(need(deviation(given("LongObject"))))
        + "<stimuliModel>"
        + rate.format(f"<occurrencesPerStep>{given('DoubleObject')}</occurrencesPerStep>")
        + jitter.format(f"<jitter>{given('Time')}</jitter>")
        + "</stimuliModel>",
        runnable(ticks(f'<default t="DiscreteValue{result} {numbers}/>'))
        + "<stimuliModel>"
        + rate.format(f'<occurrencesPerStep t="ContinuousValue{result} {numbers}/>')
        + jitter.format(f'<jitter t="Time{result}>{times}</jitter>')
        + "</stimuliModel>",
    )


def test_weibull_parameters_are_kept_as_text(same):
    weibull = '<distribution t="WeibullParameters" kappa="5.0" lambda="6.0"/>'
    given = bound("lowerBound", 10) + bound("upperBound", 20) + weibull
    bounds = '<default t="DiscreteValueBoundaries" lowerBound="10" upperBound="20"/>'
    kept = text_property("WeibullParameters", "kappa=5.0 lambda=6.0")
    same(runnable(need(deviation(given))), runnable(ticks(kept, bounds)))
    without_bounds = same(runnable(need(deviation(weibull))), runnable(ticks(kept)))
    assert of_kind(without_bounds, NoteKind.LOST) == [("neither a value nor bounds are specified", "")]


@pytest.mark.parametrize("name", ["lowerBound", "upperBound"])
def test_one_bound_is_enough_to_be_kept(same, name):
    periodic = '<stimuliModel><stimuli t="PeriodicStimulus" name="S">{}</stimuli></stimuliModel>'
    given = periodic.format(f"<jitter>{bound(name, 20, 'Time')}</jitter>")
    same(given, periodic.format(f'<jitter t="TimeBoundaries"><{name} value="20"/></jitter>'))
    notes = same(periodic.format("<jitter/>"), periodic.format(""))
    assert of_kind(notes, NoteKind.LOST) == [("neither a value nor bounds are specified", "")]


@pytest.mark.parametrize(
    ("distribution", "known"), [("BetaDistribution", {"alpha": "1.0"}), ("WeibullParameters", {"kappa": "1.0"})]
)
def test_unknown_attributes_of_distributions_are_lost(tmp_path, distribution, known):
    stated = " ".join(f'{name}="{text}"' for name, text in {**known, "odd": "2"}.items())
    given = bound("lowerBound", 1) + bound("upperBound", 2) + f'<distribution t="{distribution}" {stated}/>'
    models, notes = migrated(written(tmp_path, "0.9.2", runnable(need(deviation(given)))), "0.9.3")
    assert of_kind(notes, NoteKind.LOST) == [("not an attribute of this class", "odd='2'")]
    assert not any("odd" in text for node in models.walk() for text in (*node.attributes, *node.attributes.values()))


def test_comments_inside_deviations_stay(tmp_path):
    given = f"<!-- a -->{bound('lowerBound', 1)}{bound('upperBound', 2)}<!-- b --><distribution t='UniformDistribution'/>"
    models, _ = migrated(written(tmp_path, "0.9.2", runnable(need(deviation(given)))), "0.9.3")
    (found,) = models.parts("swModel", "runnables", "runnableItems", "default")
    assert sorted(found.comments or ()) == ["<!-- a -->", "<!-- b -->"]


# Stimuli, hardware, operating systems


def test_chunks(same):
    def access(attribute):
        return runnable(f'<runnableItems t="ChannelSend"><transmissionPolicy {attribute}="10"/></runnableItems>')

    notes = same(access("chunkProcessingInstructions"), access("chunkProcessingTicks"))
    assert (notes[-1].kind, notes[-1].attribute) == (NoteKind.RENAMED, "chunkProcessingInstructions")
    units = hardware(("P", "0.5"))
    notes = same(access("chunkProcessingInstructions") + units, access("chunkProcessingTicks") + units)
    assert [detail for _, detail in of_kind(notes, NoteKind.TO_CHECK)] == ["10"]


def overheads(content, more=""):
    return f'<osModel><osOverheads name="o 1">{content}</osOverheads>{more}</osModel>'


def test_overheads_are_ticks_of_each_definition(same):
    units = hardware(("P", "2.0"))
    given = '<apiOverhead><apiSetEvent t="InstructionsConstant" value="9"/></apiOverhead>'
    result = constant(9) + of_definition("P", constant(4, "value"))
    same(overheads(given) + units, overheads(f"<apiOverhead><apiSetEvent>{result}</apiSetEvent></apiOverhead>") + units)
    nothing = '<apiOverhead><apiSetEvent t="InstructionsDeviation"/></apiOverhead>'
    same(overheads(nothing) + units, overheads("<apiOverhead><apiSetEvent/></apiOverhead>") + units)


@pytest.mark.parametrize("kind", ["", ' t="InstructionsDeviation"'])
def test_overheads_with_bounds_beside_custom_properties(same, kind):
    bounds = bound("lowerBound", 1) + bound("upperBound", 4) + '<distribution t="UniformDistribution"/>'
    own = text_property("k", "v")
    given = f"<apiOverhead>{own}<apiSetEvent{kind}>{own}<deviation>{bounds}</deviation></apiSetEvent></apiOverhead>"
    uniform = '<default t="DiscreteValueUniformDistribution" lowerBound="1" upperBound="4"/>'
    same(overheads(given), overheads(f"<apiOverhead>{own}<apiSetEvent>{own}{uniform}</apiSetEvent></apiOverhead>"))


# Snapshots of the development, damaged files, large files


def test_a_file_of_the_newer_version_is_converted_where_it_is_old(tmp_path):
    content = runnable(need(default(5)) + ticks(constant(6))) + overheads(
        f"<apiOverhead><apiSetEvent>{constant(4)}</apiSetEvent><apiWaitEvent/></apiOverhead>"
    )
    once, notes = migrated(written(tmp_path, "0.9.3", content), "0.9.3")
    twice, _ = migrated(written(tmp_path, "0.9.3", content.replace(need(default(5)), ticks(constant(5)))), "0.9.3")
    assert meaning(once) == meaning(twice)
    assert not of_kind(notes, NoteKind.LOST)


@pytest.mark.parametrize(
    "content",
    [
        runnable(need("<default/>", "<default key='Instructions'/>", "<extended/>", "<extended><value/></extended>")),
        runnable(need(deviation(""), deviation("<distribution/>", "FLOP"))),
        runnable(need(deviation('<lowerBound/><upperBound/><distribution t="GaussDistribution"><mean/></distribution>'))),
        runnable('<runnableItems t="ExecutionNeed"/>'),
        runnable(need(extended("P", 1).replace(' key="P?type=ProcessingUnitDefinition"', ""))),
        runnable(need("<default key='Instructions'><value/></default>")),
        '<hwModel><definitions t="ProcessingUnitDefinition" features="_gone Instructions/x?type=HwFeature"/></hwModel>'
        + runnable(need(default(3), extended("_gone", 2))),
        '<osModel><osOverheads><apiOverhead><apiSetEvent t="InstructionsDeviation"/></apiOverhead></osOverheads></osModel>',
        '<stimuliModel><stimuli t="PeriodicStimulus"><jitter/></stimuli></stimuliModel>',
        '<hwModel><definitions><accessLatency t="LatencyDeviation"/></definitions></hwModel>',
    ],
)
def test_damaged_content_is_survived(tmp_path, content):
    migrated(written(tmp_path, "0.9.2", content), "0.9.3")


def test_a_root_that_states_a_class_of_parts_is_survived(tmp_path):
    (path,) = written(tmp_path, "0.9.2", "")
    path.write_text(path.read_text("utf-8").replace("<am:Amalthea ", '<am:Amalthea t="LatencyConstant" '), "utf-8")
    migrated([path], "0.9.3")


@pytest.mark.parametrize(("most", "is_stated"), [("10", True), ("11", False)])
def test_the_recurrence_of_a_periodic_activation_is_stated_where_it_follows(tmp_path, most, is_stated):
    ends = f'<min value="10" unit="ms"/><max value="{most}" unit="ms"/>'
    models, _ = migrated(
        written(tmp_path, "0.9.2", f'<swModel><activations t="PeriodicActivation">{ends}</activations></swModel>'), "0.9.3"
    )
    (activation,) = models.trees[0].root.find("swModel", "activations")
    assert [(part.tag, part.get("value")) for part in activation.children] == [
        ("min", "10"),
        ("max", most),
        *([("recurrence", "10")] if is_stated else []),
    ]
