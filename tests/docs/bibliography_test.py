# SPDX-License-Identifier: BSL-1.0
"""docs/bibliography.md is made from docs/bibliography.bib, and what is cited is in it and the other way round."""
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "docs" / "site"))
import bibliography

source = r"""% Two works.

@article{hopper_1952,
  author  = {Hopper, Grace Brewster and M{\"u}ller, J{\'u}lia},
  title   = {The {E}ducation
             of a Computer},
  journal = {Proceedings},
  volume  = {3},
  pages   = {1--5},
  year    = {1952},
  doi     = {10.1/a(b)c}
}

@misc{solver,
  author       = {Babbage, Charles and others},
  title        = {A Solver},
  howpublished = {\url{http://example.org}}
}
"""


class Bibliography(unittest.TestCase):
    def test_of_the_project_is_whole_and_fresh(self):
        self.assertGreater(len(bibliography.keys(bibliography.source.read_text())), 30)
        self.assertEqual(bibliography.mistakes(), [])

    def test_is_written_by_key(self):
        page = bibliography.written(source)
        self.assertIn("## hopper_1952\n\n"
                      "G. B. Hopper, J. Müller: *The Education of a Computer*, Proceedings 3 (1952) 1–5. "
                      "[doi:10.1/a(b)c](https://doi.org/10.1/a%28b%29c)\n", page)
        self.assertIn("## solver\n\nC. Babbage and others: *A Solver*, <http://example.org>.\n", page)

    def test_refuses_what_it_cannot_read(self):
        for wrong in (source.replace("{\\\"u}", "{\\v{u}}"), source.replace("}\n}\n", "}}\n")):
            with self.assertRaises((bibliography.Mistake, KeyError)):
                bibliography.written(wrong)

    def test_knows_what_is_cited(self):
        known = {"hopper_1952", "solver"}
        self.assertEqual(bibliography.cited("as in [hopper_1952, table 1; knuth_1968] and solver", known),
                         {"hopper_1952", "knuth_1968"})
        self.assertEqual(bibliography.cited("by [solver]", known), {"solver"})

    def test_tells_what_is_missing_unused_and_old(self):
        before = bibliography.readers
        self.addCleanup(setattr, bibliography, "readers", before)
        bibliography.readers = lambda: []
        unused = bibliography.mistakes()
        self.assertEqual(len(unused), len(bibliography.keys(bibliography.source.read_text())))
        self.assertTrue(all(sentence.endswith(" is not cited") for sentence in unused))

        bibliography.readers = lambda: [*before(), Path(__file__)]  # it cites two works that are not there
        missing = bibliography.mistakes()
        self.assertEqual(len(missing), 2)
        self.assertIn("cites hopper_1952, which docs/bibliography.bib does not have", missing[0])

        self.addCleanup(setattr, bibliography, "page", bibliography.page)
        bibliography.readers = before
        bibliography.page = bibliography.source
        self.assertIn("--update", bibliography.mistakes()[0])


if __name__ == "__main__":
    unittest.main()
