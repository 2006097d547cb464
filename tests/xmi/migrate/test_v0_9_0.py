"""0.8.3 -> 0.9.0: what the vectors do not show."""

import pytest
from migration import migrated, model

from amalthea_uros.xmi.tree.notes import NoteKind

QUARTZ = '<quartzes name="Q"><frequency value="100.0" unit="MHz"/></quartzes>'


def write(path, content, version="0.8.3"):
    path.write_text(model(version, content), "utf-8")
    return path


@pytest.fixture
def convert(tmp_path):
    """One file of 0.8.3 with that content -> the root after the step, and its notes."""

    def converted(content, target="0.9.0", version="0.8.3"):
        models, notes = migrated([write(tmp_path / "model.amxmi", content, version)], target)
        return models.trees[0].root, notes

    return converted


def on_chip(content, around="", before=""):
    """A hardware model with something in a microcontroller."""
    chip = f'<ecus name="E"><microcontrollers name="M">{content}</microcontrollers></ecus>'
    return f'<hwModel>{before}<system name="S">{chip}{QUARTZ}</system>{around}</hwModel>'


def chip(root):
    return root.find("hwModel", "structures", "structures", "structures")[0]


def module(root, name):
    return next(node for node in chip(root).walk() if node.name == name and node.tag in ("modules", "caches"))


def lost(notes):
    return {note.message for note in notes if note.kind is NoteKind.LOST}


def domain_of(root, name="C"):
    domain = module(root, name).target("frequencyDomain")
    value = domain.child("defaultValue")
    return domain.name, value.get("value"), value.get("unit")


class TestClocks:
    def prescaled(self, ratio, quartz=QUARTZ):
        prescaler = f'<cores name="C"><prescaler {ratio} quartz="Q?type=Quartz"/></cores>'
        return on_chip(prescaler).replace(QUARTZ, quartz)

    @pytest.mark.parametrize("ratio", ["", 'clockRatio="1"', 'clockRatio="1.0"', 'clockRatio="0.0"', 'clockRatio="0"'])
    def test_without_a_ratio_the_clock_is_that_of_the_quartz(self, convert, ratio):
        root, _ = convert(self.prescaled(ratio))
        assert domain_of(root) == ("Q", "100.0", "MHz")

    def test_a_ratio_of_zero_is_noted_as_assumption(self, convert):
        _, notes = convert(self.prescaled('clockRatio="0.0"'))
        assert [note.detail for note in notes if note.kind is NoteKind.DEFAULTED] == ["0.0"]

    def test_modules_with_the_same_ratio_share_a_domain(self, convert):
        prescaler = '<prescaler clockRatio="2.0" quartz="Q?type=Quartz"/>'
        root, _ = convert(on_chip(f'<cores name="C">{prescaler}</cores><memories name="R">{prescaler}</memories>'))
        assert module(root, "C").target("frequencyDomain") is module(root, "R").target("frequencyDomain")
        assert [node.name for node in root.find("hwModel", "domains")] == ["Q", "Q__2.0"]

    def test_a_frequency_that_is_no_number_is_not_that_of_the_quartz(self, convert):
        quartz = '<quartzes name="Q"><frequency value="fast"/></quartzes>'
        root, notes = convert(self.prescaled('clockRatio="0.5"', quartz))
        assert module(root, "C").target("frequencyDomain").child("defaultValue") is None
        assert "frequency after a prescaler: not a number" in lost(notes)

    def test_a_negative_ratio_gives_no_frequency(self, convert):
        root, notes = convert(self.prescaled('clockRatio="-0.5"'))
        assert module(root, "C").target("frequencyDomain").child("defaultValue") is None
        assert "frequency after a prescaler: negative" in lost(notes)

    def test_a_quartz_that_is_in_no_file(self, convert):
        content = '<cores name="C{0}"><prescaler clockRatio="{0}"><quartz href="amlt:/#X?type=Quartz"/></prescaler></cores>'
        root, notes = convert(on_chip(content.format("1.0") + content.format("0.5")))
        target = module(root, "C1.0").target("frequencyDomain")
        assert (target.get("path"), target.target_class) == ("X", "FrequencyDomain")
        assert "frequencyDomain" not in module(root, "C0.5").references
        assert "prescaler: its quartz is not in the files" in lost(notes)

    def test_the_unit_is_stated_after_the_last_version_with_known_results_of_app4mc(self, convert):
        quartz = '<quartzes name="Q"><frequency value="2.0E8"/></quartzes>'
        content = self.prescaled('clockRatio="0.5"', quartz).replace(
            "<hwModel>", '<hwModel><memoryTypes name="T"><size value="32768"/></memoryTypes>'
        )
        for target, units in (("0.9.7", {""}), ("0.9.8", {"Hz", "B"})):
            root, _ = convert(content, target)
            found = root.find("hwModel", "domains", "defaultValue") + root.find("hwModel", "definitions", "size")
            assert {node.get("unit") for node in found} == units
        native = '<hwModel><domains t="FrequencyDomain" name="D"><defaultValue value="5.0"/></domains></hwModel>'
        root, _ = convert(native, "0.9.8", version="0.9.7")
        assert root.find("hwModel", "domains", "defaultValue")[0].get("unit") == ""


