"""Activity graphs and interfaces of components."""

from amalthea_uros.xmi.tree.notes import NoteKind


def test_what_is_mandatory_now_is_to_be_checked_and_not_invented(models):
    content = """<swModel><activations t="SingleActivation" name="A"><min value="1" unit="ms"/></activations></swModel>
      <stimuliModel><stimuli t="PeriodicStimulus" name="P"/>
        <stimuli t="RelativePeriodicStimulus" name="R"/>
        <stimuli t="VariableRateStimulus" name="V"/></stimuliModel>
      <componentsModel><systems name="S"><connectors name="x"><sourcePort/></connectors></systems></componentsModel>"""
    assert models.migrate("0.9.6", "0.9.7", content) == models.read("0.9.7", content)
    assert sorted(message.partition(",")[0] for message in models.messages(NoteKind.TO_CHECK)) == [
        "PeriodicStimulus without recurrence",
        "RelativePeriodicStimulus without nextOccurrence",
        "SingleActivation without max",
        "VariableRateStimulus without occurrencesPerStep",
        "sourcePort without port",
    ]
