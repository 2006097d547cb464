"""One module per step that changes much, from the oldest version to the newest and back."""

from __future__ import annotations

from amalthea_uros.xmi.migrate.steps import (
    back,
    itea_1_2,
    itea_1_3,
    v0_7_0,
    v0_7_1,
    v0_7_2,
    v0_8_0,
    v0_8_1,
    v0_8_3,
    v0_9_0,
    v0_9_3,
    v0_9_4,
    v0_9_5,
    v0_9_7,
    v2_0_0,
    v3_0_0,
)
from amalthea_uros.xmi.tree.model_set import Step

#: From the oldest version to the newest.
UP = (
    itea_1_2.STEP,
    itea_1_3.STEP,
    v0_7_0.STEP,
    v0_7_1.STEP,
    v0_7_2.STEP,
    v0_8_0.STEP,
    v0_8_1.STEP,
    Step("0.8.1", "0.8.2"),
    v0_8_3.STEP,
    v0_9_0.STEP_0_9_0,
    v0_9_0.STEP_0_9_1,
    Step("0.9.1", "0.9.2"),
    v0_9_3.STEP,
    v0_9_4.STEP,
    v0_9_5.STEP,
    v0_9_7.STEP_0_9_6,
    v0_9_7.STEP_0_9_7,
    Step("0.9.7", "0.9.8", v0_9_0.state_units),
    Step("0.9.8", "0.9.9"),
    v2_0_0.STEP_1_0_0,
    Step("1.0.0", "1.1.0"),
    v2_0_0.STEP_1_2_0,
    v2_0_0.STEP,
    v3_0_0.STEP_2_1_0,
    Step("2.1.0", "2.2.0"),
    v3_0_0.STEP_3_0_0,
    Step("3.0.0", "3.1.0"),
    Step("3.1.0", "3.2.0"),
    Step("3.2.0", "3.3.0"),
)

#: Back, as far as models are written.
DOWN = (
    Step("3.3.0", "3.2.0"),
    Step("3.2.0", "3.1.0"),
    Step("3.1.0", "3.0.0"),
    back.STEP_2_2_0,
    Step("2.2.0", "2.1.0"),
    back.STEP_2_0_0,
    back.STEP_1_2_0,
)
