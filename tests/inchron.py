"""What INCHRON's importer needs of a model, checked independently of everything that builds models.

One function for each row of the reference table of constraints, with its id and its severity: E where it refuses, crashes or writes
something broken, W where information is lost or changed or where it warns, I where something is worth knowing.
"""

from collections import Counter
from xml.etree import ElementTree

from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.factfile import FeatureKind
from amalthea_uros.metamodel.naming import unique_name
from amalthea_uros.metamodel.versions import facts

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


def reads_with(document):
    """The metamodel with which a file is read: its own, or that of 3.2.0."""
    return document.version if document.version in ("1.2.0", "2.0.0", "2.1.0", "2.2.0") else "3.2.0"


def version_of(element):
    return reads_with(element.document)


@row("INC-IO-VERSION", "E")
def version_is_not_older_than_the_metamodels(model):
    return [d.migrated_from for d in model.documents if d.migrated_from]


@row("INC-IO-VERSION", "W")
def version(model):
    return [d.version for d in model.documents if d.version not in WRITABLE and not d.migrated_from]


@row("INC-IO-SAMEVERSION", "E")
def all_files_are_read_alike(model):
    return {reads_with(d) for d in model.documents} if len({reads_with(d) for d in model.documents}) > 1 else []


@row("INC-IO-SUBMODEL-ONCE", "E")
def sub_models_stand_in_one_file(model):
    count = Counter(type(part) for d in model.documents for part in {type(p): p for p in d.root.contents()}.values())
    return [cls for cls, n in count.items() if n > 1 and cls is not am.CustomProperty]


def members(model):
    """What has a namespace, but no id in the file."""
    texts = {d: d.source.text if d.source else "xmi:id" for d in model.documents}
    return [m for m in model.walk() if isinstance(m, am.INamespaceMember) and m.namespace and "xmi:id" not in texts[m.document]]


#: Where a reference that leads to nothing ends in a crash: the class of the holder and the feature.
FATAL = {
    ("RunnableCall", "runnable"),
    ("LabelAccess", "data"),
    ("ModeLabelAccess", "data"),
    ("InterProcessTrigger", "stimulus"),
    ("ModeValueCondition", "label"),
    ("ModeLabelCondition", "label1"),
    ("ModeLabelCondition", "label2"),
    ("ProcessingUnit", "frequency_domain"),
    ("TaskAllocation", "task"),
    ("Task", "stimuli"),
    ("ISR", "stimuli"),
    ("MemoryMapping", "abstract_element"),
    ("EventChain", "stimulus"),
    ("EventChain", "response"),
}


def broken(model):
    """The references that lead to nothing, and whether am2inc crashes at them."""
    plain = {f"{m.name}?type={type(m).__name__}" for m in members(model)}
    found = [reference for reference, text in model.unresolved() if text not in plain]
    return [(reference.holder, (type(reference.holder).__name__, reference.feature) in FATAL) for reference in found]


@row("INC-IO-REF", "E")
def needed_references_resolve(model):
    return [holder for holder, is_fatal in broken(model) if is_fatal]


@row("INC-IO-REF", "W")
def references_resolve(model):
    return [holder for holder, is_fatal in broken(model) if not is_fatal]


def everything_unknown(model):
    read = [(ElementTree.fromstring(d.source.text), facts(reads_with(d))) for d in model.documents if d.source]
    return [(kind, name) for root, known in read for kind, name in unknown(root, "Amalthea", known)]


@row("INC-IO-FEATURE", "E")
def elements_and_literals_are_known(model):
    return [name for kind, name in everything_unknown(model) if kind != "attribute"]


@row("INC-IO-FEATURE", "W")
def attributes_are_known(model):
    return [name for kind, name in everything_unknown(model) if kind == "attribute"]


