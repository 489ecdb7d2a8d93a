"""IEEE 802.11 link rates, contention and hidden terminals for ncsim."""
