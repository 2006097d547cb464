"""The rules of the profile app4mc about hardware: each branch of their conditions, bounds, and what is not stated."""

from excerpts import ECU, assert_said, cases, connection, messages, module, port

CONNECTIONS = [
    ("AM-HW-Connection", ECU.format("", connection("w", None, None)), ["has no port1", "has no port2"]),
    ("AM-HW-Connection", ECU.format("", port("a") + connection("w", "ECU/a", None)), ["has no port2"]),
    ("AM-HW-Connection", ECU.format("", port("a") + connection("w", None, "ECU/a")), ["has no port1"]),
    ("AM-HW-Connection", ECU.format("", port("a") + connection("w", "ECU/a", "ECU/a")), ["to itself"]),
    (
        "AM-HW-Connection",
        ECU.format("", port("a", interface="AXI") + port("b", interface="AHB") + connection("w", "ECU/a", "ECU/b")),
        ["AHB and AXI"],
    ),
    (
        "AM-HW-Connection",
        ECU.format("", port("a", interface="AXI") + port("b", interface="_undefined_") + connection("w", "ECU/a", "ECU/b")),
        [],
    ),
    (
        "AM-HW-Connection",
        ECU.format(
            "",
            module(
                "ConnectionHandler",
                "bus",
                port("a", interface="AXI"),
                port("b", interface="AHB"),
                connection("w", "bus/a", "bus/b", "internalConnections"),
            ),
        ),
        [],
    ),
]

CORE = module("ProcessingUnit", "core", port("p"), "{}")
PATH = '<accessElements name="a"{}><accessPath name="w"{}/></accessElements>'
TO_RAM = ' destination="RAM?type=Memory"'
MEMORY = '<definitions t="MemoryDefinition" name="D">{}</definitions>'
KIB = '<size value="1" unit="KiB"/>'
RAM = module("Memory", "RAM", port("p"), features='definition="D?type=MemoryDefinition"')


def path(destination, features, rest="", ram=RAM, size=KIB):
    return ECU.format(MEMORY.format(size), CORE.format(PATH.format(destination, features)) + ram + rest)


def over(*elements):
    return f' pathElements="{" ".join(elements)}"'


WIRE, BUS = "ECU/w?type=HwConnection", "bus?type=ConnectionHandler"
JOINED = connection("w", "core/p", "RAM/p")
BUSES = (
    module("ConnectionHandler", "bus", port("i"), port("o"))
    + connection("w", "core/p", "bus/i")
    + connection("v", "bus/o", "RAM/p")
    + connection("u", None, None)
)
PATHS = [
    ("AM-HW-AccessPath", path(TO_RAM, ""), []),
    ("AM-HW-AccessPath", path("", ""), []),
    ("AM-HW-AccessPath", path("", ' startAddress="0x10" endAddress="0xf"'), ["0xf is below the start address 0x10"]),
    ("AM-HW-AccessPath", path("", ' startAddress="0x10" endAddress="0x10"'), []),
    ("AM-HW-AccessPath", path(TO_RAM, "", ram=module("Memory", "RAM")), ["destination memory 'RAM' has no definition"]),
    ("AM-HW-AccessPath", path(TO_RAM, ' startAddress="0x100" endAddress="0x500"'), []),
    ("AM-HW-AccessPath", path(TO_RAM, ' startAddress="0x100" endAddress="0x501"'), ["0x401 bytes at offset 0x0"]),
    ("AM-HW-AccessPath", path(TO_RAM, ' endAddress="0x400" memOffset="0x1"'), ["0x400 bytes at offset 0x1"]),
    ("AM-HW-AccessPath", path(TO_RAM, ' endAddress="0x400"', size='<size value="8191" unit="bit"/>'), ["0x3ff bytes"]),
    ("AM-HW-AccessPath", path(TO_RAM, ' endAddress="0x401"', size=""), []),
    ("AM-HW-AccessPath", path(TO_RAM, ' endAddress="0x401"', size='<size value="1"/>'), []),
    ("AM-HW-AccessPath", path(TO_RAM, ' startAddress="0x501" endAddress="0x100"'), ["below"]),
    ("AM-HW-AccessPath", path(TO_RAM, ' startAddress="0x10" endAddress="0xf" memOffset="0x800"'), ["below"]),
    ("AM-HW-AccessPath", path(TO_RAM, ' memOffset="0x400"'), []),
    ("AM-HW-AccessPath", path(TO_RAM, ' memOffset="0x401"'), ["0x0 bytes at offset 0x401"]),
    ("AM-HW-AccessPath", path(' destination="gone?type=Memory"', ' endAddress="0x401"'), []),
    ("AM-HW-AccessPath", path(' destination="gone?type=Memory"', over(WIRE), JOINED), []),
    ("AM-HW-AccessPath", path(TO_RAM, over(WIRE), JOINED), []),
    ("AM-HW-AccessPath", path("", over(WIRE), JOINED), ["no destination"]),
    ("AM-HW-AccessPath", path(TO_RAM, over(WIRE), connection("w", None, "RAM/p")), ["start of the path has no port of 'core'"]),
    ("AM-HW-AccessPath", path(TO_RAM, over(WIRE), connection("w", "core/p", None)), ["end of the path has no port of 'RAM'"]),
    ("AM-HW-AccessPath", path(TO_RAM, over(WIRE, BUS, "ECU/v?type=HwConnection"), BUSES), []),
    ("AM-HW-AccessPath", path(TO_RAM, over(WIRE, BUS, BUS, "ECU/v?type=HwConnection"), BUSES), []),
    ("AM-HW-AccessPath", path(TO_RAM, over(BUS), BUSES), ["'bus' at the start", "'bus' at the end"]),
    (
        "AM-HW-AccessPath",
        path(TO_RAM, over(WIRE, BUS, "other?type=ConnectionHandler"), BUSES + module("ConnectionHandler", "other", port("q"))),
        ["'other' at the end", "'bus' and 'other' are adjacent"],
    ),
    ("AM-HW-AccessPath", path(TO_RAM, over(WIRE, "ECU/v?type=HwConnection"), BUSES), ["'ECU.w' and 'ECU.v' are adjacent"]),
    (
        "AM-HW-AccessPath",
        path(TO_RAM, over(WIRE, "ECU/u?type=HwConnection", BUS, "ECU/v?type=HwConnection"), BUSES),
        ["'ECU.w' and 'ECU.u'", "'ECU.u' and 'bus'"],
    ),
    ("AM-HW-AccessPath", path(TO_RAM, over("gone?type=HwConnection", BUS, "ECU/v?type=HwConnection"), BUSES), []),
]

