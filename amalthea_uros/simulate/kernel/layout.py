"""The language of the kernel: its memory, records of whole numbers in one array, and the operations of programs in it.

A record is known by the place at which it begins (0 is no record), and has its fields one after the other. The kernel works on this
array alone, so that machine code gets one argument and calls are cheap; interpreted, the array is a list.
"""

from __future__ import annotations

from enum import IntEnum
from typing import TypeAlias

#: Later than everything, and above everything.
NEVER = 2**62

# The head of the memory. JOBS and the like are the places of the next row, JOBS_END where there is no place left.
NONE, NOW, UNTIL, ARRIVAL, ARRIVALS_END = range(5)
JOBS, JOBS_END, OBSERVATIONS, OBSERVATIONS_END, EVENTS, EVENTS_END = range(5, 11)
ORDER, STEPS, IS_TRACED, CAUSE, PLACES = range(11, 16)
CORES, CORES_END, DOMAINS, DOMAINS_END, SERVERS, SERVERS_END = range(16, 22)
PROCESSES, PROCESSES_END, SEMAPHORES, SEMAPHORES_END, HAS_WRITES, HEAD = range(22, 28)

#: Rows: an arrival is (time, stimulus); a job is as in `timing.observed.job_times`, an observation as in
#: `Observation`, an event as in `trace.table`.
ARRIVAL_SIZE, JOB_SIZE, OBSERVATION_SIZE, EVENT_SIZE = 2, 11, 4, 7

# A process. Its state, the next operation, and what is left of its execution.
STATE, SINCE, AT, LEFT = range(4)
# Its urgency.
LEVEL, OWN_LEVEL, RUNNING_LEVEL, DEADLINE, OWN_DEADLINE, INNER, SEQUENCE = range(4, 11)
# Its job.
ACTIVATION, INSTANCE, START, IS_STARTED, YIELDS, MASKS = range(11, 17)
# The account of its job.
TIME_RUNNING, TIME_WAITING, TIME_POLLING, TIME_PARKING, PREEMPTIONS, MIGRATIONS = range(17, 23)
# Its activations.
PENDING, FIRST_PLACE, NEXT_INSTANCE, ACTIVATIONS, LOST, LIMIT, QUEUE = range(23, 30)
# What it executes, and what is reported of it.
ENTRY, NUMBER, IS_REPORTED, ENTITY = range(30, 34)
# Where and how it is scheduled.
DOMAIN, CORE, ALLOWED, IS_COOPERATIVE, IS_BY_DEADLINE, HAS_SERVER_DEADLINE, RELATIVE_DEADLINE = range(34, 41)
SLICE, SLICE_LEFT, SERVER, DECISION = range(41, 45)
# Chains that pass it.
CAPTURES, CAPTURES_END, LET_STAGES, LET_STAGES_END = range(45, 49)
# What it holds and waits for.
HOLDS, WAITS_FOR, WANTED, WAITS_EVENTS, EVENTS_SET, WAITS_ANSWER, TICKETS = range(49, 56)
IS_CHOSEN, WATCHED, PROCESS_SIZE = range(56, 59)

#: A place in the queue of activations of a process: time, number, place in the order of all activations, and a value for each capture.
QUEUE_TIME, QUEUE_INSTANCE, QUEUE_SEQUENCE, QUEUE_CAPTURES = range(4)

# A core.
STOP, BEGIN, RUNS, NEEDS_STEP, BUSY, CHOSEN, CORE_NUMBER, CORE_ENTITY, CORE_DOMAIN, CORE_SIZE = range(10)

# A domain: cores that share processes; RAISED of them have another level than their own, PRESENT have a job.
IS_DUE, RAISED, PRESENT, HAS_COOPERATIVE, MEMBERS, MEMBERS_END, ITS_CORES, ITS_CORES_END, DOMAIN_SIZE = range(9)

# A stimulus; an assignment is (mode label, value). What is watched is the number of a source of events plus 1, or 0.
TARGETS, TARGETS_END, CONDITION, COUNTER, ASSIGNMENTS, ASSIGNMENTS_END = range(6)
OCCURRENCES, STIMULUS_ENTITY, MESSAGES, STIMULUS_SOURCE, STIMULUS_SIZE = range(6, 11)

