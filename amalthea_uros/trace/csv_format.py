"""The columns of our CSV files, which hold all that a table of events does: UTF-8, commas, quotes where needed (RFC 4180).

| column | content |
|---|---|
| time_ps | picoseconds |
| event | name of the kind of event, e.g. runnable_start |
| source_kind, source, source_instance | type (letters of BTF, CHAIN), name, and number of the job or occurrence |
| target_kind, target, target_instance | likewise |
| note | a whole number or nothing; for events of OS events the name of the task that owns it |
"""

from __future__ import annotations

from amalthea_uros.trace.table import EventKind

HEADER = ["time_ps", "event", "source_kind", "source", "source_instance", "target_kind", "target", "target_instance", "note"]

#: The kinds of events by their names in files.
EVENT_NAMES = {kind.name.lower(): kind for kind in EventKind}
