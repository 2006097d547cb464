"""Pictures as SVG text, from plain data: Gantt charts, histograms, state timelines.

They need no library and nothing outside of themselves, follow the colour scheme of the reader, and can be printed. The data are
independent of where they come from, so that analysis, simulation and measured traces have the same pictures.
"""
