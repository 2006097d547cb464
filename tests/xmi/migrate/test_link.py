"""References of ITEA versions: by UUID, by position, by name, into other files."""

import pytest
from itea import all_of, model, write
from migration import migrated, opened

from amalthea_uros.xmi.tree.results import tree_text

UUID = "_N8EOQJLQEeWQC6k3Y09j_A"
OTHER = "_QcnfcJLQEeWQC6k3Y09j_A"


def runnable(reference, prefix="sw"):
    return f'<swModel><tasks name="T"><callGraph><graphEntries><calls xsi:type="{prefix}:TaskRunnableCall" {reference}'


def call(reference):
    """A software model in which something refers to the runnable R 1."""
    return f"{runnable(reference)}/></graphEntries></callGraph></tasks>"


@pytest.mark.parametrize(
    ("number", "text"),
    [
        ("1.1.0", UUID),
        ("1.2.0", UUID),
        ("1.2.0", "#" + UUID),
        ("1.2.0", "//@swModel/@runnables.1"),
        ("1.2.0", "#//@swModel/@runnables.1"),
        ("1.2.0", "/0/@swModel/@runnables.1"),
        ("1.3.0", "R+1?type=sw.Runnable"),
        ("1.3.0", "R+1?type=Runnable"),
        ("1.3.0", "R%2B1?type=sw.Runnable"),
    ],
)
@pytest.mark.parametrize("form", ['runnable="{}"', '><runnable href="amlt:/#{}"'])
def test_forms_of_references(tmp_path, number, text, form):
    end = "/></graphEntries>" if form.startswith("runnable") else "/></calls></graphEntries>"
    content = f"""{runnable(form.format(text.lstrip("#") if "href" in form else text))}{end}</callGraph></tasks><runnables name="Q"/>
        <runnables xmi:id="{UUID}" name="R 1"/></swModel>"""
    models = opened(*write(tmp_path, number, m__amxmi=content))
    [found] = all_of(models, "calls")
    assert found.target("runnable") is all_of(models, "runnables")[1]
    assert models.proxies == []


def test_a_name_that_is_encoded_as_a_whole(tmp_path):
    other = '<swModel><runnables name="R 1"/></swModel>'
    models = opened(*write(tmp_path, "1.3.0", a__amxmi=hrefs("amlt:/#R+1%3Ftype%3Dsw.Runnable"), b__amxmi=other))
    assert all_of(models, "calls")[0].target("runnable").name == "R 1"


def test_several_targets_keep_their_order(tmp_path):
    content = f"""<componentsModel><elements xsi:type="components:Component" runnables="{OTHER} //@swModel/@runnables.0 {OTHER}"/>
        </componentsModel><swModel><runnables name="A"/><runnables xmi:id="{OTHER}" name="B"/></swModel>"""
    models = opened(*write(tmp_path, "1.2.0", m__amxmi=content))
    assert [node.name for node in all_of(models, "elements")[0].references["runnables"]] == ["B", "A", "B"]


def test_references_are_names_in_the_result(tmp_path):
    content = f'{call(f"runnable={chr(34)}{UUID}{chr(34)}")}<runnables xmi:id="{UUID}" name="R 1"/></swModel>'
    models, _ = migrated(write(tmp_path, "1.2.0", m__amxmi=content), "0.7.0")
    assert 'runnable="R+1?type=Runnable"' in tree_text(models.trees[0])


def test_objects_without_distinct_names_get_them(tmp_path):
    ids = [f"_{number:022d}" for number in range(4)]
    labels = "".join(
        f'<labels xmi:id="{text}" {name}/>' for text, name in zip(ids, ["", "", 'name="L"', 'name="L"'], strict=True)
    )
    component = f'<componentsModel><elements xsi:type="components:Component" labels="{" ".join(ids)}"/></componentsModel>'
    models, notes = migrated(write(tmp_path, "1.2.0", m__amxmi=f"<swModel>{labels}</swModel>{component}"), "0.7.0")
    text = tree_text(models.trees[0])
    assert 'labels="no-name?type=Label no-name_2?type=Label L?type=Label L_2?type=Label"' in text
    assert [note.detail for note in notes if note.message.startswith("made unique")] == [" -> no-name_2", "L -> L_2"]
    path = tmp_path / "again.amxmi"
    path.write_text(text)
    again = opened(path)
    assert all_of(again, "components")[0].references["labels"] == all_of(again, "labels")


def test_files_of_other_folders_belong_to_the_set(tmp_path):
    (tmp_path / "OS x").mkdir()
    (tmp_path / "SW").mkdir()
    write(tmp_path / "OS x", "1.2.0", os__amxmi_os=model("1.2.0", '<semaphores name="s"/>', "os:OSModel"))
    content = """<swModel><runnables><runnableItems xsi:type="sw:SemaphoreAccess"><semaphore
        href="../OS%20x/os.amxmi-os#//@semaphores.0"/></runnableItems></runnables></swModel>"""
    models = opened(*write(tmp_path / "SW", "1.2.0", sw__amxmi=content))
    assert [tree.path.name for tree in models.trees] == ["sw.amxmi", "os.amxmi-os"]
    assert all_of(models, "runnableItems")[0].target("semaphore").name == "s"


def hrefs(*texts):
    calls = "".join(f'<calls xsi:type="sw:TaskRunnableCall"><runnable href="{text}"/></calls>' for text in texts)
    return f"<swModel><tasks><callGraph><graphEntries>{calls}</graphEntries></callGraph></tasks></swModel>"


