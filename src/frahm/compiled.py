"""How frahm compiles: one decorator, so that flags and caching are the same everywhere."""

from __future__ import annotations

from typing import Any

import numba

# Contraction to fused multiply-add is allowed; NaN and infinity keep their meaning, because a NaN is how a kernel
# says "there is no such root".
_FLAGS = {"contract", "nsz", "arcp"}

kernel: Any = numba.njit(cache=True, nogil=True, error_model="numpy", fastmath=_FLAGS)
