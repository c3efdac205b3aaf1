# SPDX-License-Identifier: Apache-2.0
"""What is wrong with the arguments of a call that was refused, as one line."""

import difflib
import inspect
import re
import reprlib
from typing import Any, Callable, Dict, Iterable, List, Optional, Tuple

#: What is expected where the module's functions take a type of C++.
_WORDS = {"bool": "True or False", "float": "a number", "int": "an integer", "str": "a string"}
_INTEGERS = re.compile(r"[Ll]ist\[int(?:\[(\d+)\])?\]")
#: What newer versions of pybind11 call a type.
_OTHER_NAMES = {"Union[os.PathLike, str, bytes]": "os.PathLike", "typing.SupportsFloat": "float", "typing.SupportsInt": "int"}


def _is_of(value: Any, kind: str) -> bool:
    """Returns whether a value may be meant by a type as pybind11 calls it; True if that is not known."""
    optional = re.fullmatch(r"Optional\[(.*)\]", kind)
    if optional:
        return value is None or _is_of(value, optional[1])
    if kind == "float":
        return hasattr(value, "__float__") or hasattr(value, "__index__")
    if kind == "int":
        return hasattr(value, "__index__") and -(2**31) <= value.__index__() < 2**31
    if kind == "str":
        return isinstance(value, str)
    if kind == "bool":
        return isinstance(value, bool) or type(value).__name__ in ("bool_", "bool")
    if kind == "os.PathLike":
        return isinstance(value, (str, bytes)) or hasattr(value, "__fspath__")
    integers = _INTEGERS.fullmatch(kind)
    if integers:
        if not hasattr(value, "__iter__") or integers[1] and len(list(value)) != int(integers[1]):
            return False
        return all(_is_of(part, "int") for part in value)
    if kind.startswith("tesserae."):
        return any(base.__name__ == kind.split(".")[-1] for base in type(value).__mro__)
    return True


def _expected(kind: str) -> str:
    """Returns a type as pybind11 calls it in words."""
    optional = re.fullmatch(r"Optional\[(.*)\]", kind)
    if optional:
        return _expected(optional[1]) + ", or None"
    integers = _INTEGERS.fullmatch(kind)
    if integers:
        return f"{integers[1]} integers" if integers[1] else "a list of integers"
    if kind.startswith("tesserae."):
        return "a " + kind.split(".")[-1]
    return _WORDS.get(kind, "a path" if kind == "os.PathLike" else kind)


def _hint(name: str, known: Iterable[str]) -> str:
    """Returns which names may have been meant."""
    names = list(known)
    near = difflib.get_close_matches(name, names, n=2)
    if near:
        return "did you mean " + " or ".join(repr(one) for one in near) + "?"
    return "expected " + (", ".join(names) if names else "none by name")


def _signature_of(function: Callable[..., Any]) -> Optional[inspect.Signature]:
    """Returns the signature of a function; None for what sets a property."""
    try:
        return inspect.signature(function)
    except ValueError:
        return None


def _given(told: str, args: Tuple[Any, ...], kwargs: Dict[str, Any]) -> List[Tuple[str, str, Any]]:
    """Returns name, type and value of the arguments, by the signature in what pybind11 has told."""
    first = told.split("\n", 2)[1].replace("::", ".")  # of a class that was added later
    for other, kind in _OTHER_NAMES.items():
        first = first.replace(other, kind)
    first = re.sub(r"Annotated\[list\[int\], FixedSize\((\d+)\)\]", r"List[int[\1]]", first)
    found = re.findall(r"(\w+): ([\w.]+(?:\[[^\]]*\]+)?)( = None)?", first)
    types = [(name, f"Optional[{kind}]" if default and not kind.startswith("Optional") else kind) for name, kind, default in found]
    if "incompatible constructor" in told:
        args = args[1:]
    positional = [(name, kind, value) for (name, kind), value in zip(types, args)]
    return positional + [(name, kind, kwargs[name]) for name, kind in types if name in kwargs]


def complaint(name: str, function: Callable[..., Any], told: str, args: Tuple[Any, ...],
              kwargs: Dict[str, Any]) -> str:
    """Returns what is wrong with the arguments of a function.

    `name` is that by which the function is reached, `told` what pybind11 says.
    """
    signature = _signature_of(function)
    if signature is not None:
        known = [p for p in signature.parameters if p != "self"]
        takes_any = any(p.kind is inspect.Parameter.VAR_KEYWORD for p in signature.parameters.values())
        for key in kwargs:
            if key not in known and not takes_any:
                return f"{name}(): there is no argument {key!r}; {_hint(key, known)}"
        try:
            signature.bind(*args, **kwargs)
        except TypeError as error:
            return f"{name}(): {error}"
    given = _given(told, args, kwargs)
    for argument, kind, value in given:
        if not _is_of(value, kind):
            what = name if argument.startswith("arg") else f"{name}(): {argument}"  # arg1 of a property
            return f"{what} = {reprlib.repr(value)}: expected {_expected(kind)}"
    for argument, kind, value in given:
        if kind == "int" and value < 0:  # of those that are right where they may be negative
            return f"{name}(): {argument} = {value}: expected an integer >= 0"
    return f"{name}(): an argument has a wrong type; its docstring tells what is expected"
