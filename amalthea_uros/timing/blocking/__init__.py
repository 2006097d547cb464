"""Where jobs keep others from executing."""
