"""Thresholds that mean the same in several rooms, each with its reason."""

from __future__ import annotations

# The same motion found twice, with its peak seen over another window or read between two points of a curve, differs by
# less than a hundredth: of two sizes one is larger than the other from here on.
AS_LARGE = 1.01

# A beat can lock to the forcing in several ways: modulated motions whose peaks and rms differ by less, relative to the
# larger one, are one attractor.
ALIKE = 0.02

# A design is better than another only if its value is below this share of the other's: what is nearer is the search.
NO_BETTER = 0.995

# Keeps a quotient or a logarithm finite where what it is taken of vanishes, and changes nothing else.
TINY = 1e-300
