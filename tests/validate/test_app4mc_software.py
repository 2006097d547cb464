"""The rules of the profile app4mc about software: each branch of their conditions, bounds, and what is not stated."""

from excerpts import assert_said, call, cases, messages, process, runnable

PARAMETERS = (
    "".join(f'<parameters name="{kind}" direction="{kind}"/>' for kind in ("in", "out", "inout")) + '<parameters name="free"/>'
)
OTHER = runnable("S", parameters=PARAMETERS)


def argument(of, name, depends=""):
    return f'<arguments name="a" parameter="{of}/{name}?type=RunnableParameter">{depends}</arguments>'


def calls(argument, called="S"):
    return f"<swModel>{runnable('R', call(called, argument), parameters=PARAMETERS)}{OTHER}</swModel>"


ARGUMENTS = [
    ("AM-SW-CallArgument", calls(argument("S", "in")), []),
    ("AM-SW-CallArgument", calls(argument("R", "in")), ["'R.in' is not a parameter of the called runnable 'S'"]),
    ("AM-SW-CallArgument", calls("<arguments/>"), ["has no parameter"]),
    ("AM-SW-CallArgument", calls(argument("S", "in")).replace(' runnable="S?type=Runnable"', ""), ["call without a runnable"]),
    (
        "AM-SW-CallArgument",
        calls("<arguments/>").replace(' runnable="S?type=Runnable"', ""),
        ["no parameter", "without a runnable"],
    ),
    ("AM-SW-CallArgument", calls(argument("S", "gone")), []),
    ("AM-SW-CallArgument", calls(argument("S", "in"), called="gone"), []),
]


def depending(owner, on):
    """A runnable R in which something depends on data; it calls S with an argument for each of its parameters."""
    depends = f"<dependsOn {on}/>"
    access, parameters, given = "", PARAMETERS, {name: argument("S", name) for name in ("in", "out", "inout", "free")}
    place, _, which = owner.partition(" ")
    if place == "access":
        access = f'<items t="LabelAccess" data="L?type=Label" access="{which}">{depends}</items>'.replace(' access=""', "")
    elif place == "parameter":
        parameters = parameters.replace(f'name="{which}"/>', f'name="{which}">{depends}</parameters>').replace(
            f'direction="{which}"/>', f'direction="{which}">{depends}</parameters>'
        )
    else:
        given[which] = argument("S", which, depends)
    called = call("S", "".join(given.values()))
    return (
        f'<swModel>{runnable("R", access, called, parameters=parameters)}{OTHER}<labels name="L"/>'
        f"{runnable('Q', call('S', argument('S', 'out')))}</swModel>"
    )


def of_parameter(*names):
    return f'parameters="{" ".join(f"{name}?type=RunnableParameter" for name in names)}"'


def of_result(*names):
    return f'callArguments="{" ".join(f"{name}?type=CallArgument" for name in names)}"'


ON_LABEL = 'labels="L?type=Label"'
DEPENDENCIES = [
    ("AM-SW-DataDependency", depending(owner, on), said)
    for owner, on, said in (
        ("access write", ON_LABEL, []),
        ("access read", ON_LABEL, ["a label access that does not write"]),
        ("access ", ON_LABEL, ["a label access that does not write"]),
        ("parameter out", ON_LABEL, []),
        ("parameter inout", ON_LABEL, []),
        ("parameter in", ON_LABEL, ["parameter 'in' is not an output"]),
        ("parameter free", ON_LABEL, ["parameter 'free' is not an output"]),
        ("argument in", ON_LABEL, []),
        ("argument inout", ON_LABEL, []),
        ("argument out", ON_LABEL, ["the argument for 'S.out'"]),
        ("argument free", ON_LABEL, ["the argument for 'S.free'"]),
        ("access write", of_parameter("R/in", "R/inout"), []),
        ("access write", of_parameter("R/out", "R/free", "S/in"), ["'R.out'", "'R.free'", "'S.in'"]),
        ("access write", of_parameter("R/gone"), []),
        ("access write", of_result("R/calls/S/param/out/a", "R/calls/S/param/inout/a"), []),
        ("access write", of_result("R/calls/S/param/in/a", "R/calls/S/param/free/a"), ["param.in.a'", "param.free.a'"]),
        ("access write", of_result("Q/calls/S/param/out/a"), ["'Q.calls.S.param.out.a' is not the result of a call in 'R'"]),
        ("access write", of_result("R/calls/S/param/gone/a"), []),
        ("access read", of_parameter("R/out"), ["does not write", "'R.out'"]),
    )
]
DEPENDENCIES += [
    # Outside of runnables nothing is demanded.
    (
        "AM-SW-DataDependency",
        '<swModel><tasks name="T"><activityGraph><items t="LabelAccess" access="read" data="L?type=Label">'
        '<dependsOn labels="L?type=Label"/></items></activityGraph></tasks><labels name="L"/></swModel>',
        [],
    ),
    # What is bound to nothing is no result; of what is not there nothing is known.
    (
        "AM-SW-DataDependency",
        depending("access write", of_result("R/calls/S/param/no-name/b")).replace(
            "<arguments ", '<arguments name="b"/><arguments ', 1
        ),
        ["param.no-name.b' is not the result"],
    ),
    (
        "AM-SW-DataDependency",
        depending("access write", of_result("R/calls/S/param/gone/b")).replace(
            "<arguments ", '<arguments name="b" parameter="S/gone?type=RunnableParameter"/><arguments ', 1
        ),
        [],
    ),
    # An argument without a parameter is not reported twice.
    (
        "AM-SW-DataDependency",
        f"<swModel>{runnable('R', call('S', '<arguments><dependsOn/></arguments>'))}{OTHER}</swModel>",
        [],
    ),
]

