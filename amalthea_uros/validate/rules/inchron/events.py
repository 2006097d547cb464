"""Events and event chains: what am2inc converts of them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel import classes as am
from amalthea_uros.validate.chains import ends, events, parts
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import Downgraded, changes, model_rule

#: The classes of events that am2inc converts.
CONVERTED = (am.ProcessEvent, am.RunnableEvent, am.LabelEvent)


_OF_PROCESSES = frozenset({"activate", "start", "terminate"})


def moments(event: am.Event) -> frozenset[str]:
    """The types that am2inc converts for an event."""
    match event:
        case am.RunnableEvent():
            return frozenset({"start", "terminate"})
        case am.LabelEvent():
            return frozenset({"read", "write"})
        case am.ProcessEvent(entity=am.Task()):
            return _OF_PROCESSES | {"resume", "wait", "release"}
        case am.ProcessEvent():
            return _OF_PROCESSES
    return frozenset()


def is_converted(event: am.Event) -> bool:
    """Whether am2inc converts an event, or all events of a set, as part of a chain."""
    if event.unresolved is not None:
        return False
    if isinstance(event, am.EventSet):
        return all(map(is_converted, event.events))
    if not isinstance(event, CONVERTED) or event.entity is None or event.entity.unresolved is not None:
        return False
    return event.event_type in moments(event)


def is_parallel(chain: am.AbstractEventChain) -> bool:
    """Whether am2inc reads the items as parallel branches; a single item is read as a sequence."""
    return chain.item_type == "parallel" and len(chain.items) > 1


def events_read(chain: am.AbstractEventChain) -> Iterable[am.Event]:
    """The events that am2inc reads of a chain, each once: its ends unless it is a segment, and the stimuli of its later segments."""
    inner = [] if is_parallel(chain) else [part.stimulus for part in parts(chain)[1:]]
    read = [*ends(chain), *inner] if isinstance(chain, am.EventChain) else inner
    return dict.fromkeys(event for end in read for event in events(end) if event.unresolved is None)


def dropped(context: Context) -> set[am.AbstractEventChain]:
    """The chains that are not converted."""
    holders: dict[am.AbstractEventChain, list[am.AbstractEventChain]] = {}
    for chain in context.all(am.AbstractEventChain):
        for part in parts(chain):
            holders.setdefault(part, []).append(chain)
    found: set[am.AbstractEventChain] = set()
    pending = [chain for chain in context.all(am.AbstractEventChain) if _is_refused(chain)]
    while pending:
        chain = pending.pop()
        if chain not in found:
            found.add(chain)
            pending += holders.get(chain, [])
    return found | {chain for chain in context.all(am.EventChain) if not all(map(_is_end, ends(chain)))}


def _is_refused(chain: am.AbstractEventChain) -> bool:
    """Whether something inside a chain prevents its conversion, and that of every chain of which it is a part."""
    if not chain.items:
        return None in ends(chain)
    if any(part.unresolved is not None for part in parts(chain)):
        return True
    if is_parallel(chain):
        return any(ends(branch) != ends(chain) for branch in parts(chain))
    return not all(part.stimulus is not None and is_converted(part.stimulus) for part in parts(chain)[1:])


def _is_end(event: am.Event | None) -> bool:
    return event is not None and is_converted(event) and not (isinstance(event, am.EventSet) and len(event.events) > 1)


@model_rule("INC-EC-CYCLE", am.EventChain)
def _check_cycle(element: am.EventChain, context: Context) -> Iterator[str]:
    if element in context.once(_endless):
        yield f"the event chain {element.name or ''!r} is part of a reference cycle or leads into one"


def _endless(context: Context) -> set[am.EventChain]:
    """The chains that remain after repeatedly removing those without references to a remaining chain."""
    holders: dict[am.EventChain, list[am.EventChain]] = {}
    left: dict[am.EventChain, int] = dict.fromkeys(context.all(am.EventChain), 0)
    for reference in context.all(am.EventChainReference):
        holder = reference.enclosing(am.EventChain)
        if holder is not None and reference.event_chain in left:
            holders.setdefault(reference.event_chain, []).append(holder)
            left[holder] += 1
    pending = [chain for chain, count in left.items() if not count]
    while pending:
        chain = pending.pop()
        del left[chain]
        for holder in holders.get(chain, []):
            left[holder] -= 1
            if not left[holder]:
                pending.append(holder)
    return set(left)


@model_rule("INC-EC-SEQ", am.AbstractEventChain)
def _check_seq(element: am.AbstractEventChain, context: Context) -> Iterator[str]:
    if is_parallel(element) or not element.items:
        return
    name, segments = element.name or "", parts(element)
    if len(segments) < len(element.items):
        yield f"the event chain {name!r} has an item without a chain, which am2inc skips"
    if any(segment.unresolved is not None for segment in segments):
        return
    expected = [element.stimulus, *(segment.response for segment in segments)]
    if segments and ([segment.stimulus for segment in segments] != expected[:-1] or expected[-1] is not element.response):
        yield f"the segments of the event chain {name!r} do not connect its stimulus to its response"


@model_rule("INC-EC-SET", am.AbstractEventChain)
def _check_set(element: am.AbstractEventChain, context: Context) -> Iterator[str | Downgraded]:
    name = element.name or ""
    if isinstance(element, am.EventChain):
        for end, event in (("stimulus", element.stimulus), ("response", element.response)):
            count = _size(event)
            if count == 0:
                yield changes(f"the {end} of the event chain {name!r} is an empty event set", Severity.ERROR)
            elif count > 1:
                yield Downgraded(f"the {end} of the event chain {name!r} is a set of {count} events")
    for segment in [] if is_parallel(element) else parts(element)[1:]:
        count = _size(segment.stimulus)
        # The events of a segment without items of its own are joined by a barrier.
        if segment.stimulus is not None and is_converted(segment.stimulus) and (count == 0 or (count > 1 and segment.items)):
            size = f"a set of {count} events" if count else "an empty event set"
            yield f"the stimulus of the segment {segment.name or ''!r} of the event chain {name!r} is {size}"


def _size(end: am.Event | None) -> int:
    """The number of events of a set; an event is a set of one."""
    return len(end.events) if isinstance(end, am.EventSet) and end.unresolved is None else 1


@model_rule("INC-EC-PAR", am.AbstractEventChain)
def _check_ends(element: am.AbstractEventChain, context: Context) -> Iterator[str]:
    if not is_parallel(element):
        return
    branches = parts(element)
    for branch in branches:
        if ends(branch) != ends(element):
            yield f"the branch {branch.name or ''!r} and its event chain {element.name or ''!r} differ in stimulus or response"
    if len(branches) < len(element.items):
        yield f"the event chain {element.name or ''!r} has an item without a chain, which am2inc skips"


@model_rule("INC-EC-PAR-ITEMS", am.AbstractEventChain)
def _check_items(element: am.AbstractEventChain, context: Context) -> Iterator[str | Downgraded]:
    branches = parts(element) if is_parallel(element) else []
    # Otherwise the event chain is dropped.
    is_converted = all(ends(branch) == ends(element) for branch in branches)
    for branch in branches:
        if not branch.items:
            message = f"the branch {branch.name or ''!r} of the event chain {element.name or ''!r} has no items"
            yield changes(message, Severity.ERROR) if is_converted else Downgraded(message)


@model_rule("INC-LC-SCOPE", am.EventChainLatencyConstraint)
def _check_scope(element: am.EventChainLatencyConstraint, context: Context) -> Iterator[str]:
    name = element.name or ""
    if element.scope is None:
        yield f"the latency constraint {name!r} has no scope"
    elif element.scope.unresolved is not None:
        yield f"the event chain of the latency constraint {name!r} cannot be resolved"
    elif element.scope in context.once(dropped):
        yield f"the latency constraint {name!r} is dropped by am2inc together with its event chain {element.scope.name or ''!r}"


@model_rule("INC-EV-KIND", am.Event, am.AbstractEventChain)
def _check_kind(element: am.Event | am.AbstractEventChain, context: Context) -> Iterator[str]:
    if isinstance(element, am.Event) and not isinstance(element, CONVERTED):
        how = "converted only as part of an event chain" if isinstance(element, am.EventSet) else "not converted by am2inc"
        yield f"the {type(element).__name__} {element.name or ''!r} is {how}"
    for event in events_read(element) if isinstance(element, am.AbstractEventChain) else ():
        if not isinstance(event, CONVERTED):
            cause = f"the {type(event).__name__} {event.name or ''!r}"
            yield f"the event chain {element.name or ''!r} is dropped by am2inc because of {cause}"


@model_rule("INC-EV-TYPE", *CONVERTED, am.AbstractEventChain)
def _check_type(element: am.Event | am.AbstractEventChain, context: Context) -> Iterator[str]:
    if isinstance(element, CONVERTED):
        if element.entity is None:
            yield f"the event {element.name or ''!r} has no entity"
        elif element.event_type not in moments(element):
            yield f"the type of the event {element.name or ''!r} is not one of {', '.join(sorted(moments(element)))}"
    for event in events_read(element) if isinstance(element, am.AbstractEventChain) else ():
        if isinstance(event, CONVERTED) and not is_converted(event):
            yield f"the event chain {element.name or ''!r} is dropped by am2inc because of the event {event.name or ''!r}"
