"""CTF traces made byte by byte with `struct`, after the metadata of Zephyr and LTTng; nothing is shared with the reader."""

import struct
from pathlib import Path

ZEPHYR_IDS = {
    "thread_switched_out": 0x10,
    "thread_switched_in": 0x11,
    "thread_create": 0x13,
    "thread_ready": 0x17,
    "thread_pending": 0x18,
    "isr_enter": 0x1B,
    "isr_exit": 0x1C,
    "idle": 0x1E,
    "named_event": 0x62,
}
_WITHOUT_FIELDS = ("isr_enter", "isr_exit", "idle")


def zephyr_metadata(core_id: bool = False) -> str:
    """The metadata of an older release, reduced to the events used here."""
    core = "uint8_t core_id;" if core_id else ""
    events = []
    for name, number in ZEPHYR_IDS.items():
        fields = "" if name in _WITHOUT_FIELDS else "uint32_t thread_id; ctf_bounded_string_t name[20];"
        if name == "named_event":
            fields = "ctf_bounded_string_t name[20]; uint32_t arg0; uint32_t arg1;"
        fields += core
        body = f"fields := struct {{ {fields} }};" if fields else ""
        events.append(f"event {{ name = {name}; id = {number:#x}; {body} }};")
    return """/* CTF 1.8 */
typealias integer { size = 8; align = 8; signed = true; } := int8_t;
typealias integer { size = 8; align = 8; signed = false; } := uint8_t;
typealias integer { size = 32; align = 8; signed = false; } := uint32_t;
typealias integer { size = 8; align = 8; signed = false; encoding = ASCII; } := ctf_bounded_string_t;
struct event_header { uint32_t timestamp; uint8_t id; };
trace { major = 1; minor = 8; byte_order = le; };
stream { event.header := struct event_header; };
""" + "\n".join(events)


def zephyr_event(time: int, name: str, thread: tuple[int, str] = (0, ""), core: int | None = None) -> bytes:
    """An event at a time in ns, of which 32 bits are recorded."""
    head = struct.pack("<IB", time % 2**32, ZEPHYR_IDS[name])
    number, text = thread
    if name == "named_event":
        head += struct.pack("<20sII", text.encode(), 0, 0)
    elif name not in _WITHOUT_FIELDS:
        head += struct.pack("<I20s", number, text.encode())
    return head if core is None else head + bytes([core])


def write_zephyr(folder: Path, events: list[bytes], core_id: bool = False) -> Path:
    folder.mkdir(parents=True)
    (folder / "metadata").write_text(zephyr_metadata(core_id))
    (folder / "channel0_0").write_bytes(b"".join(events))
    return folder


PACKETS = """/* CTF 1.8 */
typealias integer { size = 8; align = 8; signed = false; } := uint8_t;
typealias integer { size = 16; align = 8; signed = false; } := uint16_t;
typealias integer { size = 32; align = 8; signed = false; } := uint32_t;
typealias integer { size = 64; align = 8; signed = false; } := uint64_t;
typealias integer { size = 64; align = 8; signed = true; } := int64_t;
typealias integer { size = 32; align = 8; signed = true; } := int32_t;
typealias integer { size = 8; align = 8; signed = false; encoding = UTF8; } := letter_t;
trace {
    major = 1; minor = 8; byte_order = ORDER; uuid = "2a6422d0-6cee-11e0-8c08-cb07d7b3a564";
    packet.header := struct { uint32_t magic; uint8_t uuid[16]; uint32_t stream_id; };
};
env { domain = "ust"; tracer_name = "lttng-ust"; hostname = "pc"; };
clock { name = "monotonic"; freq = 1000000000; offset_s = 1700000000; offset = 5; };
typealias integer { size = 27; align = 1; signed = false; map = clock.monotonic.value; } := uint27_clock_t;
typealias integer { size = 64; align = 8; signed = false; map = clock.monotonic.value; } := uint64_clock_t;
typealias integer { size = 5; align = 1; signed = false; } := uint5_t;
stream {
    id = 0;
    packet.context := struct {
        uint64_clock_t timestamp_begin; uint64_clock_t timestamp_end; uint64_t content_size; uint64_t packet_size;
        uint64_t packet_seq_num; uint64_t events_discarded; uint32_t cpu_id;
    };
    event.header := struct {
        enum : uint5_t { compact = 0 ... 30, extended = 31 } id;
        variant <id> {
            struct { uint27_clock_t timestamp; } compact;
            struct { uint32_t id; uint64_clock_t timestamp; } extended;
        } v;
    } align(8);
    event.context := struct { uint32_t _vpid; uint32_t _vtid; integer { size = 8; align = 8; encoding = UTF8; } _procname[17]; };
};
"""
_HEAD_SIZE = 4 + 16 + 4 + 6 * 8 + 4


