"""The routing models of this package, one per file."""
