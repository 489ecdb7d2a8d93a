"""Plans one task ahead and counts hops."""
