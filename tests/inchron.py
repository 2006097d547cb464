"""What INCHRON's importer needs of a model, checked independently of everything that builds models.

One function for each row of severity E or W that a model in one file of version 2.0 or newer can break; the ids and the sentences are
those of the reference table of constraints.
"""

from collections import Counter

from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.naming import unique_name

WRITABLE = ("1.2.0", "2.0.0", "2.1.0", "2.2.0", "3.0.0", "3.1.0", "3.2.0", "3.3.0")
ROWS = []


def row(rule, severity):
    def add(check):
        ROWS.append((rule, severity, check))
        return check

    return add


def problems(model):
    """(id, severity, object) of each row that is broken."""
    return [(rule, severity, str(found)) for rule, severity, check in ROWS for found in check(model)]


def mapping(model, feature):
    return [item for part in model.all(am.MappingModel) for item in getattr(part, feature)]


@row("INC-IO-VERSION", "E")
def version(model):
    return [d.version for d in model.documents if d.version not in WRITABLE]


@row("INC-IO-REF", "E")
def references_resolve(model):
    return [reference.holder for reference, _ in model.unresolved()]


@row("INC-IO-LOCALLABEL", "W")
def no_local_labels(model):
    return [e for e in (*model.all(am.Task), *model.all(am.Runnable)) if e.local_labels]


@row("INC-IO-NAME", "W")
def names_are_unique(model):
    count = Counter(unique_name(e) for e in model.walk() if e.is_referable)
    return [name for name, n in count.items() if n > 1]


@row("INC-HW-PU-CLOCK", "E")
def cores_have_a_clock(model):
    return [core for core in model.all(am.ProcessingUnit) if core.frequency_domain is None]


@row("INC-HW-FREQ-VALUE", "E")
def clocks_have_a_frequency(model):
    used = {core.frequency_domain for core in model.all(am.ProcessingUnit)} - {None}
    return [c for c in used if c.default_value is None or not c.default_value.unit or not (c.default_value.value or 0) > 0]


@row("INC-HW-CACHE-PLACE", "E")
def caches_lie_with_a_core(model):
    def placed(cache):
        holder = cache.container
        return isinstance(holder, am.ProcessingUnit) or any(isinstance(m, am.ProcessingUnit) for m in holder.modules)

    return [cache for cache in model.all(am.Cache) if not placed(cache)]


@row("INC-HW-MEM-SIZE", "W")
def memories_have_a_size(model):
    modules = (*model.all(am.Memory), *model.all(am.Cache))
    return [m for m in modules if m.definition is None or m.definition.size is None or not m.definition.size.unit]


@row("INC-HW-CONN-IFACE", "W")
def interconnects_have_an_interface(model):
    good = {"AXI", "AHB", "APB", "custom"}
    return [h for h in model.all(am.ConnectionHandler) if not h.ports or h.ports[0].port_interface not in good]


@row("INC-HW-CONN-PORTS", "W")
def connections_join_an_initiator_and_a_responder(model):
    def types(connection):
        return {port.port_type for port in (connection.port1, connection.port2) if port is not None}

    return [c for c in model.all(am.HwConnection) if types(c) != {"initiator", "responder"}]


@row("INC-HW-BITWIDTH", "W")
def ports_have_a_width(model):
    return [port for port in model.all(am.HwPort) if not (port.bit_width or 0) > 0]


@row("INC-HW-ACCESS", "W")
def accesses_carry_no_timing(model):
    return list(model.all(am.HwAccessElement))


@row("INC-HW-FEATURE", "W")
def no_features(model):
    return list(model.all(am.HwFeature))


@row("INC-OS-ALGORITHM", "W")
def schedulers_have_fixed_priorities(model):
    def policy(s):
        return s.definition.name if s.definition else type(getattr(s, "scheduling_algorithm", None)).__name__

    return [s for s in model.all(am.TaskScheduler) if policy(s) not in ("FixedPriorityPreemptive", "NoneType")]


@row("INC-OS-ALGOPARAM", "W")
def only_priority_and_deadline(model):
    return [p for p in model.all(am.SchedulingParameter) if p.key is not None and p.key.name not in ("priority", "deadline")]


