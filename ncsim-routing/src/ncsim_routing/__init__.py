"""Widest-path, minimum-hop and shortest-path routing for ncsim."""
