"""Simulates DAG workflows on networked compute nodes: contracts, event engine, scenarios, CLI."""
