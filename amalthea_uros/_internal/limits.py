"""How much is read at most, so that no file exhausts the memory; `docs/check.md` tells users of it.

The largest published model has 6 MB and 76,000 elements. `AMUROS_LIMITS=4` in the environment allows four times as much of everything.
"""

from __future__ import annotations

import os
import re

#: The environment variable with the factor; the environment is up to the user, and not to the files that are read.
VARIABLE = "AMUROS_LIMITS"


def _factor() -> int:
    given = os.environ.get(VARIABLE) or "1"
    if re.fullmatch("[1-9][0-9]{0,3}", given) is None:
        raise ValueError(f"{VARIABLE} must be a whole number from 1 to 9999, not {given[:40]!r}; e.g. {VARIABLE}=4")
    return int(given)


_FACTOR = _factor()
#: What to do about a file that is too large, as a sentence.
ADVICE = f"If you trust the file, raise all limits by a factor: {VARIABLE}={4 * _FACTOR} in the environment."

#: In bytes, unpacked.
MODEL_SIZE = _FACTOR * 256 * 2**20
#: Elements of a model take up to 900 bytes each, however short they are written.
MODEL_ELEMENTS = _FACTOR * 1_000_000
#: Ids in attributes with several.
MODEL_REFERENCES = _FACTOR * 1_000_000
#: Findings of a rule in a model; each takes about 1.5 kB.
RULE_FINDINGS = _FACTOR * 100_000
#: In bytes.
DESCRIPTION_SIZE = _FACTOR * 5 * 2**20
#: Values of a description, those of expanded aliases included.
DESCRIPTION_VALUES = _FACTOR * 400_000
#: Settings of a project, in bytes.
SETTINGS_SIZE = _FACTOR * 2**20
#: Rules of a user, in bytes.
RULES_SIZE = _FACTOR * 5 * 2**20
#: In bytes: a million findings.
BASELINE_SIZE = _FACTOR * 128 * 2**20
#: Characters of a line of a trace; traces themselves are read part by part, and may be of any size.
TRACE_LINE = _FACTOR * 2**16
#: A file of source code, in bytes.
SOURCE_SIZE = _FACTOR * 4 * 2**20
#: All files of source code together, in bytes; a syntax tree takes about ten times as much.
SOURCES_SIZE = _FACTOR * 32 * 2**20
#: Files of source code.
SOURCE_FILES = _FACTOR * 5_000
#: Occurrences of a stimulus in a simulation: machine code takes minutes for so many, Python hours.
SIMULATED_OCCURRENCES = _FACTOR * 1_000_000_000
#: Occurrences of all stimuli in all runs of a campaign: hours with machine code.
CAMPAIGN_OCCURRENCES = _FACTOR * 100_000_000_000
#: Values in the table of a campaign or a sweep; each takes about 60 bytes.
CAMPAIGN_VALUES = _FACTOR * 20_000_000
#: Numbers in the queues of activations that wait in a simulation; each takes up to 40 bytes.
WAITING_NUMBERS = _FACTOR * 2**24
#: Nodes of syntax trees that are visited, those of a function once for each of its calls.
SOURCE_NODES = _FACTOR * 500_000
#: Items of loops of source code, those of a loop once for each condition under which something is in it.
SOURCE_LOOP_ITEMS = _FACTOR * 1_000_000
