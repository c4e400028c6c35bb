"""Laws pass what any law must: the whole battery, some minutes."""

import pytest
from ambrosio import Ambrosio
from bengisu_akay import BengisuAkay
from brown_mcphee import BrownMcphee
from makkar import Makkar
from profiles import deep
from threlfall import Threlfall

from frictionlab.testing import check_law


@deep("the whole battery takes minutes")
@pytest.mark.parametrize("law", [Threlfall, BengisuAkay, Ambrosio, BrownMcphee, Makkar])
def test_the_law_conforms(law):
    check_law(law)
