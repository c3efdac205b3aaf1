# SPDX-License-Identifier: Apache-2.0
"""Pages to look around in, as `tesserae view` makes them."""

import html as _html
import os
from typing import Sequence, Union

import numpy as np
import numpy.typing as npt

_SCENE = """\
camera = {{ position = {position}, look_at = {centre}, field_of_view = 40 }}
light = [
    {{ type = "sun", direction = [0.6, -1, 0.5, 0.2], strength = 3 }},
    {{ type = "sky", color = [0.6, 0.75, 1], strength = 0.6 }},
]
body = [{{ shape = "hypersphere", radius = 1 }}]
"""


def scene_around(centres: Sequence[npt.NDArray[np.float64]], radii: Sequence[float]) -> str:
    """Returns the text of a scene whose camera sees balls at these centres, in a slice that passes
    as near to w = 0 as they are. Its body stands for those of a world."""
    low, high = np.full(4, -1.0), np.full(4, 1.0)
    if len(radii) > 0:
        points, sizes = np.array(centres), np.array(radii)[:, None]
        low, high = (points - sizes).min(axis=0), (points + sizes).max(axis=0)
    centre = (low + high) / 2
    centre[3] = min(max(0.0, low[3]), high[3])
    away = np.linalg.norm((high - low)[:3]) / 2 / np.sin(np.radians(18))
    position = centre + away * np.array([0.25, 0.35, -0.9, 0])
    return _SCENE.format(position=position.tolist(), centre=centre.tolist())


class Page:
    """A self-contained page that shows bodies in a browser or a notebook.

    A notebook shows it where it is the value of a cell. `height` is that of its frame there [pixels].
    """

    def __init__(self, html: str, height: int = 480) -> None:
        self.html = html
        self.height = height

    def save(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """Writes the page as a file to be opened in a browser."""
        with open(path, "w", encoding="utf-8") as file:
            file.write(self.html)

    def _repr_html_(self) -> str:
        return (
            f'<iframe srcdoc="{_html.escape(self.html)}" style="width: 100%; height: {self.height}px; border: 0" '
            "allowfullscreen></iframe>"
        )

    def __repr__(self) -> str:
        return f"<Page: {len(self.html.encode())} bytes>"
