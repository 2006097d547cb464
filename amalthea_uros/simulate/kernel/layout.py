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
PROCESSES, PROCESSES_END, SEMAPHORES, SEMAPHORES_END, HAS_WRITES = range(22, 27)
# The message that is handed over, the first one that is free, how many values each carries, and what occurs at planned times.
MESSAGE, FREE_MESSAGES, CARRIED_VALUES, ALARMS, ALARMS_END, HEAD = range(27, 33)

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
IS_CHOSEN, WATCHED, GROUP = range(56, 59)
# The message that its job is about, when that gets to the host, what it is writing, with what it reads, and until when it has waited.
IS_ABOUT_MESSAGE, ITS_MESSAGE, AT_HOST, WRITES_TO, WRITE_TICKET, READS_WITH, WAITED_UNTIL, PROCESS_SIZE = range(59, 67)

#: A place in the queue of activations of a process: time, number, place in the order of all activations, and a value for each capture.
QUEUE_TIME, QUEUE_INSTANCE, QUEUE_SEQUENCE, QUEUE_CAPTURES = range(4)

# A core.
STOP, BEGIN, RUNS, NEEDS_STEP, BUSY, CHOSEN, CORE_NUMBER, CORE_ENTITY, CORE_DOMAIN, CORE_SIZE = range(10)

# A domain: cores that share processes; RAISED of them have another level than their own, PRESENT have a job. GROUPS is a list: how many
# have one of the first GROUP_OF_MEMBERS, of the next ones, and so on.
IS_DUE, RAISED, PRESENT, HAS_COOPERATIVE, MEMBERS, MEMBERS_END, GROUPS, ITS_CORES, ITS_CORES_END, DOMAIN_SIZE = range(10)
GROUP_OF_MEMBERS = 16

# A stimulus; an assignment is (mode label, value). What is watched is the number of a source of events plus 1, or 0.
TARGETS, TARGETS_END, CONDITION, COUNTER, ASSIGNMENTS, ASSIGNMENTS_END = range(6)
OCCURRENCES, STIMULUS_ENTITY, MESSAGES, STIMULUS_SOURCE, BRINGS, STIMULUS_SIZE = range(6, 12)

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

# What occurs at a planned time: the next iteration of an executor, the end of a wait, what a delay line gives away, or the agent looks
# whether it misses acknowledgements of a flow, or timers of an executor of the host expire into its queue.
ALARM_AT, ALARM_KIND, ALARM_OF, ALARM_SIZE = range(4)
NEXT_ITERATION, END_OF_WAIT, DELAY_LINE, AGENT_ASKS, HOST_TIMERS = range(5)

# A message, from its sender to where it waits. What is sent of a reliable message is a copy of it, with its parts (bits) that have not
# been lost; others are one part. An acknowledgement or a heartbeat is about a flow.
NEXT_MESSAGE, BORN, DUE, SENT_AS, ORIGINAL, PARTS_IN_IT, ABOUT = range(7)
# A reliable message: its first part in the flow, the number of its copies and of lists that it is in, whether it has been on the wire.
FIRST_PART, USES, HAS_BEEN_SENT = range(7, 10)
# An acknowledgement: the first part that is missing, and bits of those from there on that are. A heartbeat: the part after the last one
# (0: it is none). Carried values follow.
UP_TO, MISSING, ANNOUNCED_TO, CARRIED = range(10, 14)

# A delay line: messages in their order, each with the time at which it comes out. As what it sends the messages that begin there.
FIRST_MESSAGE, LAST_MESSAGE, DELAY, ITS_ALARM, LEADS_TO, CREATES, LINE_SIZE = range(7)
TO_RECEIVER, TO_WIRE, TO_AGENT_ITSELF, TO_HOST_QUEUE = range(4)

# A flow: the reliable messages of a session in one direction. Those that are not acknowledged, and those that the agent holds back.
SENT_FIRST, SENT_LAST, HELD_FIRST, HELD_LAST = range(4)
# Its sender: the number of the next part, of the first one that is not acknowledged, and how many may be sent from there on.
NEXT_PART, UNACKNOWLEDGED, SEND_ROOM = range(4, 7)
# Its receiver: the first part that is missing, bits of those from there on that have arrived, the part after the last known one, for
# how many there is room, the part up to which messages are handed over, and where they are read.
EXPECTED, ARRIVED_PARTS, KNOWN_TO, RECEIVE_ROOM, HANDED_OVER, FLOW_INBOX = range(7, 13)
# Who misses an acknowledgement asks: as which message, whether the time runs, when, and after which time. The line on which the agent
# sends again.
ASKS_AS, IS_ASKING, ASKS_AT, ASKS_AFTER, SENT_AGAIN_ON, FLOW_SIZE = range(13, 19)