def unknown(node, cls, known):
    features = {feature.name: feature for feature in known.features(cls)}
    for name, value in node.attrib.items():
        feature = features.get(name)
        if feature is None and not name.startswith("{"):
            yield "attribute", name
        elif feature is not None and feature.type in known.enums and value not in known.enums[feature.type].literals:
            yield "literal", value
    for child in node:
        feature = features.get(child.tag)
        if feature is None:
            yield "element", child.tag
        elif feature.kind is FeatureKind.CONTAINMENT:
            given = child.get("{http://www.w3.org/2001/XMLSchema-instance}type", feature.type).removeprefix("am:")
            yield from unknown(child, given, known) if given in known.classes else [("class", given)]


@row("INC-IO-XMIID", "E")
def objects_have_an_id_where_it_matters(model):
    texts = [d.source.text for d in model.documents if d.source]
    used = [m for m in members(model) if any(f'"{unique_name(m)}' in t or f" {unique_name(m)}" in t for t in texts)]
    return [text[:80] for text in texts if "<localLabels" in text and "xmi:id" not in text] + used


@row("INC-IO-LOCALLABEL", "W")
def no_local_labels(model):
    return list(model.all(am.LocalModeLabel))


@row("INC-IO-NAME", "W")
def names_are_unique(model):
    count = Counter(unique_name(e) for e in model.walk() if e.is_referable)
    plain = Counter((type(e), e.name) for e in model.walk() if isinstance(e, am.INamespaceMember) and e.is_referable)
    return [name for counted in (count, plain) for name, n in counted.items() if n > 1]


@row("INC-HW-PU-CLOCK", "E")
def cores_have_a_clock(model):
    return [core for core in model.all(am.ProcessingUnit) if core.frequency_domain is None]


def said(quantity):
    """Whether there is a quantity, with a unit."""
    return quantity is not None and quantity.unit is not None and quantity.unit != "_undefined_"


@row("INC-HW-FREQ-VALUE", "E")
def clocks_have_a_frequency(model):
    used = {core.frequency_domain for core in model.all(am.ProcessingUnit)} - {None}
    return [
        c
        for c in used
        if c.default_value is None and any(crowded(core) for core in model.all(am.ProcessingUnit) if core.frequency_domain is c)
    ]


def crowded(core):
    """Whether a processing unit shares its structure with another one."""
    return len([m for m in getattr(core.container, "modules", []) if isinstance(m, am.ProcessingUnit)]) > 1


@row("INC-HW-FREQ-VALUE", "W")
def clocks_do_not_take_a_default(model):
    used = {core.frequency_domain for core in model.all(am.ProcessingUnit)} - {None}
    wrong = [c for c in used if not said(c.default_value) or not (c.default_value.value or 0) > 0]
    return [c for c in wrong if c not in clocks_have_a_frequency(model)]


@row("INC-HW-CACHE-PLACE", "E")
def caches_lie_with_a_core(model):
    def placed(cache):
        holder = cache.container
        return isinstance(holder, am.ProcessingUnit) or any(isinstance(m, am.ProcessingUnit) for m in holder.modules)

    return [cache for cache in model.all(am.Cache) if not placed(cache)]


@row("INC-HW-MEM-SIZE", "W")
def memories_have_a_size(model):
    modules = (*model.all(am.Memory), *model.all(am.Cache))
    return [m for m in modules if m.definition is None or not said(m.definition.size)]


@row("INC-HW-PU-STRUCT", "W")
def nesting_of_cpus_means_nothing(model):
    cpus = {core.container for core in model.all(am.ProcessingUnit)}

    def inside(structure):
        return [s for s in structure.walk() if s in cpus]

    nested = [s for s in model.all(am.HwStructure) if len(inside(s)) > 1]
    return [s for s in nested if s in cpus or len(inside(s)) < len(cpus)]


@row("INC-HW-ONE-SYSTEM", "I")
def there_is_one_system(model):
    return [s for s in model.all(am.HwStructure) if s.structure_type == "System"][:-1]


@row("INC-HW-CONN-IFACE", "W")
def interconnects_have_an_interface(model):
    good = {"AXI", "AHB", "APB", "custom"}
    return [h for h in model.all(am.ConnectionHandler) if not h.ports or h.ports[0].port_interface not in good]


