"""Parts of models that the examples of several rules share."""

from __future__ import annotations

from textwrap import indent

#: Three events, of which the first two are the start and the end of a task `T`.
TASK_EVENTS = """<eventModel>
  <events xsi:type="am:ProcessEvent" name="a" entity="T?type=Task" eventType="start"/>
  <events xsi:type="am:ProcessEvent" name="b" entity="T?type=Task" eventType="terminate"/>
  <events xsi:type="am:CustomEvent" name="c"/>
</eventModel>"""

#: An operating system with a scheduler `S`.
SCHEDULER = """<osModel>
  <operatingSystems name="OS">
    <taskSchedulers name="S"/>
  </operatingSystems>
</osModel>"""


def runnable_with(items: str) -> str:
    """A model with a runnable `R` that executes some items."""
    return f"""
<swModel>
  <runnables name="R">
    <activityGraph>
{indent(items.strip(), "      ")}
    </activityGraph>
  </runnables>
</swModel>
"""
