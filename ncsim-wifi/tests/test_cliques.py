from itertools import combinations

from hypothesis import given
from hypothesis import strategies as st
from ncsim_wifi.cliques import largest_clique_sizes


def edges_among(n):
    pairs = [(a, b) for a in range(n) for b in range(a)]
    return st.tuples(st.just(n), st.sets(st.sampled_from(pairs)) if pairs else st.just(set()))


GRAPHS = st.integers(1, 8).flatmap(edges_among)


@given(GRAPHS)
def test_sizes_are_those_of_trying_all_sets(graph):
    n, edges = graph
    neighbours = [sum(1 << b for b in range(n) if {(a, b), (b, a)} & edges) for a in range(n)]
    cliques = [
        chosen
        for size in range(1, n + 1)
        for chosen in combinations(range(n), size)
        if all(neighbours[a] >> b & 1 for a, b in combinations(chosen, 2))
    ]

    expected = [max(len(clique) for clique in cliques if vertex in clique) for vertex in range(n)]

    assert largest_clique_sizes(neighbours) == expected


def test_a_hundred_vertices_all_joined_are_one_clique():
    everyone = (1 << 100) - 1

    assert largest_clique_sizes([everyone & ~(1 << i) for i in range(100)]) == [100] * 100


def test_no_vertices_no_cliques():
    assert largest_clique_sizes([]) == []