def ports_of_modules(model):
    return [port for module in model.all(am.HwModule) for port in module.ports]


@row("INC-HW-CONN-PORTS", "W")
def connections_join_an_initiator_and_a_responder(model):
    def types(connection):
        return {port.port_type for port in (connection.port1, connection.port2) if port is not None}

    untyped = [p for p in ports_of_modules(model) if p.port_type not in ("initiator", "responder")]
    return [c for c in model.all(am.HwConnection) if types(c) != {"initiator", "responder"}] + untyped


@row("INC-HW-BITWIDTH", "W")
def ports_have_a_width(model):
    return [port for port in ports_of_modules(model) if not (port.bit_width or 0) > 0]


@row("INC-HW-ACCESS", "W")
def accesses_carry_no_timing(model):
    def costs(element):
        return any(
            getattr(element, f"{what}", None) for what in ("access_latency", "read_latency", "write_latency", "data_rate")
        )

    costly = (*model.all(am.HwDefinition), *model.all(am.HwConnection))
    return list(model.all(am.HwAccessElement)) + [e for e in costly if costs(e)]


@row("INC-HW-FEATURE", "W")
def no_features_for_execution_times(model):
    needed = {entry.key for need in model.all(am.ExecutionNeed) for entry in need.needs}
    return [f for c in model.all(am.HwFeatureCategory) if c.name in needed for f in c.features]


@row("INC-OS-ALGORITHM", "W")
def schedulers_have_fixed_priorities(model):
    def policy(s):
        return s.definition.name if s.definition else type(getattr(s, "scheduling_algorithm", None)).__name__

    return [s for s in model.all(am.TaskScheduler) if policy(s) not in ("FixedPriorityPreemptive", "NoneType")]


def key(parameter):
    return parameter.key.name if parameter.key is not None else None


@row("INC-OS-ALGOPARAM", "W")
def only_priority_and_deadline(model):
    return [
        p
        for p in model.all(am.SchedulingParameter)
        if (isinstance(p.container, am.TaskAllocation) and key(p) not in ("priority", "deadline"))
        or (isinstance(p.container, am.TaskScheduler) and key(p) not in ("priority", None))
        or not isinstance(p.container, am.TaskAllocation | am.TaskScheduler)
    ]


@row("INC-OS-PRIO-TYPE", "E")
def priorities_are_integer_objects(model):
    holders = (*model.all(am.TaskAllocation), *model.all(am.TaskScheduler))
    parameters = [p for holder in holders for p in holder.scheduling_parameters if isinstance(p, am.SchedulingParameter)]
    return [p for p in parameters if key(p) == "priority" and not isinstance(p.value, am.IntegerObject)]


@row("INC-OS-DEADLINE-TYPE", "W")
def deadlines_are_times(model):
    parameters = [p for p in model.all(am.SchedulingParameter) if key(p) == "deadline"]
    return [p for p in parameters if isinstance(p.container, am.TaskAllocation) and not isinstance(p.value, am.Time)]


@row("INC-OS-PARAM-KEY", "E")
def parameters_have_a_key(model):
    return [p for p in model.all(am.SchedulingParameter) if p.key is None and isinstance(p.container, am.TaskScheduler)]


@row("INC-OS-OVERHEAD", "E")
def no_overhead(model):
    costly = [o for o in model.all(am.OsOverhead) if any(isinstance(part, am.Ticks) for part in o.walk())]
    return costly + [s for s in model.all(am.Scheduler) if s.computation_items]


@row("INC-OS-SEMA-TYPE", "W")
def semaphores_are_plain(model):
    plain = (None, "_undefined_", "CountingSemaphore")
    special = [s for s in model.all(am.Semaphore) if s.priority_ceiling_protocol or s.effective("ownership")]
    return special + [s for s in model.all(am.Semaphore) if s.semaphore_type not in plain]


