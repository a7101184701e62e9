import numpy as np
import pytest
from scipy.integrate._ivp import dop853_coefficients as scipy_coefficients

from frahm.time_integration import coefficients


def table(letter, rows, columns):
    return np.array([[getattr(coefficients, f"{letter}{i}_{j}", 0.0) for j in columns] for i in rows])


A = table("A", range(1, 17), range(1, 17))
C = np.array([0.0] + [getattr(coefficients, f"C{i}") for i in range(2, 17)])
B = A[12, :12]


def test_a_stage_sits_at_the_sum_of_its_weights():
    np.testing.assert_allclose(A.sum(axis=1), C, atol=4e-15)


@pytest.mark.parametrize("power", range(8))
def test_quadrature_conditions_of_order_8(power):
    assert B @ C[:12] ** power == pytest.approx(1 / (power + 1), abs=2e-15)


@pytest.mark.parametrize("power", range(1, 7))
def test_order_conditions_of_the_tall_trees(power):
    # sum b_i a_ij c_j^k = 1 / ((k + 1)(k + 2)) and its bushy neighbour with one more factor c_i.
    inner = A[:12, :12] @ C[:12] ** power
    assert B @ inner == pytest.approx(1 / ((power + 1) * (power + 2)), abs=4e-15)
    if power < 6:
        assert B @ (C[:12] * inner) == pytest.approx(1 / ((power + 1) * (power + 3)), abs=4e-15)


def test_the_comparison_method_has_order_3():
    weights = np.zeros(12)
    weights[[0, 8, 11]] = coefficients.B3_1, coefficients.B3_9, coefficients.B3_12
    for power in range(3):
        assert weights @ C[:12] ** power == pytest.approx(1 / (power + 1), abs=1e-15)


def test_same_numbers_as_scipy():
    np.testing.assert_array_equal(A, scipy_coefficients.A)
    np.testing.assert_array_equal(table("D", range(4, 8), range(1, 17)), scipy_coefficients.D)
    np.testing.assert_array_equal(table("E", [5], range(1, 14))[0], scipy_coefficients.E5)