def test_a_file_that_has_another_name_now_is_found_by_its_uuids(tmp_path):
    other = f'<swModel><runnables xmi:id="{UUID}" name="R"/></swModel>'
    models = opened(*write(tmp_path, "1.2.0", a__amxmi=hrefs(f"sw.amxmi-sw#{UUID}"), b__amxmi=other))
    assert all_of(models, "calls")[0].target("runnable").name == "R"


def test_positions_in_missing_files_are_told_apart(tmp_path):
    texts = ["a.amxmi#//@swModel/@runnables.0", "b.amxmi#//@swModel/@runnables.0", "x.fidl#//@interfaces.0"]
    models = opened(*write(tmp_path, "1.2.0", m__amxmi=hrefs(*texts, f"a.amxmi#{UUID}")))
    assert [node.get("path") for node in models.proxies] == [*texts, UUID]


@pytest.mark.parametrize("text", ["//@swModel/@runnables.7", "//@swModel/@x y", "//@tasks.0/@", UUID, "N?type=sw.Runnable"])
def test_references_to_nowhere(tmp_path, text):
    models = opened(*write(tmp_path, "1.2.0", m__amxmi=hrefs(f"amlt:/#{text}", text.split("?")[0]) + "<swModel/>"))
    assert models.proxies
    assert all(node.is_proxy for found in all_of(models, "calls") for node in found.references["runnable"])


def test_text_that_looks_like_a_reference_stays_text(tmp_path):
    content = f"""<hwModel><ecuTypes name="{UUID}"><attribute xsi:type="hw:StrValue" name="a" value="{OTHER}"/></ecuTypes></hwModel>
        <swModel><customProperties key="{UUID}"><value xsi:type="common:StringObject" value="{UUID}"/></customProperties>
        <labels xmi:id="{UUID}" name="L"/></swModel>"""
    models = opened(*write(tmp_path, "1.2.0", m__amxmi=content))
    assert models.proxies == []
    assert all(not node.references for tree in models.trees for node in tree.root.walk())


@pytest.mark.parametrize("host", ["http://www.amalthea.itea2.org", "http://amalthea.itea2.org"])
def test_namespaces_with_other_prefixes_and_in_inner_elements(tmp_path, host):
    path = tmp_path / "m.amxmi"
    path.write_text(
        f"""<c:AMALTHEA xmlns:c="{host}/model/1.3.0/central" xmlns:xmi="http://www.omg.org/XMI" xmi:version="2.0"
        xmlns:i="http://www.w3.org/2001/XMLSchema-instance"><swModel xmlns:s="{host}/model/1.3.0/sw" xmlns:xsi="x">
        <activations i:type="s:Periodic" name="a"/></swModel></c:AMALTHEA>"""
    )
    models, notes = migrated([path], "0.7.0")
    assert all_of(models, "activations")[0].type == "PeriodicActivation"
    assert [note.kind for note in notes] == ["renamed"]


def test_comments_stay(tmp_path):
    content = """<!-- a --><osModel><!-- b --><scheduler name="s"/><!-- c --></osModel><hwModel><ecuTypes><!-- d -->
        <attribute xsi:type="hw:IntValue" name="i" value="1"/></ecuTypes></hwModel><swModel><tasks><!-- e --><deadline value="1"/>
        </tasks></swModel><!-- f -->"""
    models, _ = migrated(write(tmp_path, "1.1.0", m__amxmi=content), "0.7.0")
    text = tree_text(models.trees[0])
    assert all(text.count(f"<!-- {letter} -->") == 1 for letter in "abcdef")


def test_many_objects_of_one_name_are_told_apart(tmp_path):
    count = 4_000
    labels = "".join(f'<labels xmi:id="_{number:022d}" name="L"/>' for number in range(count))
    used = " ".join(f"_{number:022d}" for number in range(count))
    content = f'<swModel>{labels}</swModel><componentsModel><components labels="{used}"/></componentsModel>'
    models = opened(*write(tmp_path, "1.2.0", m__amxmi=content))
    assert len({node.name for node in all_of(models, "labels")}) == count


def test_a_class_that_two_packages_have(tmp_path):
    content = (
        '<swModel><tasks name="T" stimuli="P?type=stimuli.Periodic"/><runnables name="R" activation="P?type=sw.Periodic"/>'
        '<activations xsi:type="sw:Periodic" name="P"/></swModel>'
        '<stimuliModel><stimuli xsi:type="stimuli:Periodic" name="P"/></stimuliModel>'
    )
    models = opened(*write(tmp_path, "1.3.0", m__amxmi=content))
    (task,), (runnable_,) = models.nodes("tasks"), models.nodes("runnables")
    assert [task.target("stimuli").tag, runnable_.target("activation").tag] == ["stimuli", "activations"]


@pytest.mark.parametrize("text", ["/", "//", "/  /", "/0", "//x", "/a/b", "_ab _cd", "#1"])
def test_a_text_with_slashes_is_no_position(tmp_path, text):
    content = f'<swModel/><stimuliModel><stimuli name="s"><setModeValueList value="{text}"/></stimuli></stimuliModel>'
    (entry,) = all_of(opened(*write(tmp_path, "1.3.0", m__amxmi=content)), "setModeValueList")
    assert (entry.attributes, entry.references) == ({"value": text}, {})