@row("INC-OS-IC", "I")
def systems_have_one_interrupt_controller(model):
    return [o for o in model.all(am.OperatingSystem) if len(o.interrupt_controllers) > 1]


@row("INC-MAP-TASK", "E")
def allocations_have_a_task(model):
    return [a for a in mapping(model, "task_allocation") if a.task is None]


@row("INC-MAP-TASK", "W")
def allocations_have_a_scheduler(model):
    return [a for a in mapping(model, "task_allocation") if a.task is not None and a.scheduler is None]


@row("INC-MAP-TASK-ONCE", "W")
def every_process_is_allocated_once(model):
    count = Counter([*(a.task for a in mapping(model, "task_allocation")), *(a.isr for a in mapping(model, "isr_allocation"))])
    return [p for p in (*model.all(am.Task), *model.all(am.ISR)) if count[p] != 1]


@row("INC-MAP-SCHED", "W")
def schedulers_have_cores(model):
    placed = {a.scheduler for a in mapping(model, "scheduler_allocation") if a.responsibility}
    nameless = [a for a in mapping(model, "scheduler_allocation") if a.scheduler is None]
    return [s for s in model.all(am.Scheduler) if s not in placed] + nameless


@row("INC-MAP-EXECPU", "I")
def schedulers_run_where_they_decide(model):
    return [a for a in mapping(model, "scheduler_allocation") if a.executing_pu and a.executing_pu not in a.responsibility]


@row("INC-MAP-SHAREDRUN", "I")
def runnables_belong_to_one_system(model):
    def called(holder, seen):
        for call in [part for part in holder.walk() if isinstance(part, am.RunnableCall)]:
            if call.runnable is not None and call.runnable not in seen:
                seen.add(call.runnable)
                called(call.runnable, seen)
        return seen

    pairs = [(a.scheduler, a.task) for a in mapping(model, "task_allocation")]
    pairs += [(a.controller, a.isr) for a in mapping(model, "isr_allocation")]
    pairs = [(scheduler.container, process) for scheduler, process in pairs if scheduler is not None and process is not None]
    used = {(system, runnable) for system, process in pairs for runnable in called(process, set())}
    return [runnable for runnable, n in Counter(runnable for _, runnable in used).items() if n > 1]


@row("INC-MAP-ISR", "W")
def isr_allocations_are_complete(model):
    return [a for a in mapping(model, "isr_allocation") if a.isr is None or a.controller is None]


@row("INC-MAP-RUNNABLE", "W")
def no_runnable_allocation(model):
    return mapping(model, "runnable_allocation")


@row("INC-MAP-MEMORY", "E")
def labels_are_mapped(model):
    return [m for m in mapping(model, "memory_mapping") if m.abstract_element is None]


@row("INC-MAP-MEMORY", "W")
def nothing_but_labels_is_mapped(model):
    mapped = [m for m in mapping(model, "memory_mapping") if m.abstract_element is not None]
    return [m for m in mapped if m.memory is None or not isinstance(m.abstract_element, am.Label)]


@row("INC-MAP-SECTION", "W")
def no_sections(model):
    return mapping(model, "physical_section_mapping")


BAD_STIMULI = (am.EventStimulus, am.CustomStimulus, am.ArrivalCurveStimulus, am.VariableRateStimulus)
PERIODIC = (am.PeriodicStimulus, am.PeriodicSyntheticStimulus, am.PeriodicBurstStimulus)


def processes(model):
    return (*model.all(am.Task), *model.all(am.ISR))


@row("INC-ST-TYPE", "W")
def stimuli_convert(model):
    return [s for s in model.all(am.Stimulus) if isinstance(s, BAD_STIMULI)]


@row("INC-ST-ORDER", "W")
def stimuli_that_convert_come_first(model):
    bad = [[isinstance(s, BAD_STIMULI) for s in p.stimuli] for p in processes(model)]
    return [row for row in bad if row != sorted(row)]


@row("INC-ST-NONE", "W")
def processes_are_activated(model):
    return [p for p in processes(model) if not p.stimuli]


