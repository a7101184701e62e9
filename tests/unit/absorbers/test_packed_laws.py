import numpy as np
import pytest

import frahm
from frahm.absorbers.packed import law_force, law_force_and_slopes, pack_laws

LAWS = [
    frahm.Cubic(3.0, 0.2),
    frahm.Linear(2.0, -0.1),
    frahm.Polynomial([0.5, -1.0, 0.3, 2.0, -0.7], 0.4),
]


@pytest.mark.parametrize("index", range(len(LAWS)))
def test_packed_law_is_the_law(index):
    codes, table = pack_laws(LAWS)
    law = LAWS[index]
    for z, w in ((0.0, 0.0), (0.7, -0.3), (-1.9, 2.0)):
        force, slope, damping = law_force_and_slopes(*codes[index], table, z, w)
        assert force == pytest.approx(float(law.force(z, w)), rel=1e-14, abs=1e-300)
        assert law_force(*codes[index], table, z, w) == pytest.approx(force, rel=1e-14, abs=1e-300)
        assert slope == pytest.approx(float(law.stiffness(z)), rel=1e-14, abs=1e-300)
        assert damping == law.damping


def test_slopes_agree_with_differences():
    codes, table = pack_laws(LAWS)
    z, w, h = 0.8, 0.4, 1e-6
    for code in codes:
        _, slope, damping = law_force_and_slopes(*code, table, z, w)
        ahead, behind = (law_force(*code, table, z + s, w) for s in (h, -h))
        assert slope == pytest.approx((ahead - behind) / (2 * h), rel=1e-8)
        ahead, behind = (law_force(*code, table, z, w + s) for s in (h, -h))
        assert damping == pytest.approx((ahead - behind) / (2 * h), rel=1e-8)


def test_no_laws_make_an_empty_table_of_codes():
    codes, _ = pack_laws([])
    assert codes.shape == (0, 3)
    assert codes.dtype == np.int64
