# SPDX-License-Identifier: Apache-2.0
"""Settings over a scene's keys, as text of `--set`."""

import json
from typing import Any, Iterable, List, Mapping, Union


def toml_value(value: Any) -> str:
    """Returns a value as TOML writes it."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{key} = {toml_value(part)}" for key, part in value.items()) + " }"
    if hasattr(value, "tolist"):  # numpy's
        return toml_value(value.tolist())
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(toml_value(part) for part in value) + "]"
    return repr(value)


def set_texts(sets: Union[Mapping[str, Any], Iterable[str]]) -> List[str]:
    """Returns "KEY=VALUE" for each of a dict, or of texts that are such already."""
    if isinstance(sets, Mapping):
        return [f"{key}={toml_value(value)}" for key, value in sets.items()]
    texts: List[Any] = list(sets) if isinstance(sets, Iterable) and not isinstance(sets, str) else [None]
    if not all(isinstance(text, str) for text in texts):
        raise TypeError('sets: expected a dict, or a list of "KEY=VALUE"')
    return texts
