# SPDX-License-Identifier: BSL-1.0
"""docs/site/build.sh makes a site of pages and comments, and refuses each mistake that is planted in them.
Tier 1: tests/docs has links, quotes and citations."""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

root = Path(__file__).resolve().parents[3]
files = {
    "README.md": "# small\n\nSee [all pages](docs/README.md) and [a part](docs/page.md#a-part).\n",
    "docs/README.md": "# All\n\n## Start\n\n- [What it is](../README.md)\n- [Page](page.md): one.\n- [Works](bibliography.md).\n"
                      "- [Concepts](concepts/README.md).\n",
    "docs/concepts/README.md": "# Concepts\n\n- [Any](any.md)\n",
    "docs/concepts/any.md": "# Any\n",
    "docs/page.md": "# Page\n\n## A part\n\nSays [hopper_1952, page 2]: [a program](../examples/a.cpp), [a folder](../examples)"
                    ",\n[a header](../include/nysalt/version.hpp) and [data](data.csv).\n",
    "docs/bibliography.md": "# Works\n",
    "docs/bibliography.bib": "@misc{hopper_1952,\n  author = {Hopper, Grace},\n  title = {A Compiler},\n"
                             "  year = {1952}\n}\n",
    "docs/data.csv": "1\n",
    "examples/a.cpp": "int main() {}\n",
    "include/nysalt/version.hpp": "// SPDX-License-Identifier: BSL-1.0\n// The version.\n#pragma once\n"
                                  "namespace nysalt {\n/// As text [hopper_1952], see docs/page.md.\nconstexpr char version"
                                  " = \"1.2.3\";\n/// A concept of `version`.\ntemplate <class T>\nconcept Any = true;\n/// A struct.\nstruct a {\n  int b;  // of it\n};\n}\n",
}


def misses():
    if not all(map(shutil.which, ("doxygen", "sphinx-build"))):
        return "Doxygen or Sphinx"
    python = re.match("#!(.*)", Path(shutil.which("sphinx-build")).read_text()).group(1)
    needed = "import breathe, furo, myst_parser, sphinx_copybutton, sphinxcontrib.bibtex"
    return needed if subprocess.run([python, "-c", needed], capture_output=True, check=False).returncode else ""


@unittest.skipIf(misses(), f"needs {misses()}")
class Site(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name).resolve()
        shutil.copytree(root / "docs/site", self.root / "docs/site", ignore=shutil.ignore_patterns("__pycache__"))
        for name, text in files.items():
            self.write(name, text)

    def write(self, name, text):
        (self.root / name).parent.mkdir(parents=True, exist_ok=True)
        (self.root / name).write_text(text)

    def build(self):
        """(whether it passes, what it says)"""
        environment = {**os.environ, "NYSALT_SITE_VERSIONS": "0.9=https://example.org/0.9"}
        built = subprocess.run([self.root / "docs/site/build.sh", self.root / "site"], capture_output=True, text=True,
                               check=False, env=environment)
        return built.returncode == 0, built.stderr

    def page(self, name):
        return (self.root / "site" / f"{name}.html").read_text()

    def test_of_sound_pages_is_built(self):
        self.assertEqual(self.build(), (True, ""))
        self.assertIn("version 1.2.3", self.page("index"))
        self.assertIn('href="https://example.org/0.9"', self.page("index"))
        self.assertIn('href="docs/page.html#a-part"', self.page("index"))
        page = self.page("docs/page")
        for address in ("bibliography.html#hopper-1952", "../sources/examples/a.cpp.html", "../sources/examples.html",
                        "../api/version.hpp.html"):
            self.assertIn(f'href="{address}"', page)
        header = self.page("api/version.hpp")
        for address in ("../docs/bibliography.html#hopper-1952", "../docs/page.html", "entry-points.html"):
            self.assertIn(f'href="{address}"', header)
        for said in ("The version.", "A concept of", "concept", "A struct.", "Of it."):
            self.assertIn(said, header)
        self.assertIn("The version.", self.page("api/entry-points"))
        searched = (self.root / "site/searchindex.js").read_text()
        searched = json.loads(searched.removeprefix("Search.setIndex(").removesuffix(")"))
        self.assertEqual(searched["docnames"][searched["terms"]["struct"]], "api/version.hpp")
        # Names of C++ are whole ones without a module, or in the module nysalt, as the version of Sphinx has it.
        names = {name for module in searched["objects"].values() for *_, name in map(tuple, module)}
        self.assertTrue("nysalt::Any" in names or "nysalt" in searched["objects"])
        self.assertNotIn("http://", re.sub(r'href="[^"]*"|xmlns="[^"]*"', "", self.page("index")))
        self.assertEqual(self.build(), (True, ""))  # once more into the same folder

    def test_with_a_mistake_is_refused(self):
        header = files["include/nysalt/version.hpp"]
        for name, text, complaint in (
                ("docs/page.md", "# Page\n\n## A part\n\n[a](none.md)\n", "none.md"),
                ("docs/page.md", "# Page\n\n## A part\n\nSays [knuth_1968].\n", "knuth_1968"),
                ("docs/page.md", "# Page\n\n## A part\n\n```{none}\n```\n", "none"),
                ("docs/other.md", "# Other\n", "toctree"),
                ("include/nysalt/version.hpp", header.replace("hopper_1952", "knuth_1968"), "knuth_1968"),
                ("include/nysalt/version.hpp", header.replace("docs/page.md", "docs/none.md"), "docs/none"),
                ("include/nysalt/version.hpp", header.replace("/// A struct.\n", ""), "Struct nysalt::a has no comment"),
                ("include/nysalt/version.hpp", header.replace("A struct.", "As @ref none."), "none"),
                ("include/nysalt/other.hpp", "// Other.\n#pragma once\n", "other.hpp belongs to no group")):
            with self.subTest(complaint, file=name):
                self.write(name, text)
                passes, said = self.build()
                self.assertFalse(passes)
                self.assertIn(complaint, said)
                (self.root / name).unlink()
                if name in files:
                    self.write(name, files[name])

    def test_is_built_nowhere_else(self):
        self.write("site/mine.txt", "precious\n")
        passes, said = self.build()
        self.assertFalse(passes)
        self.assertIn("is not empty", said)
        self.assertTrue((self.root / "site/mine.txt").exists())


if __name__ == "__main__":
    unittest.main()
