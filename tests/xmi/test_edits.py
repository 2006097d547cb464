"""A change shows only where it was made, however the file is laid out."""

import difflib
from itertools import permutations, product

import pytest
from support import DATA, MODEL, meaning

import amalthea_uros as amuros
from amalthea_uros.am import Label, LabelAccess, PeriodicStimulus, Preemption, Runnable, RunnableCall, Task, Time

UGLY = """<?xml version='1.0' encoding='UTF-8' standalone="no"?>
<!-- made by hand -->
<a:Amalthea xmlns:a="http://app4mc.eclipse.org/amalthea/3.3.0"  xmi:version="2.0"
   xmlns:xmi="http://www.omg.org/XMI" xmlns:t="http://www.w3.org/2001/XMLSchema-instance" >
\t<swModel>
\t\t<!-- the only task -->
\t\t<tasks preemption='preemptive' name="T"
\t\t       vendorNote="fast &gt; small" stimuli = "S?type=PeriodicStimulus" ><activityGraph ><items
\t\t  t:type="a:RunnableCall" runnable="R?type=Runnable" /><!-- then -->
\t\t<items runnable="Q?type=Runnable" t:type="a:RunnableCall"></items>
\t\t</activityGraph></tasks>
\t\t<labels name="L1"/> <runnables name="R" ></runnables><labels name="L&#x32;"/>
\t\t<vendorThing a="1"><deep/></vendorThing>
\t\t<runnables name="Q"/>
\t</swModel>
\t<stimuliModel><stimuli name="S" t:type="a:PeriodicStimulus"><offset unit="ms" value="+05"/></stimuli></stimuliModel>
</a:Amalthea>
<!-- the end -->
"""


@pytest.fixture
def ugly(tmp_path):
    path = tmp_path / "ugly.amxmi"
    path.write_text(UGLY)
    return amuros.load(path)


@pytest.fixture
def neat(tmp_path):
    path = tmp_path / "brake.amxmi"
    path.write_bytes((DATA / "brake.amxmi").read_bytes())
    return amuros.load(path)


def changes(model):
    """The lines that saving takes away and puts in; the saved file means what the model means."""
    path = model.documents[0].path
    before = path.read_text()
    amuros.save(model)
    assert meaning(amuros.load(path)) == meaning(model)
    lines = difflib.ndiff(before.splitlines(), path.read_text().splitlines())
    return [line for line in lines if line[0] in "+-"]


def expect(model, *replacements):
    """Saving replaces just these texts, each of which stands once in the file; it means what the model means."""
    path = model.documents[0].path
    expected = path.read_text()
    for old, new in replacements:
        assert expected.count(old) == 1
        expected = expected.replace(old, new)
    amuros.save(model)
    assert path.read_text() == expected
    assert meaning(amuros.load(path)) == meaning(model)


def test_a_changed_value(neat):
    neat[Task, "Brake (left)"].multiple_task_activation_limit = 3
    gone, come = changes(neat)
    assert gone[2:].replace('Limit="1"', 'Limit="3"') == come[2:]


def test_a_changed_value_of_a_part(neat):
    next(neat.all(Time)).value = 20
    assert changes(neat) == ['-       <recurrence value="10" unit="ms"/>', '+       <recurrence value="20" unit="ms"/>']


def test_a_new_part(neat):
    neat[Task, "Brake (left)"].activity_graph.items.insert(1, RunnableCall(runnable=neat[Runnable, "Read"]))
    assert changes(neat) == ['+         <items xsi:type="am:RunnableCall" runnable="Read?type=Runnable"/>']


def test_a_first_part(neat):
    neat[Runnable, "Act"].activity_graph = amuros.am.ActivityGraph(items=[LabelAccess(data=neat[Label, "Pedal"])])
    assert changes(neat) == [
        '-     <runnables xmi:id="Act?type=Runnable" name="Act" callback="false" service="false"/>',
        '+     <runnables xmi:id="Act?type=Runnable" name="Act" callback="false" service="false">',
        "+       <activityGraph>",
        '+         <items xsi:type="am:LabelAccess" data="Pedal?type=Label"/>',
        "+       </activityGraph>",
        "+     </runnables>",
    ]


def test_a_removed_part(neat):
    del neat[Task, "Brake (left)"].activity_graph.items[0]
    assert changes(neat) == ['-         <items xsi:type="am:RunnableCall" runnable="Read?type=Runnable"/>']


def test_the_last_part_removed(neat):
    neat[Label, "Pedal"].size = None
    assert sorted(line.replace(" ", "") for line in changes(neat)) == [
        '+<labelsxmi:id="Pedal?type=Label"name="Pedal"displayName=""constant="false"bVolatile="false"/>',
        "-</labels>",
        '-<labelsxmi:id="Pedal?type=Label"name="Pedal"displayName=""constant="false"bVolatile="false">',
        '-<sizevalue="16"unit="bit"/>',
    ]


