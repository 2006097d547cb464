"""UDP and TCP over Ethernet: bytes of packets on the wire."""

from __future__ import annotations

from amalthea_uros.units import DataSize

#: Header, type and checksum of an Ethernet frame; preamble and gap to the next one (IEEE 802.3).
_FRAME, _GAP = 18, 20
#: An Ethernet frame has this many bytes of content at least.
_LEAST_CONTENT = 46
#: Bytes of content of the longest Ethernet frame.
MTU = 1500


def packet_bytes(content: int, headers: int, overhead: DataSize | None) -> int:
    """The bytes of a packet.

    Parameters
    ----------
    headers : bytes of the network and transport layers
    overhead : stated, in bits; None: that of Ethernet
    """
    if overhead is not None:
        return content + -(-overhead // 8)
    return max(_LEAST_CONTENT, content + headers) + _FRAME + _GAP