class TestDefinitions:
    @pytest.mark.parametrize(
        ("policy", "expected"),
        [
            ("RROBIN", "RoundRobin"),
            ("PRIORITY", "PriorityBased"),
            ("_undefined_", "_undefined_"),
            ("odd", "_undefined_"),
            (None, ""),
        ],
    )
    @pytest.mark.parametrize("kind", ["Bus", "Bridge", "CrossbarSwitch", ""])
    def test_networks_types(self, convert, kind, policy, expected):
        stated = f' schedPolicy="{policy}"' if policy else ""
        stated += f' t="{kind}"' if kind else ""
        root, _ = convert(f'<hwModel><networkTypes name="N" conConnections="0"{stated}/></hwModel>')
        (node,) = root.find("hwModel", "definitions")
        assert (node.type, node.get("policy")) == ("ConnectionHandlerDefinition", expected)


def meaning_of_hardware(root):
    return [f"{node.tag} {node.type} {node.name}" for node in root.child("hwModel").walk() if node.tag != "hwModel"]


class TestStructures:
    def test_memories_and_networks_are_lifted_in_the_order_of_app4mc(self, convert):
        content = (
            '<memories name="m1"><memories name="m2"><networks name="n1"/></memories></memories>'
            '<networks name="n2"><components name="c"><networks name="n3"/><memories name="m3"/></components></networks>'
            '<components name="d"><nestedComponents name="e"><memories name="m4"/><networks name="n4"/></nestedComponents></components>'
            '<cores name="C"><memories name="m5"/><networks name="n5"/></cores><memories name="m6"/>'
        )
        root, notes = convert(on_chip(content))
        expected = ["m1", "m6", "m2", "m3", "m4", "n2", "n3", "n1", "n4", "C", "m5", "n5"]
        assert [node.name for node in chip(root).all("modules")] == expected
        assert "'components' of systems, ECUs and microcontrollers" in lost(notes)

    def test_a_cache_in_a_core_with_port_and_clock(self, convert):
        cache = (
            '<memories name="$" type="T?type=MemoryType"><ports name="p"/><prescaler clockRatio="1.0" quartz="Q?type=Quartz"/>'
            '<memories name="inner"/></memories>'
        )
        content = on_chip(f'<cores name="C">{cache}</cores>', before='<memoryTypes name="T" type="CACHE"/>')
        content += (
            '<swModel><labels name="L"/></swModel>'
            '<mappingModel><memoryMapping abstractElement="L?type=Label" memory="%24?type=Memory"/></mappingModel>'
        )
        root, notes = convert(content)
        assert [(node.name, node.type) for node in chip(root).all("modules")] == [("C", "ProcessingUnit"), ("inner", "Memory")]
        (found,) = chip(root).find("modules", "caches")
        assert (found.type, found.target("definition").type, domain_of(root, "$")[0]) == ("Cache", "CacheDefinition", "Q")
        assert [node.name for node in found.children] == ["p"]
        assert "'memory': caches cannot be referred to" in lost(notes)


