"""The law passes what any law must: the whole battery, some minutes."""

from generalised_maxwell_slip import GeneralisedMaxwellSlip

from frictionlab.testing import check_law


def test_the_law_conforms():
    check_law(GeneralisedMaxwellSlip)