@row("INC-OS-PRIO-TYPE", "E")
def priorities_are_integer_objects(model):
    parameters = [p for p in model.all(am.SchedulingParameter) if p.key is not None and p.key.name == "priority"]
    return [p for p in parameters if not isinstance(p.value, am.IntegerObject)]


@row("INC-OS-DEADLINE-TYPE", "W")
def deadlines_are_times(model):
    parameters = [p for p in model.all(am.SchedulingParameter) if p.key is not None and p.key.name == "deadline"]
    return [p for p in parameters if not isinstance(p.value, am.Time)]


@row("INC-OS-PARAM-KEY", "E")
def parameters_have_a_key(model):
    return [p for p in model.all(am.SchedulingParameter) if p.key is None]


@row("INC-OS-OVERHEAD", "E")
def no_overhead(model):
    costly = [o for o in model.all(am.OsOverhead) if any(isinstance(part, am.Ticks) for part in o.walk())]
    return costly + [s for s in model.all(am.Scheduler) if s.computation_items]


@row("INC-OS-SEMA-TYPE", "W")
def semaphores_are_plain(model):
    plain = (None, "CountingSemaphore")
    return [s for s in model.all(am.Semaphore) if s.semaphore_type not in plain or s.priority_ceiling_protocol]


@row("INC-MAP-TASK", "E")
def allocations_are_complete(model):
    return [a for a in mapping(model, "task_allocation") if a.task is None or a.scheduler is None]


@row("INC-MAP-TASK-ONCE", "E")
def every_process_is_allocated_once(model):
    count = Counter([*(a.task for a in mapping(model, "task_allocation")), *(a.isr for a in mapping(model, "isr_allocation"))])
    return [p for p in (*model.all(am.Task), *model.all(am.ISR)) if count[p] != 1]


@row("INC-MAP-SCHED", "W")
def schedulers_have_cores(model):
    placed = {a.scheduler for a in mapping(model, "scheduler_allocation") if a.responsibility}
    return [s for s in model.all(am.Scheduler) if s not in placed]


@row("INC-MAP-ISR", "W")
def isr_allocations_are_complete(model):
    return [a for a in mapping(model, "isr_allocation") if a.isr is None or a.controller is None]


@row("INC-MAP-RUNNABLE", "W")
def no_runnable_allocation(model):
    return mapping(model, "runnable_allocation")


@row("INC-MAP-MEMORY", "E")
def labels_are_mapped(model):
    return [m for m in mapping(model, "memory_mapping") if m.memory is None or not isinstance(m.abstract_element, am.Label)]


@row("INC-MAP-SECTION", "W")
def no_sections(model):
    return mapping(model, "physical_section_mapping")


BAD_STIMULI = (am.EventStimulus, am.CustomStimulus, am.ArrivalCurveStimulus, am.VariableRateStimulus)
PERIODIC = (am.PeriodicStimulus, am.PeriodicSyntheticStimulus, am.PeriodicBurstStimulus)


def processes(model):
    return (*model.all(am.Task), *model.all(am.ISR))


@row("INC-ST-TYPE", "W")
def stimuli_convert(model):
    return [p for p in processes(model) if any(isinstance(s, BAD_STIMULI) for s in p.stimuli)]


@row("INC-ST-NONE", "W")
def processes_are_activated(model):
    return [p for p in processes(model) if not p.stimuli]


@row("INC-ST-PERIOD", "W")
def periods_are_positive(model):
    def good(s):
        return s.recurrence is not None and s.recurrence.unit and (s.recurrence.value or 0) > 0

    return [s for s in model.all(am.Stimulus) if isinstance(s, PERIODIC) and not good(s)]


@row("INC-ST-UNIT", "W")
def quantities_have_units(model):
    kinds = (am.Time, am.Frequency, am.DataSize)
    return [e for e in model.walk() if isinstance(e, kinds) and (e.unit is None or e.unit.name == "UNDEFINED")]


