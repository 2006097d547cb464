"""Findings of reading and writing AMALTHEA models."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.findings.kind import FindingKind

KINDS = (
    FindingKind(
        id="XMI001",
        title="file that cannot be read",
        severity=Severity.ERROR,
        rationale=(
            "The file is missing, empty or a directory, access to it is denied, or the archive is damaged. "
            "Nothing else is known of it."
        ),
        remedy="Check the path and the permissions, and that the file was written completely.",
    ),
    FindingKind(
        id="XMI002",
        title="file that is not well-formed XML",
        severity=Severity.ERROR,
        rationale="Reading stops here: a model is an XML file in UTF-8, plain or in a ZIP archive.",
        remedy="Correct the syntax at this place.",
        fails="""
<swModel><tasks name="T"></swModel>
""",
    ),
    FindingKind(
        id="XMI003",
        title="document type declaration",
        severity=Severity.ERROR,
        rationale="A DTD may define entities that expand to gigabytes or read other files, so it is refused. Models have none.",
        remedy="Remove the declaration.",
        fails="""
<!DOCTYPE model [<!ENTITY a "b">]>
<am:Amalthea xmlns:am="http://app4mc.eclipse.org/amalthea/3.3.0"/>
""",
    ),
    FindingKind(
        id="XMI004",
        title="file that is too large, has too many elements, or is nested too deeply",
        severity=Severity.ERROR,
        rationale="Such content could exhaust the memory, so it is refused.",
        remedy="If the file can be trusted, set AMUROS_LIMITS=4 in the environment for four times as much.",
    ),
    FindingKind(
        id="XMI005",
        title="root element that is not an AMALTHEA model",
        severity=Severity.ERROR,
        rationale="The file is XML, but not a model, so nothing in it can be read.",
        remedy='Start the model with `<am:Amalthea xmlns:am="http://app4mc.eclipse.org/amalthea/3.3.0">`.',
        fails="""
<am:Software xmlns:am="http://app4mc.eclipse.org/amalthea/3.3.0"/>
""",
    ),
    FindingKind(
        id="XMI006",
        title="AMALTHEA version that was never published",
        severity=Severity.ERROR,
        rationale=(
            "Models of every published version can be read: 1.1.0, 1.2.0 and 1.3.0 of ITEA, and 0.7.0 to 3.3.0 of APP4MC. What a "
            "file of another old version means is not known."
        ),
        remedy="Correct the version in the namespace of the root element.",
        fails="""
<am:Amalthea xmlns:am="http://app4mc.eclipse.org/amalthea/0.8.7"/>
""",
    ),
    FindingKind(
        id="XMI007",
        title="unknown AMALTHEA version",
        severity=Severity.WARNING,
        rationale=(
            "The file is read as the nearest known version. Content that its own version added is preserved, but "
            "not understood."
        ),
        remedy="Correct the version in the namespace of the root element if it is a mistake.",
        fails="""
<am:Amalthea xmlns:am="http://app4mc.eclipse.org/amalthea/3.4.0"/>
""",
    ),
    FindingKind(
        id="XMI008",
        title="model of an older version that was migrated in memory",
        severity=Severity.INFO,
        rationale=(
            "Models older than 0.9.7 have another structure, so they are migrated to the newest version when they are read. The "
            "file is unchanged, and locations are those in it."
        ),
        remedy="Write the model in a newer version with `amuros migrate`, which also reports what is converted.",
        fails="""
<am:Amalthea xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" xmlns:am="http://app4mc.eclipse.org/amalthea/0.8.1"/>
""",
    ),
    FindingKind(
        id="XMI009",
        title="content that is lost in a migration",
        severity=Severity.WARNING,
        rationale="The new version has no place for it, so it has no effect on checks and analyses, and is not in a migrated file.",
        remedy="Check whether it matters; `amuros migrate --dry-run` lists everything that is converted or lost.",
        fails="""
<am:Amalthea xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" xmlns:am="http://app4mc.eclipse.org/amalthea/0.8.1">
  <swModel>to do</swModel>
</am:Amalthea>
""",
    ),
    FindingKind(
        id="XMI010",
        title="unknown element",
        severity=Severity.WARNING,
        rationale="The element is preserved and written back, but has no effect on checks and analyses.",
        remedy="Correct the name, or remove the element.",
        fails="""
<swModel><task name="T"/></swModel>
""",
    ),
    FindingKind(
        id="XMI011",
        title="unknown attribute",
        severity=Severity.WARNING,
        rationale="The attribute is preserved and written back, but has no effect on checks and analyses.",
        remedy="Correct the name, or remove the attribute.",
        fails="""
<swModel><tasks name="T" priority="1"/></swModel>
""",
    ),
    FindingKind(
        id="XMI012",
        title="object of a class that is not allowed here",
        severity=Severity.ERROR,
        rationale=(
            "The class does not fit the element, or an abstract class needs an xsi:type. The object is preserved "
            "and written back, but has no effect."
        ),
        remedy="Give an xsi:type that the element allows.",
        fails="""
<stimuliModel><stimuli xsi:type="am:Task" name="T"/></stimuliModel>
""",
    ),
    FindingKind(
        id="XMI013",
        title="value of the wrong type",
        severity=Severity.ERROR,
        rationale="The attribute is preserved and written back, but is treated as not set.",
        remedy="Write a value that the attribute allows.",
        fails="""