@row("INC-ST-PERIOD", "W")
def periods_are_positive(model):
    def good(s):
        return said(s.recurrence) and (s.recurrence.value or 0) > 0

    return [s for s in model.all(am.Stimulus) if isinstance(s, PERIODIC) and not good(s)]


@row("INC-ST-UNIT", "W")
def quantities_have_units(model):
    kinds = (am.Time, am.Frequency, am.DataSize)
    return [e for e in model.walk() if isinstance(e, kinds) and not said(e)]


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
    stated = [s for s in model.all(am.RelativePeriodicStimulus) if s.next_occurrence is not None]
    return [s for s in stated if not isinstance(s.next_occurrence, good)]


@row("INC-ST-RELPER", "W")
def distances_are_stated(model):
    return [s for s in model.all(am.RelativePeriodicStimulus) if s.next_occurrence is None]


@row("INC-ST-RELPER-UNIT", "W")
def bounds_of_distances_have_the_same_unit(model):
    uniform = [s.next_occurrence for s in model.all(am.RelativePeriodicStimulus)]
    uniform = [u for u in uniform if isinstance(u, am.TimeUniformDistribution) and u.lower_bound and u.upper_bound]
    return [u for u in uniform if u.lower_bound.unit != u.upper_bound.unit]


@row("INC-ST-BURST", "W")
def bursts_can_be_counted(model):
    def bad(s):
        distance, count = s.occurrence_min_distance, s.occurrence_count
        return count is not None and count < 1 and not (said(distance) and (distance.value or 0) > 0)

    return [s for s in model.all(am.PeriodicBurstStimulus) if bad(s)]


@row("INC-ST-MODELIST", "W")
def no_mode_lists(model):
    return [s for s in model.all(am.Stimulus) if s.set_mode_value_list is not None]


@row("INC-SW-NEED", "W")
def no_execution_needs(model):
    return list(model.all(am.ExecutionNeed))


@row("INC-SW-TICKS-DEFAULT", "W")
def ticks_have_a_default(model):
    return [t for t in model.all(am.Ticks) if t.default is None or t.extended]


def values(model, cls):
    """What is read of Ticks, if it is of a class."""
    read = [t.default or (t.extended[0].value if t.extended else None) for t in model.all(am.Ticks)]
    return [value for value in read if isinstance(value, cls)]


@row("INC-SW-TICKS-INT", "I")
def parameters_are_whole(model):
    read = values(model, am.DiscreteValueStatistics | am.DiscreteValueGaussDistribution)
    read += values(model, am.DiscreteValueWeibullEstimatorsDistribution)
    numbers = [getattr(value, name, None) or 0 for value in read for name in ("average", "mean", "sd")]
    return [number for number in numbers if number % 1]


@row("INC-SW-TICKS-GAUSS", "W")
def gauss_has_bounds(model):
    return [g for g in values(model, am.DiscreteValueGaussDistribution) if g.lower_bound is None or g.upper_bound is None]


@row("INC-SW-TICKS-BOUNDS", "W")
def boundaries_have_a_sampling_type(model):
    return [b for b in values(model, am.DiscreteValueBoundaries) if b.sampling_type in (None, "default")]


@row("INC-SW-TICKS-BETA", "W")
def no_beta(model):
    return values(model, am.DiscreteValueBetaDistribution)


@row("INC-SW-TICKS-STAT", "W")
def no_statistics(model):
    return values(model, am.DiscreteValueStatistics)


UNPROTECTED = (None, "_undefined_", "inherited", "noProtection")


@row("INC-SW-STABILITY", "W")
def no_data_stability(model):
    return [e for e in (*model.all(am.Label), *model.all(am.LabelAccess)) if e.data_stability not in UNPROTECTED]


@row("INC-OS-CONSISTENCY", "W")
def no_data_consistency(model):
    found = [c for c in model.walk() if isinstance(c, am.OsDataConsistency)]
    return [c for c in found if c.mode not in UNPROTECTED or c.data_stability or c.non_atomic_data_coherency]


