"""SAGA's static DAG schedulers for ncsim."""