# Places of the model that keep a state.
COUNTED, EVERY, FIRST_EFFECT, COUNTER_SIZE = range(4)
WORD, PARTS_LEFT, PARTS, PARTS_TOTAL, ORDERED_PARTS, GROUP_SIZE = range(6)
PASSES, LOOP_SIZE = range(2)
MODE_VALUE, LITERALS, IS_CONSTANT, MODE_SIZE = range(4)
FILL, CAPACITY, OVERFLOWS, CHANNEL_SIZE = range(4)
STREAM_AT, STREAM_END, STREAM_NUMBER, STREAM_SIZE = range(4)

# A place that executes a runnable, and the executions of the runnable by all.
EXECUTED, EXECUTION, SITE_SIZE = range(3)
EXECUTIONS, RUNNABLE_ENTITY, RUNNABLE_SIZE = range(3)

# A queue of messages of a process: numbers of those that have arrived, were taken and did not fit, and whether the job has taken one.
ARRIVED, TAKEN_MESSAGES, LOST_MESSAGES, HAS_TAKEN, MESSAGE_LIMIT, MESSAGE_CAPTURE, MESSAGE_SIZE = range(7)

# A condition: alternatives, each of comparisons.
ALTERNATIVES, ALTERNATIVES_END, CONDITION_SIZE = range(3)
COMPARISONS, COMPARISONS_END, ALTERNATIVE_SIZE = range(3)
LEFT_VALUE, RIGHT_VALUE, RIGHT_CONSTANT, RELATION, COMPARISON_SIZE = range(5)

# A semaphore, and what a process holds of it.
USED, USERS, CEILING, DEADLINE_CEILING, HAS_OWNER, SEMAPHORE_NUMBER, SEMAPHORE_ENTITY, SEMAPHORE_SIZE = range(8)
HELD, HELD_SINCE, HOLD_SIZE = range(3)

# Some events of the operating system, as one operation names them; an entry of the list is (number, entity).
EVENT_LIST, EVENT_LIST_END, OF_PROCESS, NEEDS_ALL, IS_ACTIVE_WAIT, EVENT_ROW_SIZE = range(6)

# A runnable that others ask for; a process has a ticket for each: the number of what it has asked for last.
ASKED, BEGUN, ANSWERED, SERVICE_NUMBER, SERVICE_SIZE = range(5)

# A server with a budget; a plan is (time, amount).
SERVER_AT, BUDGET, FULL_BUDGET, SERVER_PERIOD, SERVER_KIND, PARENT, SERVER_DOMAIN, SERVED, SERVED_END = range(9)
IS_ACTIVE, ACTIVE_SINCE, BUDGET_BEFORE, SERVER_DEADLINE, BUDGET_RATIO, PERIOD_RATIO = range(9, 15)
PLANS, PLANS_END, SERVER_SIZE = range(15, 18)
PLAN_TIME, PLAN_AMOUNT, PLAN_SIZE = range(3)
DEFERRABLE, POLLING_SERVER, SPORADIC, CONSTANT_BANDWIDTH = range(4)

# A stage of a chain; values are numbers of occurrences of the stimulus of the chain, -1 is none.
# What it has taken, and where it comes from.
VALUE, TAKEN, LINK, BEFORE_STAGE, CAPTURE = range(5)
# How far its job has come.
REACHED, NEEDED, IS_MARKED, MARKED_AT, HAS_RESPONDED, RESPONDED_AT = range(5, 11)
# What it gives away, and to whom.
OUT, IS_OUT, IS_LAST, ROUTE, STEP, CHAIN_ENTITY, STAGE_SIZE = range(11, 18)
# A route of a chain.
STAMPS, ROUTE_NUMBER, ROUTE_SIZE = range(3)

# A runnable whose executions in a process are measured: when the last one began, and the account of the job at that time.
EXECUTION_NUMBER, BEGAN, BEFORE_RUNNING, BEFORE_WAITING, BEFORE_POLLING = range(5)
BEFORE_PARKING, BEFORE_PREEMPTIONS, BEFORE_MIGRATIONS, EXECUTION_SIZE = range(5, 9)

#: An operation and its two arguments.
OPERATION_SIZE = 3


#: A list if the kernel is interpreted; an array of int64 if it is machine code, of which no more is asked than of a list.
Memory: TypeAlias = list[int]


# What the kernel reports: rows of whole numbers, one for each job and for each observation of a chain.
#
# Times are in the time units of the run; a picosecond has a whole number of them.