@row("INC-SW-REF", "E")
def items_refer_to_something(model):
    wanted = {
        am.RunnableCall: "runnable",
        am.LabelAccess: "data",
        am.ModeLabelAccess: "data",
        am.InterProcessTrigger: "stimulus",
    }
    wanted |= dict.fromkeys((am.SetEvent, am.ClearEvent, am.WaitEvent), "event_mask")
    empty = [e for e in model.walk() if type(e) in wanted and getattr(e, wanted[type(e)]) is None]
    return [e for e in empty if e.enclosing(am.ProcessPrototype) is None]


@row("INC-SW-ACCESS", "W")
def accesses_say_what_they_do(model):
    modes = [a for a in model.all(am.ModeLabelAccess) if a.data is not None]
    enums = [a for a in modes if isinstance(a.data.mode, am.EnumMode) and a.access in ("increment", "decrement")]
    free = [a for a in model.all(am.SemaphoreAccess) if a.semaphore is None]
    labels = [a for a in model.all(am.LabelAccess) if a.access not in ("read", "write")]
    return labels + enums + free + [a for a in modes if a.access in (None, "_undefined_")]


@row("INC-SW-SERVER", "E")
def calls_and_accesses_of_servers_are_complete(model):
    calls = [c for c in model.all(am.ServerCall) if c.server_runnable is None]
    accesses = [a for a in model.all(am.SenderReceiverCommunication) if a.label is None]
    return [item for item in calls + accesses if version_of(item) > "3"]


@row("INC-SW-SERVER", "W")
def calls_and_accesses_of_servers_are_of_the_right_version(model):
    items = [*model.all(am.ServerCall), *model.all(am.SenderReceiverCommunication)]
    return [item for item in items if version_of(item) < "3"]


@row("INC-SW-GRAPH", "W")
def runnables_have_a_graph(model):
    return [r for r in model.all(am.Runnable) if r.activity_graph is None and version_of(r) > "3"]


@row("INC-SW-CONDKIND", "E")
def conditions_compare_modes(model):
    others = [c for c in other_conditions(model) if isinstance(c.container, am.ConditionConjunction)]
    blank = [c for c in model.all(am.ModeValueCondition) if c.label is None]
    return others + blank + [c for c in model.all(am.ModeLabelCondition) if None in (c.label1, c.label2)]


def other_conditions(model):
    return [c for c in model.all(am.Condition) if not isinstance(c, am.ModeValueCondition | am.ModeLabelCondition)]


@row("INC-SW-CONDKIND", "W")
def conditions_compare_labels_of_the_same_kind(model):
    def kind(label):
        return type(label.mode) if label.mode is not None else am.NumericMode

    others = [c for c in other_conditions(model) if not isinstance(c.container, am.ConditionConjunction)]
    pairs = [(c.label1, c.label2) for c in model.all(am.ModeLabelCondition) if None not in (c.label1, c.label2)]
    return others + [p for p in pairs if p[1].mode is None or kind(p[0]) is not kind(p[1])]


@row("INC-SW-CONDSET", "W")
def branches_and_loops_have_conditions(model):
    holders = [e for e in model.walk() if isinstance(e, am.SwitchEntry | am.ModeSwitchEntry | am.WhileLoop)]
    return [e for e in holders if e.condition is None or not e.condition.entries]


def is_value(text, mode):
    if isinstance(mode, am.EnumMode):
        return text in [literal.name for literal in mode.literals]
    return (text or "").strip().lstrip("+-").isdigit() and abs(int(text)) < 2**31


@row("INC-SW-MODE-VALUE", "W")
def values_are_those_of_the_mode(model):
    uses = [(e.initial_value, e.mode) for e in model.all(am.ModeLabel) if e.mode is not None and e.initial_value]
    uses += [(c.value, c.label.mode) for c in model.all(am.ModeValueCondition) if c.label is not None]
    sets = [a for a in model.all(am.ModeLabelAccess) if a.data is not None and a.access == "set"]
    uses += [(a.value, a.data.mode) for a in sets if isinstance(a.data.mode, am.EnumMode)]
    return [text for text, mode in uses if not is_value(text, mode)]