SERVICE = "<swModel>{}</swModel>".format
SERVES = runnable("S", features='service="true"')
SERVICES = [
    ("DOC-Service-Caller", SERVICE(SERVES), []),
    ("DOC-Service-Caller", SERVICE(runnable("S") + process("tasks", "T", call("S"))), []),
    ("DOC-Service-Caller", SERVICE(SERVES + process("isrs", "I", call("S"))), ["'S' is called directly by 'I'"]),
    ("DOC-Service-Caller", SERVICE(SERVES + process("tasks", "T", call("S"), call("S"))), ["'S' is called directly by 'T'"]),
    (
        "DOC-Service-Caller",
        SERVICE(SERVES + process("tasks", "T", call("S")) + process("tasks", "U", f'<items t="Group">{call("S")}</items>')),
        ["'T'", "'U'"],
    ),
    ("DOC-Service-Caller", SERVICE(SERVES + runnable("R", call("S")) + process("tasks", "T", call("R"))), []),
]

LABEL = '<labels name="L"><size value="{}" unit="{}"/></labels>'
ACCESS = '<items t="{}" data="{}"><transmissionPolicy {}>{}</transmissionPolicy></items>'


def transmits(policy, content="", what="LabelAccess", data="L?type=Label", rest='<labels name="L"/>'):
    return f"<swModel>{runnable('R', ACCESS.format(what, data, policy, content))}{rest}</swModel>"


def chunk(value, unit):
    return f'<chunkSize value="{value}" unit="{unit}"/>'


def queue(element):
    return f"<channels name='C' elementType='{element}'/>"


WORD = '<typeDefinitions t="BaseTypeDefinition" name="W"><size value="4" unit="B"/></typeDefinitions>'
IN_CHANNEL = {"what": "ChannelSend", "data": "C?type=Channel"}
TRANSMISSIONS = [
    ("DOC-Transmission-Ratio", transmits(f'transmitRatio="{ratio}"' if ratio else ""), said)
    for ratio, said in ((None, []), ("0.0", []), ("1.0", []), ("1.01", ["1.01"]), ("-0.01", ["-0.01"]))
] + [
    ("DOC-Transmission-Chunk", content, said)
    for content, said in (
        (transmits("", chunk(32, "bit"), rest=LABEL.format(4, "B")), []),
        (transmits("", chunk(33, "bit"), rest=LABEL.format(4, "B")), ["33 bit is larger than the transmitted 4 B"]),
        (transmits("", chunk(1, "KiB"), rest=LABEL.format(1, "kB")), ["1 KiB is larger than the transmitted 1 kB"]),
        (transmits("", chunk(1, "kB"), rest=LABEL.format(1, "KiB")), []),
        (transmits("", chunk(1, "Mibit"), rest=LABEL.format(131, "kB")), ["1 Mibit"]),
        (transmits("", chunk(1, "Mibit"), rest=LABEL.format(132, "kB")), []),
        (transmits("", chunk(1, "TiB"), rest=LABEL.format(1, "TB")), ["1 TiB"]),
        (transmits("", chunk(9, "B")), []),
        (transmits("", chunk(9, "B"), rest='<labels name="L"><size value="1"/></labels>'), []),
        (transmits("", '<chunkSize value="9"/>', rest=LABEL.format(1, "bit")), []),
        (transmits("", '<chunkSize unit="B"/>', rest=LABEL.format(1, "bit")), []),
        (transmits("", "", rest=LABEL.format(1, "bit")), []),
        (transmits("", chunk(9, "B"), data="gone?type=Label"), []),
        (transmits("", chunk(4, "B"), **IN_CHANNEL, rest=queue("W?type=BaseTypeDefinition") + WORD), []),
        (
            transmits("", chunk(5, "B"), **IN_CHANNEL, rest=queue("W?type=BaseTypeDefinition") + WORD),
            ["5 B is larger than the transmitted 4 B"],
        ),
        (transmits("", chunk(5, "B"), **IN_CHANNEL, rest='<channels name="C"/>'), []),
        (transmits("", chunk(5, "B"), **IN_CHANNEL, rest='<channels name="C"><size value="1" unit="B"/></channels>'), []),
    )
]

