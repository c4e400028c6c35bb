"""Law passes what any law must: the whole battery, some minutes."""

from gonthier import Gonthier
from profiles import deep

from frictionlab.testing import check_law


@deep("the whole battery takes minutes")
def test_the_law_conforms():
    check_law(Gonthier)