def path(latencies, source="C?type=Core", target="R?type=Memory", name="p"):
    return f'<accessPaths t="LatencyAccessPath" name="{name}" source="{source}" target="{target}">{latencies}</accessPaths>'


def constant(value, access="RW", more=""):
    return f'<latencies t="LatencyConstant" accessType="{access}" value="{value}" {more}/>'


class TestAccessPaths:
    def costs(self, root, core="C"):
        return [
            {each.tag: each.get("cycles") for each in element.children} for element in module(root, core).all("accessElements")
        ]

    def test_access_types(self, convert):
        paths = path(constant(1, "R") + constant(2, "W")) + path(constant(3, "W"), name="q")
        root, _ = convert(on_chip('<cores name="C"/><memories name="R"/>', paths))
        assert self.costs(root) == [{"readLatency": "1", "writeLatency": "2"}, {"writeLatency": "3"}]

    def test_a_path_to_a_core(self, convert):
        root, _ = convert(on_chip('<cores name="C"/><cores name="D"/>', path(constant(1), target="D?type=Core")))
        assert module(root, "C").child("accessElements").target("destination") is module(root, "D")

    def test_paths_without_successor(self, convert):
        cache = '<memoryTypes name="T" type="CACHE"/>'
        content = on_chip(
            '<cores name="C"/><memories name="R"/><networks name="N"/><memories name="L2" type="T?type=MemoryType"/>',
            path(constant(1), source="N?type=Network")
            + path(constant(1), target="N?type=Network")
            + path(constant(1), target="L2?type=Memory")
            + '<accessPaths t="HwAccessPath" name="h"/><accessPaths/>',
            cache,
        )
        root, notes = convert(content)
        assert module(root, "C").children == []
        assert len([message for message in lost(notes) if "access path" in message]) == 3

    def test_a_path_from_a_core_in_no_file(self, convert):
        _, notes = convert(on_chip('<memories name="R"/>', path(constant(1), source="gone?type=Core")))
        assert lost(notes) == {"access path whose source is not in the files"}

    def test_without_access_type_both_directions_are_meant(self, convert):
        latency = '<latencies t="LatencyConstant" value="4"/>'
        root, notes = convert(on_chip('<cores name="C"/><memories name="R"/>', path(latency)))
        assert self.costs(root) == [{"readLatency": "4", "writeLatency": "4"}]
        assert any(note.kind is NoteKind.DEFAULTED for note in notes)

    def test_latencies_are_in_cycles_of_the_core(self, convert):
        core = '<cores name="C"><prescaler clockRatio="1.5" quartz="Q?type=Quartz"/></cores><memories name="R"/>'
        deviation = (
            '<latencies t="LatencyDeviation" accessType="R" quartz="Q?type=Quartz"><deviation>'
            '<lowerBound t="LongObject" value="1"/><upperBound t="LongObject" value="9"/></deviation></latencies>'
        )
        paths = path(constant(9, "RW", 'quartz="Q?type=Quartz"')) + path(deviation, name="q") + path(constant(9), name="r")
        root, notes = convert(on_chip(core, paths))
        first, _, third = self.costs(root)
        assert first == {"readLatency": "14", "writeLatency": "14"}
        assert third == {"readLatency": "9", "writeLatency": "9"}
        latency = module(root, "C").all("accessElements")[1].children[0]
        assert [node.get("value") for node in latency.find("cycles")[0].children] == ["1", "14"]
        assert any("cycles of a quartz" in note.message for note in notes)

    def test_latencies_without_quartz_are_assumed_to_be_in_cycles_of_the_core(self, convert):
        content = on_chip('<cores name="C"/><memories name="R"/>', path(constant(9)))
        root, notes = convert(content)
        assert self.costs(root) == [{"readLatency": "9", "writeLatency": "9"}]
        assumed = [note.detail for note in notes if note.kind is NoteKind.DEFAULTED]
        assert assumed == (["9"])

    def test_latencies_of_a_quartz_without_frequency(self, convert):
        more = 'quartz="P?type=Quartz"'
        content = on_chip(
            '<cores name="C"><prescaler quartz="Q?type=Quartz"/></cores><memories name="R"/>', path(constant(9, "R", more))
        )
        root, notes = convert(content.replace(QUARTZ, QUARTZ + '<quartzes name="P"/>'))
        assert self.costs(root) == [{"readLatency": "9"}]
        assert any("frequency" in message for message in lost(notes))

    def test_several_latencies_are_added_up(self, convert):
        inner = path(constant(2) + constant(3, "R"), name="inner")
        outer = path('<latencies t="AccessPathRef" ref="inner?type=LatencyAccessPath"/>' + constant(10), name="outer")
        root, _ = convert(on_chip('<cores name="C"/><memories name="R"/>', inner + outer))
        assert self.costs(root) == [{"readLatency": "5", "writeLatency": "2"}, {"readLatency": "15", "writeLatency": "12"}]

    @pytest.mark.parametrize(("bounds", "expected"), [((4, 9), ["6", "11"]), ((4, None), ["6"]), ((None, None), [])])
    def test_latencies_with_bounds_are_added_up_as_bounds(self, convert, bounds, expected):
        stated = "".join(
            f'<{name} t="LongObject" value="{value}"/>'
            for name, value in zip(("lowerBound", "upperBound"), bounds, strict=True)
            if value is not None
        )
        uniform = '<distribution t="UniformDistribution"/>'
        deviation = f'<latencies t="LatencyDeviation" accessType="R"><deviation>{stated}{uniform}</deviation></latencies>'
        content = on_chip('<cores name="C"/><memories name="R"/>', path(constant(2, "R") + deviation))
        root, notes = convert(content)
        (latency,) = module(root, "C").child("accessElements").children
        assert (latency.tag, latency.type) == ("readLatency", "LatencyDeviation")
        assert [node.get("value") for node in latency.find("cycles")[0].children] == expected
        assert not lost(notes)

    def test_a_path_that_is_part_of_itself(self, convert):
        ref = '<latencies t="AccessPathRef" ref="{}?type=LatencyAccessPath"/>'
        paths = path(ref.format("b") + constant(1), name="a") + path(ref.format("a") + ref.format("x"), name="b")
        root, notes = convert(on_chip('<cores name="C"/><memories name="R"/>', paths))
        assert len(self.costs(root)) == 2
        assert any("part of itself" in message for message in lost(notes))

    def test_paths_that_grow_without_bound(self, convert):
        ref = '<latencies t="AccessPathRef" ref="p{}?type=LatencyAccessPath"/>'
        paths = path(constant(1), name="p0") + "".join(path(ref.format(at) * 2, name=f"p{at + 1}") for at in range(60))
        root, _ = convert(on_chip('<cores name="C"/><memories name="R"/>', paths))
        assert len(self.costs(root)) == 61