TWO_WIRES = connection("x", "{0}", "RAM/a") + connection("y", "{0}", "RAM/b")
THREE_PORTS = module("Memory", "RAM", port("a"), port("b"), port("c"))
INTERNAL = module(
    "ConnectionHandler",
    "bus",
    *map(port, "pqr"),
    connection("i", "bus/p", "bus/q", "internalConnections"),
    connection("j", "bus/p", "bus/r", "internalConnections"),
)
DELEGATED = ECU.format("", port("p") + THREE_PORTS + TWO_WIRES.format("ECU/p"))
PORTS = [
    (rule, content, ["has 2 connections, but at most 1 is allowed"] * reported)
    for content, rules in (
        (
            ECU.format("", CORE.format("") + THREE_PORTS + TWO_WIRES.format("core/p")),
            ("AM-HW-Port", "DOC-HwPort-Single-Connection"),
        ),
        (DELEGATED, ()),
        (ECU.format("", INTERNAL + THREE_PORTS + connection("x", "bus/p", "RAM/a")), ()),
        (ECU.format("", INTERNAL + THREE_PORTS + TWO_WIRES.format("bus/p")), ("AM-HW-Port", "DOC-HwPort-Single-Connection")),
        (ECU.format("", CORE.format("") + connection("x", "core/p", "core/p")), ()),
    )
    for rule in ("AM-HW-Port", "DOC-HwPort-Single-Connection")
    for reported in [rule in rules]
]


def structure(first, second, inner="i", outer="o"):
    """A connection between ports of these types, of a module in a structure or of the structure itself."""
    ports = {"i": "m{}/p", "o": "ECU/p{}", "s": "Sub{}/p", "c": "cache{}/p", "k": "l2{}/p", "x": "far{}/p"}
    parts = ""
    for number, (place, kind) in enumerate(((inner, first), (outer, second)), start=1):
        its = port("p", kind)
        parts += {
            "i": module("Memory", f"m{number}", its),
            "o": port(f"p{number}", kind),
            "s": f'<structures name="Sub{number}">{its}</structures>',
            "c": module("ProcessingUnit", f"core{number}", f'<caches name="cache{number}">{its}</caches>'),
            "k": module("Cache", f"l2{number}", its),
            "x": f'<structures name="Deep{number}">{module("Memory", f"far{number}", its)}</structures>',
        }[place]
    return ECU.format("", parts + connection("w", ports[inner].format(1), ports[outer].format(2)))