class Observation(IntEnum):
    """The columns of a row about a chain, or about an occurrence of something that is watched.

    `STAMP` is the number of the occurrence of the chain's stimulus, counted from 0: its own number for a stimulus; for a response
    that of the newest stimulus whose effect the response shows, or -1 as long as it shows none. An occurrence has the number of its
    source instead of a route, and the number of the core instead of a stamp, or -1.
    """

    ROUTE = 0
    KIND = 1
    TIME = 2
    STAMP = 3


#: The kinds of observations.
STIMULUS, RESPONSE, OCCURRENCE = 0, 1, 2


# The operations of programs. An operation has two arguments, in parentheses here; "goes to" means the place of another operation.

END = 0  # the job ends
EXECUTE = 1  # executes for (a time)
DRAW = 2  # executes for a time from (a stream)
JUMP = 3  # goes to (an operation)
COUNT = 4  # counts with (a counter); if this time does not take effect, goes to (an operation)
TEST = 5  # if (a condition) is false, goes to (an operation)
CHOOSE = 6  # goes to the operation at an index from (a stream), of a table at (a place)
SHUFFLE = 7  # begins (a group) in an order by a word from (a stream)
NEXT = 8  # goes to the next part of (a group); if there is none, to (an operation)
REPEAT = 9  # begins (a loop) with a number of passes from (a stream)
AGAIN = 10  # begins a pass of (a loop); if there is none left, goes to (an operation)
# From here on to ANSWER: what can make others more urgent, or wait.
REQUEST = 11  # requests (a semaphore) with (EXCLUSIVE + ACTIVE)
UNLOCK = 12  # releases (a semaphore)
MASK = 13  # keeps everything else off its core from here on
UNMASK = 14  # and lets it in again
FIRE = 15  # fires (a stimulus)
POINT = 16  # a preemption point of a cooperative task
SET_EVENT = 18  # sets (some events)
CLEAR_EVENT = 19  # clears (some events)
WAIT_EVENT = 20  # waits for (some events)
SET_MODE = 21  # sets (a mode label) to (a value)
STEP_MODE = 22  # changes (a mode label) by (a number of steps)
SEND = 23  # puts into (a channel) (a number of elements)
RECEIVE = 24  # takes out of (a channel) (a number of elements)
ASK = 25  # asks for (a runnable)
AWAIT = 26  # waits until (a runnable) has answered, with (ACTIVE)
SERVE = 27  # begins (a runnable) for all that have asked
ANSWER = 28  # ends it
TAKE_MESSAGE = 29  # takes a message out of (a queue) if one has arrived before the activation
NOTE = 30  # an event of (a kind) about (an entity), for the trace
BEGIN_RUNNABLE = 31  # an execution of a runnable at (a site) begins, for the trace
END_RUNNABLE = 32  # and ends
OBSERVE = 33  # (a source) of events that are watched has an occurrence
BEGIN_EXECUTION = 34  # an execution of (a measured runnable) begins
END_EXECUTION = 35  # and ends
TEST_MESSAGE = 36  # if the job has taken no message out of (a queue), goes to (an operation)
ENTER = 40  # (a stage) reads at the start of the job, into its snapshot; if (1), also into its value
TAKE = 41  # (a stage) takes what is there now, or, if (1), what was there at the start
REACH = 42  # a position of (a stage) is reached: (a bit)
MARK = 43  # the stimulus of the chain of (a stage) occurs now, or, if (1), occurred at the activation
PUT = 44  # (a stage) gives away what it has
LEAVE = 45  # the same if the job has reached all positions
PUBLISH = 46  # the same, at the end of the period
RESPOND = (
    47  # the response of the chain of (a stage) occurs now or, if given, at (a time of the job); it counts when all is reached
)

#: Flags of REQUEST and AWAIT.
EXCLUSIVE, ACTIVE = 1, 2

#: The states of a process (BTF 2.3.0, table 2-10); what was activated and has not started is PENDING_START there ACTIVE.
TERMINATED, ACTIVATED, RUNNING, READY, POLLING, PARKING, WAITING = range(7)

#: Why the kernel stops: the occurrences are used up, there is no place for rows, a stream or a queue has to be filled or grown, or a
#: job goes on forever without taking time.
CONTINUE, WINDOW, ROWS_FULL, STREAM_EMPTY, QUEUE_FULL, ENDLESS = range(6)
