"""What is measured in traces of events, in CAN logs with markers, and in tables of values."""