INITIATOR, RESPONDER = "initiator", "responder"
STRUCTURES = [
    ("AM-HW-Structure", structure(first, second, inner, outer), said)
    for inner, outer, first, second, said in (
        ("i", "i", INITIATOR, RESPONDER, []),
        ("i", "i", INITIATOR, INITIATOR, ["two ports of type initiator"]),
        ("i", "i", RESPONDER, RESPONDER, ["two ports of type responder"]),
        ("i", "i", INITIATOR, "", []),
        ("i", "i", "", "", []),
        ("i", "i", "_undefined_", "_undefined_", []),
        ("i", "s", INITIATOR, INITIATOR, ["two ports"]),
        ("c", "i", INITIATOR, INITIATOR, ["two ports"]),
        ("c", "i", INITIATOR, RESPONDER, []),
        ("k", "i", INITIATOR, INITIATOR, ["two ports"]),
        ("o", "o", RESPONDER, RESPONDER, ["two ports"]),
        ("o", "o", INITIATOR, RESPONDER, []),
        ("i", "o", INITIATOR, INITIATOR, []),
        ("i", "o", INITIATOR, RESPONDER, ["delegates"]),
        ("o", "s", INITIATOR, RESPONDER, ["delegates"]),
        ("o", "c", RESPONDER, RESPONDER, []),
        ("i", "o", "", RESPONDER, []),
        ("i", "x", INITIATOR, INITIATOR, []),
        ("o", "x", INITIATOR, RESPONDER, []),
    )
]
STRUCTURES += [
    # A connection that is not complete leaves the others to be looked at.
    (
        "AM-HW-Structure",
        ECU.format(
            "",
            port("a", INITIATOR)
            + port("b", INITIATOR)
            + connection("v", "ECU/a", None)
            + connection("t", None, "ECU/a")
            + connection("u", "ECU/a", "ECU/a")
            + connection("w", "ECU/a", "ECU/b"),
        ),
        ["'w' connects two ports"],
    ),
    ("AM-HW-Structure", ECU.format("", port("a", INITIATOR) + connection("w", "ECU/a", "ECU/gone")), []),
]

HANDLER = '<hwModel><definitions t="ConnectionHandlerDefinition" name="D"{}/><structures name="ECU">{}</structures></hwModel>'


def handler(name, *kinds):
    ports = (port(f"p{number}", kind) for number, kind in enumerate(kinds))
    return module("ConnectionHandler", name, *ports, features='definition="D?type=ConnectionHandlerDefinition"')


TRANSFERS = [
    ("DOC-ConnectionHandler-Transfers", HANDLER.format(f' maxConcurrentTransfers="{most}"' if most else "", handlers), said)
    for most, handlers, said in (
        (2, handler("bus", *2 * [INITIATOR, RESPONDER]), []),
        (3, handler("bus", *2 * [INITIATOR, RESPONDER]), ["'bus' has 2 initiator ports, too few for 3 concurrent transfers"]),
        (2, handler("bus", RESPONDER, RESPONDER, INITIATOR), ["'bus' has 1 initiator port,"]),
        (2, handler("bus", RESPONDER, INITIATOR, INITIATOR), ["'bus' has 1 responder port,"]),
        (1, handler("bus", RESPONDER), ["0 initiator ports, too few for 1 concurrent transfer"]),
        (
            2,
            handler("a", RESPONDER, INITIATOR) + handler("b", *2 * [INITIATOR, RESPONDER]) + handler("c", INITIATOR),
            ["'a'", "'c'"],
        ),
        (2, handler("bus", RESPONDER, INITIATOR, ""), []),
        (2, handler("bus", RESPONDER, "_undefined_"), []),
        (2, handler("bus"), []),
        (2, "", []),
        (None, handler("bus", RESPONDER), []),
    )
]

FEATURES = """<hwModel><definitions t="ProcessingUnitDefinition" name="D" features="{}"/>
<featureCategories name="I"><features name="a"/><features name="b"/></featureCategories>
<featureCategories name="J"><features name="a"/></featureCategories></hwModel>"""
CATEGORIES = [
    (rule, FEATURES.format(" ".join(f"{name}?type=HwFeature" for name in names)), said[rule])
    for names, said in (
        (("I/a", "J/a"), {"AM-HW-Definition": [], "DOC-Feature-Single": []}),
        (
            ("I/a", "I/b", "J/a"),
            {"AM-HW-Definition": ["'a'", "'b'"], "DOC-Feature-Single": ["'D' has 2 features of category 'I'"]},
        ),
        (("I/gone", "J/gone"), {"AM-HW-Definition": [], "DOC-Feature-Single": []}),
        ((), {"AM-HW-Definition": [], "DOC-Feature-Single": []}),
    )
    for rule in ("AM-HW-Definition", "DOC-Feature-Single")
]


@cases(CONNECTIONS, PATHS, PORTS, STRUCTURES, TRANSFERS, CATEGORIES)
def test_a_case(rule, excerpt, said, tmp_path):
    assert_said(messages(tmp_path, rule, excerpt), said)
