"""Sizes and shares of transmitted data."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import (
    Channel,
    ChannelAccess,
    DataSize,
    LabelAccess,
    TransmissionPolicy,
    TypeDefinition,
    TypeRef,
)
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.magnitudes import bits
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check_chunk(element: TransmissionPolicy, context: Context) -> Iterator[str]:
    chunk, whole = element.chunk_size, _transmitted(element.container)
    chunk_bits, whole_bits = bits(chunk), bits(whole)
    if chunk is None or whole is None or chunk_bits is None or whole_bits is None:
        return
    if chunk_bits > whole_bits:
        yield f"the chunk size of {chunk.value} {chunk.unit} is larger than the transmitted {whole.value} {whole.unit}"


def _transmitted(access: Element | None) -> DataSize | None:
    """The size of the label, or of an element of the channel, if it is known."""
    match access:
        case LabelAccess(data=data) if data is not None:
            return data.size
        case ChannelAccess(data=Channel(element_type=TypeDefinition(size=size))):
            return size
        case ChannelAccess(data=Channel(element_type=TypeRef(type_def=TypeDefinition(size=size)))):
            return size
    return None


def _check_ratio(element: TransmissionPolicy, context: Context) -> Iterator[str]:
    if element.transmit_ratio is not None and not 0 <= element.transmit_ratio <= 1:
        yield f"the transmit ratio is {element.transmit_ratio}, but must be from 0 to 1"


RULES = (
    ModelRule(
        id="DOC-Transmission-Chunk",
        title="chunk larger than the transmitted data",
        severity=Severity.ERROR,
        target=TransmissionPolicy,
        check=_check_chunk,
        rationale="A chunk is a part of a label or of a channel element. The APP4MC documentation requires it to be no larger "
        "than the whole.",
        remedy="Reduce the chunk size to at most the size of the label, or of the element type of the channel.",
        fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:LabelAccess" access="read" data="L?type=Label">
        <transmissionPolicy>
          <chunkSize value="8" unit="B"/>
        </transmissionPolicy>
      </items>
    </activityGraph>
  </runnables>
  <labels name="L">
    <size value="32" unit="bit"/>
  </labels>
</swModel>
""",
        edits={'value="8"': 'value="4"'},
    ),
    ModelRule(
        id="DOC-Transmission-Ratio",
        title="transmit ratio outside the range 0 to 1",
        severity=Severity.ERROR,
        target=TransmissionPolicy,
        check=_check_ratio,
        rationale="The ratio is a fraction, not a percentage. The APP4MC documentation requires a value from 0 to 1.",
        remedy="Set the transmit ratio to a value from 0 to 1.",
        fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:LabelAccess" access="read" data="L?type=Label">
        <transmissionPolicy transmitRatio="50.0"/>
      </items>
    </activityGraph>
  </runnables>
  <labels name="L"/>
</swModel>
""",
        edits={'transmitRatio="50.0"': 'transmitRatio="0.5"'},
    ),
)
