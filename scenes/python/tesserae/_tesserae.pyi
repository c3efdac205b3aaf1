# SPDX-License-Identifier: Apache-2.0
from typing import Any

from . import Hyperplane as Hyperplane
from . import World as World

def _unit_plane(normal: Any, offset: float) -> Hyperplane: ...