RECEIVE = '<swModel>{}<channels name="C"/></swModel>'
CHANNELS = [
    (
        "DOC-Channel-LowerBound",
        RECEIVE.format(runnable("R", f'<items t="ChannelReceive" data="C?type=Channel" {bounds}/>')),
        said,
    )
    for bounds, said in (
        ("", []),
        ('elements="2"', []),
        ('elements="2" lowerBound="0"', []),
        ('elements="2" lowerBound="-1"', ["-1 is negative"]),
        ('elements="2" lowerBound="3"', ["3 is above the number of elements 2"]),
        ('lowerBound="3"', []),
        ('lowerBound="-1"', ["-1 is negative"]),
    )
] + [
    ("DOC-Channel-Fill", f'<swModel><channels name="C" {bounds}/>{sender}</swModel>', said)
    for bounds, sender, said in (
        ("", "", []),
        ('defaultElements="3"', "", []),
        ('defaultElements="3" maxElements="3"', "", []),
        ('defaultElements="4" maxElements="3"', "", ["'C' starts with 4 elements, but can hold at most 3"]),
        *(
            (
                bounds,
                runnable(
                    "R",
                    *(
                        f'<items t="ChannelSend" data="C?type=Channel" elements="{n}"/>'.replace(' elements=""', "")
                        for n in sent
                    ),
                ),
                said,
            )
            for bounds, sent, said in (
                ('maxElements="3"', (3, 1), []),
                ('maxElements="3"', (1, 4, 2), ["'C' receives 4 elements at once"]),
                ('maxElements="3"', (1, ""), []),
                ("", (4,), []),
            )
        ),
    )
]

MODES = """<swModel><modes t="EnumMode" name="M"><literals name="on"/></modes><modes t="NumericMode" name="N"/>
<modeLabels name="L" {}/></swModel>"""
INITIAL = [
    ("DOC-Enum-Initial", MODES.format(features), said)
    for features, said in (
        ('mode="M?type=EnumMode"', []),
        ('mode="M?type=EnumMode" initialValue="on"', []),
        ('mode="M?type=EnumMode" initialValue=" on "', []),
        ('mode="M?type=EnumMode" initialValue="On"', ["'On' of 'L' is not a literal of 'M'"]),
        ('mode="M?type=EnumMode" initialValue="0"', ["'0' of 'L' is not a literal"]),
        ('mode="N?type=NumericMode" initialValue="0"', []),
        ('mode="N?type=NumericMode" initialValue=" -12 "', []),
        ('mode="N?type=NumericMode" initialValue="+1"', ["not an integer"]),
        ('mode="N?type=NumericMode" initialValue="1.0"', ["not an integer"]),
        ('mode="N?type=NumericMode" initialValue="on"', ["not an integer"]),
        ('initialValue="on"', []),
        ('mode="gone?type=EnumMode" initialValue="off"', []),
    )
]


@cases(ARGUMENTS, DEPENDENCIES, SERVICES, TRANSMISSIONS, CHANNELS, INITIAL)
def test_a_case(rule, excerpt, said, tmp_path):
    assert_said(messages(tmp_path, rule, excerpt), said)


def test_the_type_of_a_channel_is_contained_in_old_models(tmp_path):
    element = '<channels name="C"><elementType t="{}"/></channels>'
    typed = element.format('TypeRef" typeDef="W?type=BaseTypeDefinition')
    for rest, said in ((typed, ["5 B is larger than the transmitted 4 B"]), (element.format("Array"), [])):
        excerpt = transmits("", chunk(5, "B"), **IN_CHANNEL, rest=rest + WORD)
        assert_said(messages(tmp_path, "DOC-Transmission-Chunk", excerpt, version="2.2.0"), said)
