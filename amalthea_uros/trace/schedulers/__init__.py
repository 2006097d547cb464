"""Logs of schedulers of operating systems: from what they record of threads and interrupts to the events of jobs."""