class TestNeeds:
    def test_the_category_is_made_once_for_all_files(self, tmp_path):
        default = '<default t="InstructionsConstant" value="1"/>'
        item = f'<runnableItems t="RunnableInstructions">{default}</runnableItems>'
        software = [
            write(tmp_path / f"{at}.amxmi", f"<swModel><runnables name='{at}'>{item}</runnables></swModel>") for at in "ab"
        ]
        models, _ = migrated(software, "0.9.0")
        assert [len(tree.root.find("hwModel", "featureCategories")) for tree in models.trees] == [1, 0]
        hardware = write(tmp_path / "hw.amxmi", "<hwModel><coreTypes name='T' instructionsPerCycle='2'/></hwModel>")
        models, _ = migrated([*software, hardware], "0.9.0")
        assert [len(tree.root.find("hwModel", "featureCategories")) for tree in models.trees] == [0, 0, 1]


class TestReferences:
    CONSTRAINTS = (
        '<constraintsModel><affinityConstraints t="RunnablePairingConstraint"><target t="TargetCore">'
        '<cores href="amlt:/#c1?type=Core"/></target></affinityConstraints>'
        '<affinityConstraints t="DataSeparationConstraint"><target t="TargetMemory">'
        '<memories href="amlt:/#m?type=Memory"/></target></affinityConstraints>'
        '<physicalSectionConstraints name="p"><memories href="amlt:/#m?type=Memory"/></physicalSectionConstraints></constraintsModel>'
        "<eventModel>{}</eventModel>"
        '<mappingModel><physicalSectionMapping><memory href="amlt:/#m?type=Memory"/></physicalSectionMapping></mappingModel>'
    )

    def test_hardware_context(self, convert):
        limit = '<requirements name="r{0}"><limit t="CPUPercentageRequirementLimit" hardwareContext="{0}"/></requirements>'
        limits = limit.format("C?type=Core") + limit.format("E?type=ECU")
        root, notes = convert(on_chip('<cores name="C"/>') + f"<constraintsModel>{limits}</constraintsModel>")
        found = [node.target("hardwareContext") for node in root.find("constraintsModel", "requirements", "limit")]
        assert found == [module(root, "C"), None]
        assert "'hardwareContext' other than a core" in lost(notes)

    def test_custom_properties(self, convert):
        value = '<customProperties key="{0}"><value t="ReferenceObject" value="{0}"/></customProperties>'
        targets = [
            *("C?type=Core", "T?type=CoreType", "N?type=Network", "B?type=Bus", "M?type=Microcontroller", "Q?type=Quartz"),
            "x?type=Task",
        ]
        content = on_chip(
            '<cores name="C"/><networks name="N"/>', before='<coreTypes name="T"/><networkTypes t="Bus" name="B"/>'
        )
        content += f"<swModel><tasks name='x'>{''.join(map(value.format, targets))}</tasks></swModel>"
        root, _ = convert(content)
        kept = [node.children[0].target("value") for node in root.find("swModel", "tasks", "customProperties")]
        assert [node.name for node in kept] == ["C", "T", "N", "B", "M", "Q", "x"]
        assert not any(node.is_proxy for node in kept)


