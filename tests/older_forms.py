"""A model of 0.7.2 in the form of ITEA 1.3.0, in which the challenge of 2016 was published; only what the challenge models contain."""

import re

PACKAGES = {
    "common": "LongObject IntegerObject StringObject WeibullEstimators UniformDistribution SignedTime",
    "constraints": "EventChain SubEventChain ProcessRequirement TimeRequirementLimit",
    "events": "RunnableEvent",
    "hw": "Bus ComplexPort Core CoreType CrossbarSwitch LatencyAccessPath LatencyConstant Memory MemoryType Network Quartz",
    "mapping": "AbstractElementMapping",
    "os": "OSEK SchedulingHWUnit TaskScheduler",
    "stimuli": "Periodic Sporadic",
    "sw": "CallSequence InstructionsDeviation Label LabelAccess PeriodicActivation Runnable RunnableInstructions "
    "SingleValueStatistic SporadicActivation Task TaskRunnableCall",
}
PACKAGE = {name: package for package, names in PACKAGES.items() for name in names.split()}
#: Renamed in 0.7.0.
OLD_NAMES = {"MemoryType": "MemType", "PeriodicActivation": "Periodic"}


def itea(text):
    """The text of the model in that form."""

    def qualified(separator):
        return lambda match: f"{match[1]}{PACKAGE[match[2]]}{separator}{OLD_NAMES.get(match[2], match[2])}"

    spaces = " ".join(f'xmlns:{name}="http://www.amalthea.itea2.org/model/1.3.0/{name}"' for name in ("central", *PACKAGES))
    text = re.sub(r"<am:Amalthea [^>]*>", rf'<central:AMALTHEA xmi:version="2.0" {spaces} {XMI}>', text)
    text = text.replace("</am:Amalthea>", "</central:AMALTHEA>")
    text = re.sub(r'(xsi:type=")am:(\w+)', qualified(":"), text)
    text = re.sub(r"(\?type=)(\w+)", qualified("."), text)
    # A block of instructions had no item around it.
    text = re.sub(r'<runnableItems xsi:type="sw:RunnableInstructions">\s*<default ', "<runnableItems ", text)
    text = re.sub(r"</default>\s*</runnableItems>", "</runnableItems>", text)
    text = re.sub(r'<size value="(\d+)" unit="bit" ?/>', r'<size numberBits="\1"/>', text)
    text = re.sub(r'<memoryTypes (.*?)>\s*<size value="(\d+)" ?/>\s*</memoryTypes>', r'<memoryTypes \1 size="\2"/>', text)
    text = re.sub(
        r"<quartzes (.*?)>\s*<frequency value=\"2.0E8\" ?/>\s*</quartzes>", r'<quartzes \1 frequency="200000000"/>', text
    )
    text = re.sub(r'<taskAllocation task="', '<processAllocation xsi:type="mapping:TaskAllocation" process="', text)
    text = re.sub(r'(<mapping [^>]*)memory="', r'\1mem="', text)
    return text.replace("<osDataConsistency />", "").replace(' master="', ' isMaster="')


XMI = 'xmlns:xmi="http://www.omg.org/XMI" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'
