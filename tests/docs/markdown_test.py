# SPDX-License-Identifier: BSL-1.0
"""The links and headings of our Markdown are those that a forge sees."""
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "docs" / "site"))
import markdown


class Pages(unittest.TestCase):
    def test_have_the_anchors_of_a_forge(self):
        self.assertEqual(markdown.slug("Where it *pays*: [a](b.md) & more"), "where-it-pays-a--more")
        self.assertEqual(markdown.headings("# A b\n## C `d`, e\n```sh\n## f\n```\n## C `d`, e"),
                         [(1, "A b", "a-b"), (2, "C `d`, e", "c-d-e"), (2, "C `d`, e", "c-d-e-1")])

    def test_have_links_over_two_lines_and_none_in_code(self):
        self.assertEqual(list(markdown.links("[a\nb](c.md) on [0, 1)\n- ![d](e.svg) `[f](g.md)`\n\n```\n[h](i.md)\n```\n")),
                         ["c.md", "e.svg"])
        self.assertEqual(list(markdown.links("`a\nb` [c [d] `e`](f(g).md)")), ["f(g).md"])


if __name__ == "__main__":
    unittest.main()