def test_old_content_under_the_new_namespace_is_converted(convert):
    content = on_chip('<cores name="C"/>', before='<coreTypes name="T" instructionsPerCycle="1"/>')
    root, _ = convert(content)
    again, _ = convert(content, version="0.9.0")
    later, _ = convert(content, "0.9.1", version="0.9.1")
    assert meaning_of_hardware(again) == meaning_of_hardware(root) == meaning_of_hardware(later)


@pytest.mark.parametrize(
    "content",
    [
        "<hwModel/>",
        "<hwModel><system/></hwModel>",
        "<hwModel><coreTypes instructionsPerCycle='much'/><memoryTypes/><networkTypes/></hwModel>",
        "<hwModel><system><quartzes/><ecus><microcontrollers><cores><prescaler/><memories/></cores></microcontrollers></ecus></system></hwModel>",
        on_chip('<cores name="C" coreType="x"><prescaler clockRatio="fast" quartz="Q?type=Quartz"/></cores>'),
        on_chip('<memories name="R" type="RAM"/><memories name="R2" type="no?type=MemoryType"/>'),
        on_chip('<cores name="C"/>', "<accessPaths/>" + path("<latencies/>") + path(constant("many"), target="no?type=Memory")),
        on_chip('<cores name="C" coreType="C?type=Core"><memories name="R" type="C?type=Core"/></cores>'),
        "<swModel><runnables><runnableItems t='RunnableInstructions'><default/><extended/><extended><value/></extended>"
        "</runnableItems></runnables></swModel>",
        "<mappingModel><taskAllocation coreAffinity='C'/><memoryMapping memory='R'/></mappingModel>"
        "<eventModel><events core='C'/></eventModel>",
        "<swModel><tasks><customProperties key='k'><value t='ReferenceObject'/></customProperties>"
        "<customProperties/></tasks></swModel>",
    ],
)
def test_damaged_files(convert, content):
    convert(content)
    convert(content, "0.9.2")


def test_the_only_system_without_a_name_becomes_a_structure_with_one(convert):
    assert [node.name for node in convert("<hwModel><system/></hwModel>")[0].find("hwModel", "structures")] == ["System"]
    # Two objects cannot have one name.
    two = convert('<hwModel><system/><system name="System"/></hwModel>')[0].find("hwModel", "structures")
    assert sorted(node.name for node in two) == ["", "System"]
