"""What can be computed of a system: demand, load, response times, verdicts; each number with its method and what it claims.

Times are whole picoseconds; what is rounded is rounded outwards. Each method stands in a file of its own, named by the field's terms.
"""