# Losses: values that decide, how many in which time (0: a value for each message), when the last ones were, which is the oldest, when
# the next one can be, and how many messages get through then before. The stimulus that stands for them in a trace, and their number.
LOSS_VALUES, LOSS_COUNT, LOSS_WINDOW, LOSS_TIMES, LOSS_INDEX, NEXT_LOSS, PASSING, LOSS_ENTITY, LOSS_NUMBER, LOSSES_SIZE = range(
    10
)

# A message on a wire. The stimulus of its task, the line to the controller, the stimulus of the first process that receives it.
WIRE_STIMULUS, LINE_IN, RECEIVED_BY = range(3)
# Where it waits to be read, for which handle, and what the reader writes in return, how often.
READ_FROM, FOR_HANDLE, REPLY_WITH, REPLIES = range(3, 7)
# How often it was written and was on the wire; whether who writes it waits for that.
WRITTEN, DONE_WRITING, HOLDS_WRITER = range(7, 10)
# The time to the host, the lines on which the agent sends it back, and what it carries: places from which values come, and to which.
TO_HOST, RELAYS, RELAYS_END, STAMPS_FROM, STAMPS_FROM_END, STAMPS_TO, STAMPS_TO_END = range(10, 17)
# The flow to which it belongs if it is reliable, and the number of its parts.
FLOW, PARTS_OF = range(17, 19)
# What loses it, how often that was, how often it was sent again; stages of which it keeps the values, and that respond at the host.
LOSES, LOSES_END, LOST_ON_WIRE, SENT_AGAIN = range(19, 23)
KEEPS, KEEPS_END, RESPONSES, RESPONSES_END = range(23, 27)
# Its delays on the line to the controller, which messages of a wire share, as none overtakes another one. When the host had the last
# one that went there.
DELAY_IN, LAST_AT_HOST, TRANSMISSION_SIZE = range(27, 30)

# Where messages wait to be read, and how many are kept for callbacks of at most so many.
UNREAD_FIRST, UNREAD_LAST, KEPT, SLOTS, INBOX_SIZE = range(5)

# A publication: its timeout, how often that passed; whether there was no room for the message, and how often.
TIMEOUT_AFTER, TIMEOUTS, IS_REFUSED, REFUSALS, ANSWERED_BY, IS_ANSWERED, PUBLICATION_SIZE = range(7)

# What an executor reads and waits with: its process, the messages, the timeout of its wait, to what it is cut, and how many messages
# end it (0: all that are there).
READER_PROCESS, INBOX, WAIT_TIMEOUT, RESOLUTION, MESSAGES_PER_WAIT, KEPT_END_WAIT, FLAGS_END_WAIT = range(7)
NO_MESSAGE = -1
# Its wait or publication: how long, until when, for which publication (0: for data), what it has read, and what it has to acknowledge.
WAIT_FOR, WAIT_END, AWAITED, DATA_READ, REPLIES_LEFT, REPLY_AS, REPLY_ABOUT, WAIT_ALARM = range(7, 15)
# What it sends reliably, and which parts of that it sends again. Whether it listens, for how long altogether, and until when.
OUT_FLOW, AGAIN_FROM, AGAIN_TO, LISTENING, LISTENS_FOR, LISTENS_UNTIL = range(15, 21)
NOT_LISTENING, BEGINS_TO_LISTEN, HAS_ASKED, LISTENS = range(4)
# Its handles, and sets of them: it calls if all of one set are ready.
HANDLES, HANDLES_END, TRIGGER_SETS, TRIGGER_SETS_END, IS_TRIGGERED = range(21, 26)
# Its loop: a stream of sleeps, the least distance of their ends, the last end, a period, the time up to which it has planned, to what
# that sleep is cut, and what begins the next iteration of its thread; the process of that, its own or of another executor.
SLEEPS, PACE, LAST_WAKE, LOOP_PERIOD, INVOCATION, SLEEP_RESOLUTION, LOOP_STIMULUS, LOOP_ALARM = range(26, 34)
NEXT_PROCESS = 34
# If it is a thread of an executor of the host: that one, which handle it calls, and when that was released.
THREAD_OF, CALLED_HANDLE, CALLED_SINCE, EXECUTOR_SIZE = range(35, 39)

# An executor of the host: how it works, its handles in the order of the ready set, its threads (records of executors), a queue of
# events, what lets timers expire into it, and whether timers of busy groups stay in the ready set.
WORKS_BY, READY_HANDLES, READY_HANDLES_END, ITS_THREADS, ITS_THREADS_END = range(5)
EVENT_FIRST, EVENT_LAST, EXPIRES_WITH, KEEPS_TIMERS, HOST_EXECUTOR_SIZE = range(5, 10)
READY_SET, FIRST_READY, EVENT_QUEUE = range(3)

# A publication of the host: its line, and values that the message carries: (place, index).
PUBLISHES_ON, PUBLISHED_STAMPS, PUBLISHED_STAMPS_END, HOST_PUBLICATION_SIZE = range(4)

