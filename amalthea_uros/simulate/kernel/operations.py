"""The operations of programs, the states of processes, and the reasons for which the kernel stops.

An operation has two arguments, in parentheses here; "goes to" means the place of another operation.
"""

from __future__ import annotations

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
POINT = 16  # lets others go first
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
