"""The six extension points of ncsim, one abstract base class per file.

Plug-ins answer questions about their arguments: same arguments, same answer. They never see
engine state, schedule events, read a clock or draw from a global generator.
"""
