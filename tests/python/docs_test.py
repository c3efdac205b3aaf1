# SPDX-License-Identifier: Apache-2.0
"""What the module tells of itself: docstrings that run, and stubs with the same names and signatures."""

import ast
import doctest
import inspect
import pathlib
import re
import unittest

import numpy as np

import tesserae as ts

PACKAGE = pathlib.Path(ts.__file__).parent
IN_PYTHON = {"arguments", "page", "progress", "records", "settings"}  # their annotations stand in the source


def public_members(kind):
    """What a class adds to `object`, by name: special methods only where a user calls them."""
    called = {"__len__", "__iter__", "__contains__", "__getitem__", "__copy__", "__deepcopy__"}
    return {name: value for name, value in vars(kind).items() if not name.startswith("_") or name in called}


def documented():
    """(name, object) of all that has a docstring."""
    yield "tesserae", ts
    yield "tesserae.rotor", ts.rotor
    for name in ts.rotor.__all__:
        yield f"rotor.{name}", getattr(ts.rotor, name)
    for name in ts.__all__:
        value = getattr(ts, name)
        if isinstance(value, type):
            yield name, value
            for member, part in public_members(value).items():
                yield f"{name}.{member}", part


def in_stub(node):
    """(names of positional arguments, of those by name alone, defaults by name) of a function."""
    arguments = node.args
    names = [a.arg for a in arguments.posonlyargs + arguments.args]
    defaults = dict(zip(names[len(names) - len(arguments.defaults):], arguments.defaults))
    for argument, default in zip(arguments.kwonlyargs, arguments.kw_defaults):
        if default is not None:
            defaults[argument.arg] = default
    return names, [a.arg for a in arguments.kwonlyargs], defaults


def is_decorated(node, name):
    return any(ast.unparse(d) == name or ast.unparse(d).endswith(f".{name}") for d in node.decorator_list)


class Docs(unittest.TestCase):
    def test_examples_in_docstrings_run(self):
        examples = 0
        parser = doctest.DocTestParser()
        for name, value in documented():
            doc = value.__doc__ if isinstance(value, type) or inspect.ismodule(value) else inspect.getdoc(value)
            if not doc or ">>>" not in doc:
                continue
            test = parser.get_doctest(doc, {"ts": ts, "np": np}, name, None, 0)
            told = []
            runner = doctest.DocTestRunner(verbose=False, optionflags=doctest.ELLIPSIS)
            runner.run(test, out=told.append)
            self.assertEqual(runner.summarize(verbose=False).failed, 0, f"{name}:\n" + "".join(told))
            examples += len(test.examples)
        self.assertGreater(examples, 60)

    def test_all_that_is_public_has_a_sentence(self):
        for name, value in documented():
            if isinstance(value, type) and issubclass(value, tuple):
                self.assertTrue(value.__doc__.endswith(".") or "." in value.__doc__, name)
                continue
            owner = name.split(".")[0]
            if "__" in name or (isinstance(getattr(ts, owner, None), type) and issubclass(getattr(ts, owner), tuple)):
                continue
            self.assertTrue(value.__doc__ and len(value.__doc__) > 3, name)


    def test_the_manual_shows_all_that_is_public(self):
        page = (pathlib.Path(__file__).resolve().parents[2] / "scenes/manual/python.md").read_text()
        hidden = []
        for name, value in documented():
            member = name.split(".")[-1]
            if member.startswith("__") or name in ("tesserae", "tesserae.rotor"):
                continue
            if not re.search(rf"\b{member}\b", page):
                hidden.append(name)
        self.assertEqual(hidden, [])


class Stubs(unittest.TestCase):
    def compare_function(self, name, node, function):
        if is_decorated(node, "overload"):
            return
        signature = inspect.signature(function)
        names, by_name, defaults = in_stub(node)
        found = signature.parameters
        positional = [p for p in found if found[p].kind in (inspect.Parameter.POSITIONAL_ONLY,
                                                            inspect.Parameter.POSITIONAL_OR_KEYWORD)]
        self.assertEqual(positional, names, name)
        self.assertEqual([p for p in found if found[p].kind == inspect.Parameter.KEYWORD_ONLY], by_name, name)
        for parameter in positional + by_name:
            default = found[parameter].default
            self.assertEqual(default is not inspect.Parameter.empty, parameter in defaults, f"{name}: {parameter}")
            if parameter in defaults and not ast.unparse(defaults[parameter]) == "...":
                self.assertEqual(ast.literal_eval(defaults[parameter]), default, f"{name}: {parameter}")

    def compare_class(self, name, node, kind):
        members = public_members(kind)
        told = {}
        for part in node.body:
            if isinstance(part, ast.FunctionDef) and part.name != "__init__":
                told.setdefault(part.name, part)
            elif isinstance(part, ast.AnnAssign):
                told[part.target.id] = part
            elif isinstance(part, ast.FunctionDef):
                self.compare_function(f"{name}.__init__", part, kind.__init__)
        if name in ("InputError", "RunError"):
            return
        missing = {m for m in members if m not in told and not m.startswith("_repr")}
        self.assertEqual(missing, set(), f"{name}: not in the stub")
        self.assertEqual({t for t in told if not hasattr(kind, t)}, set(), f"{name}: only in the stub")
        for member, part in told.items():
            value = vars(kind).get(member)
            if isinstance(part, ast.AnnAssign) or is_decorated(part, "property"):
                self.assertIsInstance(value, property, f"{name}.{member}")
                settable = isinstance(part, ast.AnnAssign) or any(
                    isinstance(p, ast.FunctionDef) and p.name == member and is_decorated(p, "setter") for p in node.body)
                self.assertEqual(value.fset is not None, settable, f"{name}.{member}")
            elif not member.startswith("__"):
                self.assertEqual(isinstance(value, staticmethod), is_decorated(part, "staticmethod"), f"{name}.{member}")
                self.compare_function(f"{name}.{member}", part, getattr(kind, member))

    def test_stubs_have_the_names_and_signatures_of_the_module(self):
        tree = ast.parse((PACKAGE / "__init__.pyi").read_text())
        classes = {n.name: n for n in tree.body if isinstance(n, ast.ClassDef)}
        imported = {a.asname for n in tree.body if isinstance(n, ast.ImportFrom) for a in n.names if a.asname}
        self.assertEqual(set(ts.__all__) - imported - set(classes), set(), "not in the stub")
        for name, node in classes.items():
            if name in ts.__all__:
                self.compare_class(name, node, getattr(ts, name))
            else:
                self.assertEqual([ast.unparse(b) for b in node.bases], ["TypedDict"], name)

    def test_stubs_of_rotors_have_their_signatures(self):
        tree = ast.parse((PACKAGE / "rotor.pyi").read_text())
        functions = {n.name: n for n in tree.body if isinstance(n, ast.FunctionDef)}
        self.assertEqual(set(functions), set(ts.rotor.__all__))
        for name, node in functions.items():
            self.compare_function(name, node, getattr(ts.rotor, name))

    def test_every_module_is_typed(self):
        self.assertTrue((PACKAGE / "py.typed").exists())
        sources = {p.stem for p in PACKAGE.glob("*.py")}
        self.assertEqual((sources - IN_PYTHON) | {"_tesserae"}, {p.stem for p in PACKAGE.glob("*.pyi")})


if __name__ == "__main__":
    unittest.main()