@row("INC-SW-MODE-NUMSET", "W")
def numbers_are_not_set(model):
    sets = [a for a in model.all(am.ModeLabelAccess) if a.data is not None and a.access == "set"]
    return [a for a in sets if isinstance(a.data.mode, am.NumericMode)]


@row("INC-SW-MODE-MISSING", "W")
def mode_labels_have_a_mode(model):
    return [label for label in model.all(am.ModeLabel) if label.mode is None]


def stated(holder, name):
    """The values of a custom property, as class and value."""
    return [(type(p.value), getattr(p.value, "value", None)) for p in holder.custom_properties if p.key == name]


@row("INC-SW-DISPATCH", "E")
def properties_are_understood(model):
    tasks = [t for t in model.all(am.Task) if version_of(t) > "3"]
    odd = [t for t in tasks if any(cls is not am.BooleanObject for cls, _ in stated(t, "callbackServer"))]
    servers = [t for t in tasks if (am.BooleanObject, True) in stated(t, "callbackServer")]
    good = [(am.StringObject, policy) for policy in ("FIFO", "LIFO", "Priority")]
    groups = [g for t in servers for g in t.walk() if isinstance(g, am.Group)]
    return odd + [g for g in groups if any(value not in good for value in stated(g, "dispatchingPolicy"))]


@row("INC-SW-PROCCHAIN", "W")
def nothing_is_passed_over(model):
    software = (am.ProcessChain, am.ProcessPrototype, am.Section, am.CustomEntity, am.Channel)
    others = (am.Component, am.System, am.Scenario, am.CoreAllocationConstraint, am.MemoryMappingConstraint)
    return [e for e in model.walk() if isinstance(e, (*software, *others))]


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
    return [c for c in model.all(am.ModeCondition) if c.relation != "EQUAL" and version_of(c) != "1.2.0"]


@row("INC-SW-PREEMPTION", "W")
def no_cooperative_tasks(model):
    return [t for t in model.all(am.Task) if t.preemption == "cooperative"]


@row("INC-SW-LABELSIZE", "W")
def labels_have_a_size(model):
    return [label for label in model.all(am.Label) if label.size is None]


@row("INC-EV-KIND", "W")
def chains_use_events_that_convert(model):
    # Not only in chains: each event of another class is told of.
    return [e for e in model.all(am.Event) if not isinstance(e, am.ProcessEvent | am.RunnableEvent | am.LabelEvent)]


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
    on_cores = [e for e in (*model.all(am.ProcessEvent), *model.all(am.RunnableEvent)) if e.processing_unit is not None]
    return on_cores + [e for e in model.all(am.LabelEvent) if e.runnable is not None]


def without_ends(model):
    return [c for c in model.all(am.AbstractEventChain) if c.stimulus is None or c.response is None]


@row("INC-EC-ENDS", "E")
def chains_with_items_have_ends(model):
    return [c for c in without_ends(model) if isinstance(c, am.EventChain) and c.items]


@row("INC-EC-ENDS", "W")
def chains_have_ends(model):
    return [c for c in without_ends(model) if not (isinstance(c, am.EventChain) and c.items)]


def parts(chain):
    return [item.event_chain for item in chain.items if item.event_chain is not None]


def parallel(model):
    return [c for c in model.all(am.AbstractEventChain) if c.item_type == "parallel" and len(c.items) > 1]


@row("INC-EC-SEQ", "W")
def segments_fit_together(model):
    found = []
    for chain in model.all(am.AbstractEventChain):
        segments = parts(chain)
        if chain in parallel(model):
            continue
        if len(segments) != len(chain.items):
            found.append(chain)
        if not segments:
            continue
        ends = [chain.stimulus, *(segment.response for segment in segments)]
        if [segment.stimulus for segment in segments] != ends[:-1] or ends[-1] is not chain.response:
            found.append(chain)
    return found


