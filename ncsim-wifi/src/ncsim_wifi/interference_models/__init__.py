"""How concurrent traffic slows wireless links."""
