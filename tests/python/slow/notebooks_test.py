# SPDX-License-Identifier: Apache-2.0
"""The notebooks run from top to bottom; what they show is asserted in them."""

import importlib.util
import pathlib
import unittest

NOTEBOOKS = pathlib.Path(__file__).resolve().parents[3] / "scenes/python/notebooks"
NEEDED = ("nbclient", "nbformat", "ipykernel", "matplotlib")


class Notebooks(unittest.TestCase):
    def run_notebook(self, name):
        missing = [module for module in NEEDED if importlib.util.find_spec(module) is None]
        if missing:
            self.skipTest("not installed: " + ", ".join(missing))
        import nbformat
        from nbclient import NotebookClient

        notebook = nbformat.read(NOTEBOOKS / f"{name}.ipynb", as_version=4)
        self.assertTrue(all(not cell.get("outputs") for cell in notebook.cells), "stored with outputs")
        NotebookClient(notebook, timeout=600, kernel_name="python3").execute()
        kinds = [kind for cell in notebook.cells for output in cell.get("outputs", []) for kind in output.get("data", {})]
        self.assertIn("image/png", kinds, "no plot")

    def test_top(self):
        self.run_notebook("top")

    def test_error_against_time(self):
        self.run_notebook("error_against_time")

    def test_scaling(self):
        self.run_notebook("scaling")

    def test_all_are_run(self):
        names = {path.stem for path in NOTEBOOKS.glob("*.ipynb")}
        self.assertEqual(names, {name[5:] for name in dir(self) if name.startswith("test_")} - {"all_are_run"})


if __name__ == "__main__":
    unittest.main()