# A handle: a timer is due at a time and every period, an item of a loop a period after its last call at the earliest; of the others,
# messages are kept, or a flag was set at a time.
HANDLE_KIND, NEXT_CALL, TIMER_PERIOD, KEPT_FIRST, KEPT_LAST, KEPT_NUMBER, DEPTH, OVERWRITES = range(8)
IS_ALWAYS_CALLED, IS_READY, RELEASED, LOST_CALLS, CALLS, HANDLE_STAMPS, HANDLE_STAMPS_END = range(8, 15)
# On the host: its executor, its place among the callbacks, and a word that is 1 while its group executes (0: no group matters).
HANDLE_OF, HANDLE_INDEX, ITS_GROUP, HANDLE_SIZE = range(15, 19)
TIMER, RECEIVER, FLAG, ITEM = range(4)

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
DEFERRABLE, POLLING_SERVER, SPORADIC, CONSTANT_BANDWIDTH, THROTTLED_BANDWIDTH = range(5)

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
BEFORE_PARKING, BEFORE_PREEMPTIONS, BEFORE_MIGRATIONS, ASKED_AT, EXECUTION_SIZE = range(5, 10)

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
FIRE = 15  # fires (a stimulus), with (1) or without the message of the job
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
# Of executors that loop, and of messages.
LISTEN = 40  # (an executor) decides how long it waits for data
BEGIN_WAIT = 41  # (an executor) begins to wait for data
EXPECT = 42  # (an executor) begins to wait for the acknowledgements of (a publication)
READ = 43  # (an executor) reads a message, or waits for one; when it has what it waits for, or its time is over, goes to (an operation)
REPLY = 44  # (an executor) acknowledges what it has read; if there is nothing to acknowledge, goes to (an operation)
BEGIN_ITERATION = 45  # (an executor) has waited; its job counts from here
CHECK = 46  # (an executor) looks what is ready, and whether its trigger condition is true
TEST_TRIGGER = 47  # if that was false for (an executor), goes to (an operation)
TEST_READY = 48  # if (a handle) is not to be called, goes to (an operation)
TEST_DATA = 49  # if (a handle) has nothing to take, goes to (an operation)
TAKE_DATA = 50  # takes the data of (a handle)
WRITE = 51  # writes (a message), and waits until it is on the wire if it holds the writer; for (a publication), or 0
PLAN_ITERATION = 52  # plans the next iteration of (an executor)
DEPART = 53  # (a message) leaves the wire: decides when it gets to the host
PASS_ON = 54  # (a message) has left the wire
HAVE_READ = 55  # what the job is about waits to be read from now on
PART_ARRIVES = 56  # the agent has received, if it is not lost, the part with (a number), and acknowledges it on (a line)
POST = 57  # writes (a message), and continues
ARRIVE = 58  # decides whether (a message) is lost on the wire
TEST_PART = 59  # if the message does not contain the part with (a number), goes to (an operation)
TEST_ARRIVED = 60  # if the message is lost, goes to (an operation)
KEEP_VALUES = 61  # (a message) keeps the values of chains, for when it is sent again
RESTORE_VALUES = (
    62  # if (a message) has been sent before, the values are those that it has kept, and the job goes to (an operation)
)
# Of threads of the host.
CALL_NEXT = (
    63  # (a thread) takes what it calls next, or waits, and goes to the operation of the callback in a table at (a place)
)
HOST_PUBLISH = 64  # publishes on the host with (a publication)
HAVE_CALLED = 65  # (a thread) has called: its group is free
TRY_AGAIN = 66  # if (a publication) is answered, goes to (an operation); otherwise, it has not timed out yet
ENTER = 70  # (a stage) reads at the start of the job, into its snapshot; if (1), also into its value
TAKE = 71  # (a stage) takes what is there now, or, if (1), what was there at the start
REACH = 72  # a position of (a stage) is reached: (a bit)
MARK = 73  # the stimulus of the chain of (a stage) occurs now, or occurred (1) at the activation, (2) when the message was sent
PUT = 74  # (a stage) gives away what it has
LEAVE = 75  # the same if the job has reached all positions
PUBLISH = 76  # the same, at the end of the period
RESPOND = (
    77  # the response of the chain of (a stage) occurs now or, if given, at (a time of the job); it counts when all is reached
)

#: Flags of REQUEST and AWAIT.
EXCLUSIVE, ACTIVE = 1, 2

#: The states of a process (BTF 2.3.0, table 2-10); what was activated and has not started is PENDING_START there ACTIVE.
TERMINATED, ACTIVATED, RUNNING, READY, POLLING, PARKING, WAITING = range(7)

#: Why the kernel stops: the occurrences are used up, there is no place for rows, a stream or a queue has to be filled or grown, a
#: job continues forever without taking time, or there is no record for one more message.
CONTINUE, WINDOW, ROWS_FULL, STREAM_EMPTY, QUEUE_FULL, ENDLESS, NO_MESSAGES = range(7)
