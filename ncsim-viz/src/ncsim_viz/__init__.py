"""Reports and a live viewer for ncsim runs."""