@row("INC-ST-JITTER", "W")
def jitter_converts(model):
    def good(jitter):
        if isinstance(jitter, am.TimeGaussDistribution):
            return jitter.lower_bound is not None and jitter.upper_bound is not None and not (jitter.mean and jitter.mean.value)
        return jitter is None or isinstance(jitter, am.TimeConstant | am.TimeUniformDistribution)

    return [s for s in model.all(am.PeriodicStimulus) if not good(s.jitter)]


@row("INC-ST-RELPER", "E")
def distances_convert(model):
    good = am.TimeGaussDistribution | am.TimeUniformDistribution
    return [s for s in model.all(am.RelativePeriodicStimulus) if not isinstance(s.next_occurrence, good)]


@row("INC-ST-RELPER-UNIT", "W")
def bounds_of_distances_have_the_same_unit(model):
    uniform = [s.next_occurrence for s in model.all(am.RelativePeriodicStimulus)]
    uniform = [u for u in uniform if isinstance(u, am.TimeUniformDistribution) and u.lower_bound and u.upper_bound]
    return [u for u in uniform if u.lower_bound.unit != u.upper_bound.unit]


@row("INC-ST-BURST", "W")
def bursts_can_be_counted(model):
    def bad(s):
        return not s.occurrence_count and not (s.occurrence_min_distance and s.occurrence_min_distance.value)

    return [s for s in model.all(am.PeriodicBurstStimulus) if bad(s)]


@row("INC-ST-MODELIST", "W")
def no_mode_lists(model):
    return [s for s in model.all(am.Stimulus) if s.set_mode_value_list is not None]


@row("INC-SW-NEED", "W")
def no_execution_needs(model):
    return list(model.all(am.ExecutionNeed))


@row("INC-SW-TICKS-DEFAULT", "W")
def ticks_have_a_default(model):
    return [t for t in model.all(am.Ticks) if t.default is None or len(t.extended) > 1]


@row("INC-SW-TICKS-GAUSS", "W")
def gauss_has_bounds(model):
    return [g for g in model.all(am.DiscreteValueGaussDistribution) if g.lower_bound is None or g.upper_bound is None]


@row("INC-SW-TICKS-BOUNDS", "W")
def boundaries_have_a_sampling_type(model):
    return [b for b in model.all(am.DiscreteValueBoundaries) if b.sampling_type in (None, "default")]


@row("INC-SW-TICKS-BETA", "W")
def no_beta(model):
    return list(model.all(am.DiscreteValueBetaDistribution))


@row("INC-SW-REF", "E")
def items_refer_to_something(model):
    wanted = {
        am.RunnableCall: "runnable",
        am.LabelAccess: "data",
        am.ModeLabelAccess: "data",
        am.InterProcessTrigger: "stimulus",
    }
    wanted |= dict.fromkeys((am.SetEvent, am.ClearEvent, am.WaitEvent), "event_mask")
    return [e for e in model.walk() if type(e) in wanted and getattr(e, wanted[type(e)]) is None]


@row("INC-SW-ACCESS", "W")
def accesses_say_what_they_do(model):
    return [a for a in model.all(am.LabelAccess) if a.access not in ("read", "write")]


@row("INC-SW-EVENTMASK", "W")
def masks_hold_one_event(model):
    return [m for m in model.all(am.EventMask) if len(m.events) != 1]


@row("INC-SW-CHANNEL", "W")
def no_channels(model):
    kinds = am.ChannelSend | am.ChannelReceive | am.EnforcedMigration | am.CustomEventTrigger | am.TerminateProcess
    return [e for e in model.walk() if isinstance(e, kinds)]


@row("INC-SW-GROUP", "W")
def groups_are_ordered(model):
    return [g for g in model.all(am.Group) if g.ordered is False]


@row("INC-SW-EXECCOND", "W")
def no_conditions_of_runnables(model):
    return [r for r in model.all(am.Runnable) if r.execution_condition is not None]


@row("INC-SW-ACTIVATION", "W")
def no_activations(model):
    return [r for r in model.all(am.Runnable) if r.activations]


@row("INC-SW-RELATION", "W")
def conditions_compare_for_equality(model):
    return [c for c in model.all(am.ModeCondition) if c.relation != "EQUAL"]


