"""A folder of runs and studies in the browser, on this machine only: ``docs/viewer-api.md``."""
