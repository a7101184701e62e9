"""Small dense linear algebra for compiled loops."""

from __future__ import annotations

from frahm.compiled import kernel

_WIDTH = 4  # columns eliminated together: every entry behind them is then fetched and put back once for four


@kernel
def factorise(A, pivots, n):
    """LU factors of the leading n x n block of A in place, with partial pivoting; returns whether it is regular."""
    for first in range(0, n, _WIDTH):
        end = min(first + _WIDTH, n)
        for k in range(first, end):
            best, row = abs(A[k, k]), k
            for i in range(k + 1, n):
                if abs(A[i, k]) > best:
                    best, row = abs(A[i, k]), i
            pivots[k] = row
            if not best > 0.0:
                return False
            if row != k:
                for j in range(n):
                    A[k, j], A[row, j] = A[row, j], A[k, j]
            inverse = 1.0 / A[k, k]
            for i in range(k + 1, n):
                factor = A[i, k] * inverse
                A[i, k] = factor
                for j in range(k + 1, end):
                    A[i, j] -= factor * A[k, j]
        for k in range(first, end):
            for i in range(k + 1, end):
                factor = A[i, k]
                for j in range(end, n):
                    A[i, j] -= factor * A[k, j]
        for i in range(end, n - 1, 2):  # only where there are columns behind, so that these are four
            a, b, c, d = A[i, first], A[i, first + 1], A[i, first + 2], A[i, first + 3]
            e, f, g, h = A[i + 1, first], A[i + 1, first + 1], A[i + 1, first + 2], A[i + 1, first + 3]
            for j in range(end, n):
                p, q, r, s = A[first, j], A[first + 1, j], A[first + 2, j], A[first + 3, j]
                A[i, j] -= a * p + b * q + c * r + d * s
                A[i + 1, j] -= e * p + f * q + g * r + h * s
        if (n - end) % 2 == 1:
            a, b, c, d = A[n - 1, first], A[n - 1, first + 1], A[n - 1, first + 2], A[n - 1, first + 3]
            for j in range(end, n):
                A[n - 1, j] -= a * A[first, j] + b * A[first + 1, j] + c * A[first + 2, j] + d * A[first + 3, j]
    return True


@kernel
def solve_factorised(A, pivots, n, b):
    """Solve with the factors of `factorise`, in place in b."""
    for k in range(n):
        row = pivots[k]
        if row != k:
            b[k], b[row] = b[row], b[k]
    for k in range(n):
        for i in range(k + 1, n):
            b[i] -= A[i, k] * b[k]
    for k in range(n - 1, -1, -1):
        for j in range(k + 1, n):
            b[k] -= A[k, j] * b[j]
        b[k] /= A[k, k]
