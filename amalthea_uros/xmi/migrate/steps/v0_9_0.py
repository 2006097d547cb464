"""0.8.3 -> 0.9.0: the hardware model was built anew."""

from __future__ import annotations

from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.notes import Notes
from amalthea_uros.xmi.migrate.step import Step
from amalthea_uros.xmi.migrate.steps.hardware.access_paths import AccessPaths
from amalthea_uros.xmi.migrate.steps.hardware.clocks import Clocks
from amalthea_uros.xmi.migrate.steps.hardware.definitions import Definitions
from amalthea_uros.xmi.migrate.steps.hardware.needs import convert_instructions
from amalthea_uros.xmi.migrate.steps.hardware.references import References
from amalthea_uros.xmi.migrate.steps.hardware.structures import Structures


def change(models: ModelSet, notes: Notes) -> None:
    """Change the content of the files of AMALTHEA 0.8.3."""
    references = References(models, notes)
    references.convert()
    references.convert_proxies()
    clocks = Clocks(notes)
    clocks.convert_quartzes(models)
    definitions = Definitions(models, notes)
    Structures(clocks, notes).convert(models)
    AccessPaths(models, notes).convert()
    definitions.convert()
    needs = convert_instructions(models, notes)
    if needs:
        definitions.need_category(needs[0])


STEP = Step(
    "0.8.3",
    "0.9.0",
    change,
    frozenset(
        {
            "accessPaths",
            "coreTypes",
            "ecus",
            "memoryTypes",
            "microcontrollers",
            "networkTypes",
            "quartzes",
            "system",
            "RunnableInstructions",
        }
    ),
)
