# SPDX-License-Identifier: Apache-2.0
"""What progress=True shows: a line on standard error that is written over."""

import sys


class Line:
    """Is called with how far work is."""

    def __call__(self, done: int, total: int) -> None:
        sys.stderr.write(f"\r{done} of {total}" + ("\n" if done >= total else ""))
        sys.stderr.flush()
