"""The law passes what any law must: the whole battery, some minutes."""

from bouc_wen import BoucWen

from frictionlab.testing import check_law


def test_the_law_conforms():
    check_law(BoucWen)