def test_a_new_order(neat):
    neat[Task, "Brake (left)"].activity_graph.items.reverse()
    gone, come = changes(neat)
    assert gone[2:] == come[2:]


def test_a_rename_reaches_every_reference(neat):
    neat[Runnable, "Read"].name = "Read & check"
    lines = changes(neat)
    assert len(lines) == 4
    assert [line for line in lines if line[0] == "+"] == [
        '+         <items xsi:type="am:RunnableCall" runnable="Read+%26+check?type=Runnable"/>',
        '+     <runnables xmi:id="Read+%26+check?type=Runnable" name="Read &amp; check" callback="false" service="false">',
    ]


def test_ugly_files_are_written_as_they_are(ugly):
    ugly.documents[0].changes.modified.update(ugly.walk())
    expect(ugly)


def test_a_changed_value_in_an_ugly_file(ugly):
    ugly[Task, "T"].preemption = Preemption.COOPERATIVE
    expect(ugly, ("preemption='preemptive'", 'preemption="cooperative"'))


def test_a_set_and_an_unset_value_in_an_ugly_file(ugly):
    task = ugly[Task, "T"]
    task.multiple_task_activation_limit = 4
    task.preemption = None
    expect(
        ugly,
        (" preemption='preemptive'", ""),
        ('"S?type=PeriodicStimulus"', '"S?type=PeriodicStimulus" multipleTaskActivationLimit="4"'),
    )


def test_a_part_among_those_of_other_features(ugly):
    next(ugly.all(amuros.am.SWModel)).labels.append(Label(name="L3"))
    new = '<labels xmi:id="L3?type=Label" name="L3" constant="false" bVolatile="false"/>'
    expect(ugly, ('<labels name="L&#x32;"/>', f'<labels name="L&#x32;"/>\n\t\t{new}'))


def test_a_number_spelled_oddly_stays(ugly):
    offset = next(ugly.all(amuros.am.PeriodicStimulus)).offset
    assert offset.value == 5
    offset.unit = amuros.am.TimeUnit.US
    expect(ugly, ('unit="ms" value="+05"', 'unit="us" value="+05"'))


def test_a_removed_part_leaves_the_comments(ugly):
    ugly[Task, "T"].activity_graph.items.pop(0)
    expect(ugly, ('<items\n\t\t  t:type="a:RunnableCall" runnable="R?type=Runnable" />', ""))


def test_unknown_content_is_reported_once_and_can_be_dropped(ugly):
    assert [(f.rule, f.location.line) for f in ugly.findings] == [("XMI011", 8), ("XMI010", 13)]
    software = next(ugly.all(amuros.am.SWModel))
    software.extras.content = [(anchor, raw) for anchor, raw in software.extras.content if "vendorThing" not in raw]
    expect(ugly, ('\n\t\t<vendorThing a="1"><deep/></vendorThing>', ""))


def test_canonical_form_keeps_comments_and_unknown_content(ugly):
    path = ugly.documents[0].path
    amuros.save(ugly, canonical=True)
    text = path.read_text()
    for kept in ("made by hand", "the only task", "<!-- then", "the end", "<deep/>", "vendorNote="):
        assert text.count(kept) == 1
    assert meaning(amuros.load(path)) == meaning(ugly)


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "iso-8859-1"])
def test_other_encodings(encoding, tmp_path):
    name = "utf-8" if encoding == "utf-8-sig" else encoding
    text = UGLY.replace("UTF-8", name).replace('"L1"', '"Größe"')
    path = tmp_path / "model.amxmi"
    path.write_bytes(text.encode(encoding))
    model = amuros.load(path)
    model[Label, "Größe"].constant = True
    amuros.save(model)
    assert path.read_bytes().decode(encoding) == text.replace('"Größe"', '"Größe" constant="true"')


def test_line_ends_of_windows(tmp_path):
    path = tmp_path / "model.amxmi"
    path.write_bytes((DATA / "brake.amxmi").read_bytes().replace(b"\n", b"\r\n"))
    model = amuros.load(path)
    next(model.all(amuros.am.SWModel)).labels.append(Label(name="New"))
    amuros.save(model)
    assert path.read_bytes().count(b"\r\n") == path.read_bytes().count(b"\n") == 30


def test_a_part_moved_within_the_file(neat):
    act, read = neat[Runnable, "Act"], neat[Runnable, "Read"]
    act.activity_graph = read.activity_graph
    assert read.activity_graph is None
    assert changes(neat)


@pytest.mark.parametrize("taken_out", ["the label", "all software"])
def test_a_change_while_an_object_is_out_of_the_model(neat, taken_out):
    root, software = neat.root, neat.root.sw_model
    label = neat[Label, "Pedal"]
    if taken_out == "the label":
        software.labels.remove(label)
        label.size.value = 9
        software.labels.append(label)
    else:
        root.sw_model = None
        label.size.value = 9
        root.sw_model = software
    expect(neat, ('value="16"', 'value="9"'))


