"""Traces in the forms that other tools read; each is made from the tables of a run."""