@row("INC-SW-PREEMPTION", "W")
def no_cooperative_tasks(model):
    return [t for t in model.all(am.Task) if t.preemption == "cooperative"]


@row("INC-SW-LABELSIZE", "W")
def labels_have_a_size(model):
    return [label for label in model.all(am.Label) if label.size is None]


@row("INC-EV-KIND", "W")
def chains_use_events_that_convert(model):
    good = am.ProcessEvent | am.RunnableEvent | am.LabelEvent | am.EventSet
    return [c for c in model.all(am.AbstractEventChain) if not all(isinstance(e, good) for e in (c.stimulus, c.response) if e)]


@row("INC-EV-TYPE", "W")
def events_say_what_happens(model):
    tasks = {"activate", "start", "terminate", "resume", "wait", "release"}
    good = {am.RunnableEvent: {"start", "terminate"}, am.LabelEvent: {"read", "write"}}
    found = [e for kind, types in good.items() for e in model.all(kind) if e.entity is None or e.event_type not in types]
    for event in model.all(am.ProcessEvent):
        allowed = tasks if isinstance(event.entity, am.Task) else {"activate", "start", "terminate"}
        if event.entity is None or event.event_type not in allowed:
            found.append(event)
    return found


@row("INC-EV-LABEL-RUN", "W")
def label_events_hold_for_all_runnables(model):
    return [e for e in model.all(am.LabelEvent) if e.runnable is not None]


@row("INC-EC-ENDS", "W")
def chains_have_ends(model):
    return [c for c in model.all(am.AbstractEventChain) if c.stimulus is None or c.response is None]


def parts(chain):
    return [item.event_chain for item in chain.items if item.event_chain is not None]


@row("INC-EC-SEQ", "W")
def segments_fit_together(model):
    found = []
    for chain in model.all(am.AbstractEventChain):
        segments = parts(chain)
        if chain.item_type == "parallel" or not segments:
            continue
        ends = [chain.stimulus, *(segment.response for segment in segments)]
        if [segment.stimulus for segment in segments] != ends[:-1] or ends[-1] is not chain.response:
            found.append(chain)
    return found


@row("INC-EC-PAR", "W")
def branches_have_the_ends_of_the_chain(model):
    parallel = [c for c in model.all(am.AbstractEventChain) if c.item_type == "parallel"]
    return [c for c in parallel if any((p.stimulus, p.response) != (c.stimulus, c.response) for p in parts(c))]


@row("INC-EC-PAR-ITEMS", "E")
def branches_have_items(model):
    parallel = [c for c in model.all(am.AbstractEventChain) if c.item_type == "parallel"]
    return [c for c in parallel if any(not p.items for p in parts(c))]


@row("INC-EC-SET", "W")
def chains_start_and_end_with_one_event(model):
    def several(event):
        return isinstance(event, am.EventSet) and len(event.events) > 1

    return [c for c in model.all(am.EventChain) if several(c.stimulus) or several(c.response)]


@row("INC-EC-CYCLE", "E")
def chains_do_not_contain_themselves(model):
    def contains(chain, above):
        inner = [part.event_chain for part in chain.walk() if isinstance(part, am.EventChainReference)]
        return any(c in above or contains(c, (*above, c)) for c in inner if c is not None)

    return [chain for chain in model.all(am.EventChain) if contains(chain, (chain,))]


@row("INC-LC-SCOPE", "W")
def latencies_have_a_chain(model):
    return [c for c in model.all(am.EventChainLatencyConstraint) if c.scope is None]


@row("INC-LC-MAX", "W")
def latencies_have_a_maximum_and_a_type(model):
    bad = (None, "_undefined_")
    return [c for c in model.all(am.EventChainLatencyConstraint) if c.maximum is None or c.type in bad]


@row("INC-CO-KIND", "W")
def nothing_else_is_demanded(model):
    others = [c for c in model.all(am.TimingConstraint) if not isinstance(c, am.EventChainLatencyConstraint)]
    kinds = am.Requirement | am.AffinityConstraint | am.RunnableSequencingConstraint | am.DataAgeConstraint
    return others + [e for e in model.walk() if isinstance(e, kinds)]
