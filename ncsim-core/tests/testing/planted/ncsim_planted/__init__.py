"""Components that are each wrong in one way: one for every check of the conformance kit."""