<swModel><tasks name="T" multipleTaskActivationLimit="many"/></swModel>
""",
    ),
    FindingKind(
        id="XMI014",
        title="second value where one is allowed",
        severity=Severity.ERROR,
        rationale="The first value is used; the second one is preserved and written back.",
        remedy="Keep one of the two.",
        fails="""
<swModel><labels name="L"><size value="1" unit="bit"/><size value="2" unit="bit"/></labels></swModel>
""",
    ),
    FindingKind(
        id="XMI015",
        title="text between elements",
        severity=Severity.WARNING,
        rationale="Models have no text content. The text is preserved and written back, but has no effect.",
        remedy="Remove the text, or make it a comment.",
        fails="""
<swModel>to do<tasks name="T"/></swModel>
""",
    ),
    FindingKind(
        id="XMI020",
        title="unresolved reference",
        severity=Severity.WARNING,
        rationale="The referenced object is not part of the model, so the reference is treated as not set.",
        remedy="Add the object, correct the reference, or load the file that contains the object too.",
        fails="""
<swModel><tasks name="T" stimuli="S?type=PeriodicStimulus"/></swModel>
""",
    ),
    FindingKind(
        id="XMI021",
        title="ambiguous reference",
        severity=Severity.WARNING,
        rationale="Several objects match, and the first one is used. Other tools may use another one.",
        remedy="Give each of the objects a name of its own.",
        fails="""
<swModel><tasks name="T" stimuli="S?type=SingleStimulus"/></swModel>
<stimuliModel>
  <stimuli xsi:type="am:SingleStimulus" name="S"/>
  <stimuli xsi:type="am:SingleStimulus" name="S"/>
</stimuliModel>
""",
    ),
    FindingKind(
        id="XMI022",
        title="xmi:id that differs from the name of the object",
        severity=Severity.INFO,
        rationale="References are resolved by name, so the xmi:id is preserved, but not used.",
        remedy="Write the name of the object as its xmi:id, or remove the xmi:id.",
        fails="""
<swModel><tasks xmi:id="T1?type=Task" name="T"/></swModel>
""",
    ),
    FindingKind(
        id="XMI023",
        title="reference to an object of the wrong class",
        severity=Severity.ERROR,
        rationale="The reference is preserved and written back, but is treated as not set.",
        remedy="Refer to an object of the class that is required.",
        fails="""
<swModel><tasks name="T" stimuli="T?type=Task"/></swModel>
""",
    ),
    FindingKind(
        id="XMI024",
        title="reference in an unusual form",
        severity=Severity.INFO,
        rationale="The reference is understood here, but other tools may not resolve it.",
        remedy="Write the reference as Eclipse APP4MC does, for example with amuros fmt.",
        fails="""
<swModel><tasks name="T" stimuli="S1"/></swModel>
<stimuliModel><stimuli xsi:type="am:SingleStimulus" xmi:id="S1" name="S"/></stimuliModel>
""",
    ),
    FindingKind(
        id="XMI025",
        title="references to files that were not read",
        severity=Severity.WARNING,
        rationale="The referenced objects are not known, so the references are treated as not set.",
        remedy="Give the folder that contains all files of the model, or name the other files too.",
        fails="""
<swModel><tasks name="T"><stimuli xsi:type="am:SingleStimulus" href="amlt:/#S?type=SingleStimulus"/></tasks></swModel>
""",
    ),
    FindingKind(
        id="XMI100",
        title="value that the AMALTHEA version does not allow",
        severity=Severity.ERROR,
        rationale="The model cannot be written in this version without loss, so nothing is written.",
        remedy="Change the value, or write the model in a newer version.",
    ),
    FindingKind(
        id="XMI101",
        title="file that cannot be written",
        severity=Severity.ERROR,
        rationale="The path is not writable, exists already, or does not fit the model. Existing files are left unchanged.",
        remedy="Check the path and the permissions; a model of several files needs a folder.",
    ),
    FindingKind(
        id="XMI102",
        title="content that an older AMALTHEA version cannot hold",
        severity=Severity.ERROR,
        rationale="The migration to the older version would lose it, so no file of the model is written.",
        remedy="Remove it from the model, or choose a newer version.",
    ),
    FindingKind(
        id="XMI103",
        title="migration that is not possible",
        severity=Severity.ERROR,
        rationale=(
            "No migration leads from the version of the file to the one that is wanted. Models are migrated to any newer version, "
            "and back to 1.2.0."
        ),
        remedy="Choose another version.",
    ),
    FindingKind(
        id="XMI104",
        title="old model that has to be migrated before it is written",
        severity=Severity.ERROR,
        rationale=(
            "The model was migrated in memory when it was read. Saving it over the old file would change the version of the file "
            "without saying so, and what was lost could not be restored."
        ),
        remedy="Migrate the file with `amuros migrate`, or save the model with its new version: save(model, path, version=...).",
    ),
    FindingKind(
        id="XMI105",
        title="migration that failed",
        severity=Severity.ERROR,
        rationale="This is an error in amuros, or there is too little memory. The files are unchanged; other models are migrated "
        "nevertheless.",
        remedy="Report the message together with the model, unless it is about memory.",
    ),
    FindingKind(
        id="XMI106",
        title="model that would be read differently",
        severity=Severity.ERROR,
        rationale="The text is read again before it is written. Reading it would not give the same model, so nothing is written. This "
        "happens if something unknown, or a second value where one is allowed, would be read as the value of the object.",
        remedy="Remove what is unknown or given twice. If there is nothing like that, report the message together with the model.",
    ),
)