class PacketWriter:
    """Writes streams of LTTng's form, with compact and extended headers of events."""

    def __init__(self, order: str = "<") -> None:
        self.order = order
        self.metadata = PACKETS.replace("ORDER", "le" if order == "<" else "be")
        self.ids: dict[str, int] = {}
        self.forms: dict[str, str] = {}

    def define(self, name: str, form: str, **fields: str) -> None:
        """A kind of event: `form` of `struct`, with `S` for a text, and the TSDL type of each field."""
        number = self.ids[name] = len(self.ids)
        self.forms[name] = form
        body = " ".join(f"{kind} _{field};" if "[" not in kind else kind for field, kind in fields.items())
        self.metadata += f'event {{ name = "{name}"; id = {number}; stream_id = 0; fields := struct {{ {body} }}; }};\n'

    def event(self, time: int, name: str, thread: tuple[int, int, str], *values: object, is_extended: bool = False) -> bytes:
        number, order = self.ids[name], self.order
        if is_extended:
            # After the 5 bits of the number of the extended form the structure is at the next byte.
            first = 31 if order == "<" else 31 << 3
            head = struct.pack(f"{order}BIQ", first, number, time)
        elif order == "<":
            head = struct.pack("<I", (time % 2**27) << 5 | number)
        else:
            head = struct.pack(">I", number << 27 | time % 2**27)
        head += struct.pack(f"{order}II17s", thread[0], thread[1], thread[2].encode())
        for code, value in zip(self.forms[name], values, strict=True):
            head += _packed(order, code, value)
        return head

    def packet(
        self,
        begin: int,
        events: list[bytes],
        sequence: int = 0,
        discarded: int = 0,
        core: int = 0,
        spare: int = 0,
        length: int = 10**6,
    ) -> bytes:
        content = b"".join(events)
        bits = (_HEAD_SIZE + len(content)) * 8
        head = struct.pack(f"{self.order}I16sI", 0xC1FC1FC1, bytes.fromhex("2a6422d06cee11e08c08cb07d7b3a564"), 0)
        head += struct.pack(f"{self.order}6QI", begin, begin + length, bits, bits + spare * 8, sequence, discarded, core)
        return head + content + bytes(spare)

    def write(self, folder: Path, *streams: list[bytes]) -> Path:
        folder.mkdir(parents=True)
        (folder / "metadata").write_text(self.metadata)
        for number, packets in enumerate(streams):
            (folder / f"channel0_{number}").write_bytes(b"".join(packets))
        return folder


def ros2_writer(order: str = "<") -> PacketWriter:
    """A writer with the events of ros2_tracing that are used, and of the scheduler of Linux."""
    writer, address, text = PacketWriter(order), "uint64_t", "string"
    writer.define("ros2:rcl_node_init", "QQSS", node_handle=address, rmw_handle=address, node_name=text, namespace=text)
    handles = {"node_handle": address, "topic_name": text, "queue_depth": address}
    writer.define("ros2:rcl_publisher_init", "QQQSQ", publisher_handle=address, rmw_publisher_handle=address, **handles)
    writer.define(
        "ros2:rcl_subscription_init", "QQQSQ", subscription_handle=address, rmw_subscription_handle=address, **handles
    )
    writer.define("ros2:rclcpp_subscription_init", "QQ", subscription_handle=address, subscription=address)
    writer.define("ros2:rclcpp_subscription_callback_added", "QQ", subscription=address, callback=address)
    writer.define("ros2:rcl_timer_init", "Qq", timer_handle=address, period="int64_t")
    writer.define("ros2:rclcpp_timer_callback_added", "QQ", timer_handle=address, callback=address)
    writer.define("ros2:rclcpp_timer_link_node", "QQ", timer_handle=address, node_handle=address)
    writer.define("ros2:rclcpp_callback_register", "QS", callback=address, symbol=text)
    writer.define("ros2:callback_start", "QB", callback=address, is_intra_process="uint8_t")
    writer.define("ros2:callback_end", "Q", callback=address)
    writer.define("ros2:rmw_publish", "QQQ", rmw_publisher_handle=address, message=address, timestamp=address)
    writer.define(
        "ros2:rmw_take", "QQqB", rmw_subscription_handle=address, message=address, source_timestamp="int64_t", taken="uint8_t"
    )
    writer.define("ros2:rcl_init", "QS", context_handle=address, version=text)
    writer.define(
        "ros2:rcl_service_init", "QQQS", service_handle=address, node_handle=address, rmw_handle=address, service_name=text
    )
    writer.define("ros2:rclcpp_service_callback_added", "QQ", service_handle=address, callback=address)
    writer.define("ros2:rcl_publish", "QQ", publisher_handle=address, message=address)
    thread = "letter_t _{0}comm[16]; int32_t _{0}tid; int32_t _{0}prio;"
    writer.define("sched_switch", "CiiqCii", all=f"{thread.format('prev_')} int64_t _prev_state; {thread.format('next_')}")
    return writer


def _packed(order: str, code: str, value: object) -> bytes:
    if code in "SC":
        text = str(value).encode()
        return text + b"\0" if code == "S" else text.ljust(16, b"\0")
    return struct.pack(order + code, value)