@row("INC-EC-PAR", "W")
def branches_have_the_ends_of_the_chain(model):
    empty = [c for c in parallel(model) if len(parts(c)) != len(c.items)]
    return empty + [c for c in parallel(model) if any((p.stimulus, p.response) != (c.stimulus, c.response) for p in parts(c))]


def flat(model):
    return [c for c in parallel(model) if any(not p.items for p in parts(c))]


@row("INC-EC-PAR-ITEMS", "E")
def branches_that_are_converted_have_items(model):
    return [c for c in flat(model) if c not in branches_have_the_ends_of_the_chain(model)]


@row("INC-EC-PAR-ITEMS", "W")
def branches_have_items(model):
    return [c for c in flat(model) if c in branches_have_the_ends_of_the_chain(model)]


def members_of(event):
    """How many events an end of a chain means."""
    return len(event.events) if isinstance(event, am.EventSet) else 1


@row("INC-EC-SET", "E")
def chains_have_no_empty_sets(model):
    empty = [c for c in model.all(am.EventChain) if 0 in (members_of(c.stimulus), members_of(c.response))]
    later = [s for c in model.all(am.AbstractEventChain) if c not in parallel(model) for s in parts(c)[1:]]
    return empty + [s for s in later if s.stimulus and members_of(s.stimulus) != 1 and is_mapped(s.stimulus, model)]


@row("INC-EC-SET", "W")
def chains_start_and_end_with_one_event(model):
    return [c for c in model.all(am.EventChain) if max(members_of(c.stimulus), members_of(c.response)) > 1]


@row("INC-EC-CYCLE", "E")
def chains_do_not_contain_themselves(model):
    def contains(chain, above):
        inner = [part.event_chain for part in chain.walk() if isinstance(part, am.EventChainReference)]
        return any(c in above or contains(c, (*above, c)) for c in inner if c is not None)

    return [chain for chain in model.all(am.EventChain) if contains(chain, (chain,))]


@row("INC-LC-SCOPE", "W")
def latencies_have_a_chain(model):
    return [c for c in model.all(am.EventChainLatencyConstraint) if c.scope is None or is_dropped(c.scope, model)]


def is_dropped(chain, model):
    ends = [chain.stimulus, chain.response]
    sets = [e for e in ends if isinstance(e, am.EventSet) and len(e.events) > 1]
    return bool(sets) or not all(is_mapped(e, model) for e in ends) or is_refused(chain, model)


def is_refused(chain, model):
    segments = parts(chain)
    if not chain.items:
        return chain.stimulus is None or chain.response is None
    if chain in parallel(model):
        here = any((s.stimulus, s.response) != (chain.stimulus, chain.response) for s in segments)
    else:
        here = not all(is_mapped(s.stimulus, model) for s in segments[1:])
    return here or any(is_refused(s, model) for s in segments)


def is_mapped(event, model):
    events = event.events if isinstance(event, am.EventSet) else [event]
    bad = (*chains_use_events_that_convert(model), *events_say_what_happens(model))
    return all(e is not None and e not in bad for e in events)


@row("INC-LC-MAX", "W")
def latencies_have_a_maximum_and_a_type(model):
    bad = (None, "_undefined_")
    return [c for c in model.all(am.EventChainLatencyConstraint) if c.maximum is None or c.type in bad]


@row("INC-CO-KIND", "W")
def nothing_else_is_demanded(model):
    others = [c for c in model.all(am.TimingConstraint) if not isinstance(c, am.EventChainLatencyConstraint)]
    kinds = am.Requirement | am.AffinityConstraint | am.RunnableSequencingConstraint | am.DataAgeConstraint
    kinds |= am.DataCoherencyGroup | am.DataStabilityGroup | am.PhysicalSectionConstraint
    return others + [e for e in model.walk() if isinstance(e, kinds)]
