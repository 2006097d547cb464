"""Analysis of a system: load, response times, latencies of chains, verdicts; each number has a method and a claim.

Times are integer picoseconds, rounded outwards. Each method is in its own file.
"""
