"""HEFT and CPOP without SAGA, giving SAGA's placements to the last tie.

Both algorithms: H. Topcuoglu, S. Hariri, M.-Y. Wu, "Performance-effective and low-complexity
task scheduling for heterogeneous computing", https://doi.org/10.1109/71.993206. Where that
leaves a choice, SAGA's is taken: averages over all virtual links in both directions and the
nodes themselves, ties by the order in which SAGA walks its sets (``ncsim_saga.hash_order``), and
every sum in the order and grouping of numpy's, because a last bit decides a tie.
"""
