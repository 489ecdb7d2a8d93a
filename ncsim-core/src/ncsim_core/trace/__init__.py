"""What a run leaves behind: writing, reading, checking, showing and exporting traces.

A trace is one JSON object per line: a header with the tables of nodes and links, one record per
event with whole microseconds and whole-number ids, and a final ``done``. The sequence number of
a record is its line number. Equal inputs give equal bytes.
"""
