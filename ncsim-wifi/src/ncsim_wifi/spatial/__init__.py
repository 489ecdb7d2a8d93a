"""Saturated goodput of any set of active links: sensing, capture, hidden stations, back-off."""
