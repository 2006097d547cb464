"""The event model, and event chains."""

from __future__ import annotations

from typing import Any

from amalthea_uros.bridge.basics.codecs import reference, references, same_names
from amalthea_uros.bridge.basics.context import Building, Extracting
from amalthea_uros.bridge.basics.entries import ClassEntry, ClassTable
from amalthea_uros.bridge.basics.kinds import ObjectKind
from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element
from amalthea_uros.perf import events as perf

_PROCESS = reference(ObjectKind.PROCESS)
_RUNNABLE = reference(ObjectKind.RUNNABLE)
_CORE = ("processing_unit", reference(ObjectKind.MODULE))

EVENTS = ClassTable(
    ClassEntry(
        perf.ProcessEvent,
        am.ProcessEvent,
        change=("event_type", same_names(perf.ProcessChange, am.ProcessEventType)),
        process=("entity", reference(ObjectKind.PROCESS)),
        core=_CORE,
    ),
    ClassEntry(
        perf.RunnableEvent,
        am.RunnableEvent,
        change=("event_type", same_names(perf.RunnableChange, am.RunnableEventType)),
        runnable=("entity", reference(ObjectKind.RUNNABLE)),
        process=_PROCESS,
        core=_CORE,
    ),
    ClassEntry(
        perf.LabelEvent,
        am.LabelEvent,
        change=("event_type", same_names(perf.LabelChange, am.LabelEventType)),
        label=("entity", reference(ObjectKind.DATA)),
        runnable=_RUNNABLE,
        process=_PROCESS,
    ),
    ClassEntry(
        perf.ModeLabelEvent,
        am.ModeLabelEvent,
        change=("event_type", same_names(perf.ModeChange, am.ModeLabelEventType)),
        label=("entity", reference(ObjectKind.MODE_LABEL)),
        runnable=_RUNNABLE,
        process=_PROCESS,
    ),
    ClassEntry(
        perf.ChannelEvent,
        am.ChannelEvent,
        change=("event_type", same_names(perf.ChannelChange, am.ChannelEventType)),
        channel=("entity", reference(ObjectKind.DATA)),
        runnable=_RUNNABLE,
        process=_PROCESS,
    ),
    ClassEntry(
        perf.SemaphoreEvent,
        am.SemaphoreEvent,
        change=("event_type", same_names(perf.SemaphoreChange, am.SemaphoreEventType)),
        semaphore=("entity", reference(ObjectKind.SEMAPHORE)),
        runnable=_RUNNABLE,
        process=_PROCESS,
        core=_CORE,
    ),
    ClassEntry(perf.StimulusEvent, am.StimulusEvent, stimulus=("entity", reference(ObjectKind.STIMULUS))),
    ClassEntry(perf.CustomEvent, am.CustomEvent, kind="event_type"),
    ClassEntry(perf.EventSet, am.EventSet, events=references(ObjectKind.EVENT)),
)

# Chains. An item refers to a chain or contains one; the kind of the items is an attribute of the chain that has them.

_EVENT, _CHAIN = reference(ObjectKind.EVENT), reference(ObjectKind.CHAIN)


def _fill(element: Any, chain: perf.EventChain | perf.Segment, context: Building) -> Any:
    element.stimulus = _EVENT.build(chain.stimulus, context)
    element.response = _EVENT.build(chain.response, context)
    if chain.items is not None:
        is_parallel = isinstance(chain.items, perf.Parallel)
        element.item_type = am.EventChainItemType.PARALLEL if is_parallel else am.EventChainItemType.SEQUENCE
        element.items = [_build_item(item, context) for item in chain.items.items]
        if isinstance(chain.items, perf.Parallel):
            element.min_items_completed = chain.items.completed
    return element


def _build_item(item: perf.ChainItem, context: Building) -> am.EventChainItem:
    if isinstance(item, perf.ChainReference):
        return am.EventChainReference(event_chain=_CHAIN.build(item.chain, context))
    return am.EventChainContainer(event_chain=_fill(am.SubEventChain(name=item.name or None), item, context))


def _items(element: Any, context: Extracting) -> perf.Sequence | perf.Parallel | None:
    items = tuple(found for item in element.items if (found := _extract_item(item, context)) is not None)
    if element.item_type is am.EventChainItemType.PARALLEL:
        completed = element.min_items_completed
        return perf.Parallel(items=items, completed=1 if completed is None else completed)
    return perf.Sequence(items) if items else None


def _extract_item(item: Any, context: Extracting) -> perf.ChainItem | None:
    inner = item.event_chain
    if isinstance(item, am.EventChainReference):
        name = _CHAIN.extract(inner, context, item)
        return None if name is None else perf.ChainReference(chain=name)
    if inner is None:
        context.note("EXT004", "EventChainContainer ignored: it has no chain", item)
        return None
    return perf.Segment(
        name=inner.name or "",
        stimulus=_EVENT.extract(inner.stimulus, context, inner),
        response=_EVENT.extract(inner.response, context, inner),
        items=_items(inner, context),
        origin=context.location(inner),
    )


class _ChainEntry(ClassEntry):
    def fill(self, element: Element, item: Any, context: Building) -> Element:
        context.at(item)
        found: Element = _fill(element, item, context)
        return found

    def extract(self, element: Any, context: Extracting) -> perf.EventChain:
        return perf.EventChain(
            name=context.names[element],
            origin=context.location(element),
            stimulus=_EVENT.extract(element.stimulus, context, element),
            response=_EVENT.extract(element.response, context, element),
            items=_items(element, context),
        )


CHAINS = ClassTable(_ChainEntry(perf.EventChain, am.EventChain))
