import pytest
from ncsim_core.generators.paper import paper_grid
from ncsim_core.testing.builders import make_context
from ncsim_wifi.conflict import relations
from ncsim_wifi.interference_models.csma_clique import CsmaCliqueModel, clique_sizes
from ncsim_wifi.radio import Radio
from ncsim_wifi.validation.scenes import parallel


def factors(network, links):
    return CsmaCliqueModel(make_context(network)).factors(links, links).tolist()


def test_the_share_counts_all_links_of_the_clique_active_or_not():
    network = parallel(4, 20.0).network()

    assert factors(network, [0]) == [0.25]
    assert factors(network, [0, 1, 2, 3]) == [0.25] * 4


def test_a_link_between_two_cliques_has_the_larger():
    assert factors(parallel(3, 50.0).network(), [0, 1, 2]) == [0.5, 0.5, 0.5]


def test_hidden_links_do_not_count():
    assert factors(parallel(3, 80.0).network(), [0, 1, 2]) == [1.0, 1.0, 1.0]


@pytest.mark.parametrize("size", [4, 8])
def test_grids_are_done_at_once(size):
    sizes = clique_sizes(relations(make_context(paper_grid(size)), Radio()))

    assert min(sizes) > 20
