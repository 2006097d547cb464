"""Additional rules of the Timing Architects tools, under their original ids."""