def test_an_xsi_type_in_a_file_that_had_none(tmp_path):
    path = tmp_path / "model.amxmi"
    path.write_text(
        '<am:Amalthea xmlns:am="http://app4mc.eclipse.org/amalthea/3.3.0" xmlns:xmi="http://www.omg.org/XMI"><stimuliModel/></am:Amalthea>'
    )
    model = amuros.load(path)
    model.root.stimuli_model.stimuli.append(amuros.am.PeriodicStimulus(name="P"))
    amuros.save(model)
    assert amuros.load(path)[amuros.am.PeriodicStimulus, "P"]


def test_another_version_is_written_whole(neat):
    neat.documents[0].version = "3.3.0"
    amuros.save(neat)
    assert changes(neat) == []
    assert amuros.load(neat.documents[0].path).documents[0].version == "3.3.0"


def test_a_value_that_is_none_of_its_type_stays_once(tmp_path):
    # EMF would write the default of an attribute that is not understood: the text of the file stands in its place.
    path = tmp_path / "model.amxmi"
    stimulus = (
        '<stimuliModel><stimuli xsi:type="am:PeriodicStimulus" name="S"><recurrence {} unit="ms"/></stimuli></stimuliModel>'
    )
    path.write_text(MODEL.format(stimulus.format('value="soon"')))
    amuros.save(amuros.load(path), canonical=True)
    assert path.read_text().count('value="soon"') == 1
    # What is set then takes its place.
    model = amuros.load(path)
    model[PeriodicStimulus, "S"].recurrence.value = 5
    amuros.save(model, canonical=True)
    assert '<recurrence value="5" unit="ms"/>' in path.read_text()


EMF = MODEL.format("""
  <swModel>
    <labels name="A">
      <size value="1" unit="bit"/>
    </labels>
    <labels name="B"/>{between}
    <labels name="C">
      <size value="2" unit="bit"/>
    </labels>
    <labels name="D"/>
  </swModel>
""")


@pytest.mark.parametrize("between", ["", "\n", "<!-- about C -->", "\n    <!-- about C -->", "\n    <unknown/>", " text>"])
@pytest.mark.parametrize(("removed", "modified"), [pair for pair in product(["", *"ABCD"], "ABCD") if pair[0] != pair[1]])
def test_objects_that_stay_are_copied_with_what_is_between_them_but_not_with_one_that_was_removed(
    tmp_path, between, removed, modified
):
    path = tmp_path / "model.amxmi"
    path.write_text(EMF.format(between=between))
    model = amuros.load(path)
    if removed:
        model.documents[0].root.sw_model.labels.remove(model[Label, removed])
    model[Label, modified].constant = True
    amuros.save(model)
    again = amuros.load(path)
    assert [label.name for label in again.all(Label)] == [name for name in "ABCD" if name != removed]
    assert meaning(again) == meaning(model)
    assert between.strip() in path.read_text()


@pytest.mark.parametrize("between", ["<unknown/>", "\n    <unknown/>"])
def test_an_unknown_element_can_be_removed(tmp_path, between):
    path = tmp_path / "model.amxmi"
    path.write_text(EMF.format(between=between))
    model = amuros.load(path)
    model.documents[0].root.sw_model.extras.content.clear()
    model[Label, "D"].constant = True
    amuros.save(model)
    assert path.read_text().count("labels") == 6
    assert between.strip() not in path.read_text()


@pytest.mark.parametrize("order", [*permutations("ABCD")])
def test_objects_in_another_order_are_written_in_that_order(tmp_path, order):
    path = tmp_path / "model.amxmi"
    path.write_text(EMF.format(between=""))
    model = amuros.load(path)
    model.documents[0].root.sw_model.labels.sort(key=lambda label: order.index(label.name))
    amuros.save(model)
    assert [label.name for label in amuros.load(path).all(Label)] == list(order)


def test_an_object_that_was_moved_into_the_one_before_it(tmp_path):
    path = tmp_path / "model.amxmi"
    calls = "".join(f'\n        <items xsi:type="am:RunnableCall" runnable="{name}?type=Runnable"/>' for name in "QR")
    group = '\n        <items xsi:type="am:Group" ordered="true">\n          <items xsi:type="am:Ticks"/>\n        </items>'
    graph = f"\n      <activityGraph>{group}{calls}\n      </activityGraph>"
    runnables = "".join(f'\n    <runnables name="{name}"/>' for name in "QR")
    path.write_text(MODEL.format(f'\n  <swModel>\n    <tasks name="T">{graph}\n    </tasks>{runnables}\n  </swModel>\n'))
    model = amuros.load(path)
    (graph,) = (task.activity_graph for task in model.all(Task))
    first, moved, _ = graph.items
    graph.items.remove(moved)
    first.items.append(moved)
    amuros.save(model)
    (graph,) = (task.activity_graph for task in amuros.load(path).all(Task))
    assert [[type(item).__name__ for item in graph.items], [type(item).__name__ for item in graph.items[0].items]] == [
        ["Group", "RunnableCall"],
        ["Ticks", "RunnableCall"],
    ]
