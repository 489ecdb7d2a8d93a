"""Schedulers that plan with the conflict graph in mind."""
