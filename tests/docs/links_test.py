# SPDX-License-Identifier: BSL-1.0
"""Every link of the documents leads somewhere, on a forge and on the site; one that does not is noticed."""
import sys
import tempfile
import unittest
from pathlib import Path

root = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(root / "docs" / "site"))
import links
import markdown


class Documents(unittest.TestCase):
    def test_point_at_what_is_there(self):
        self.assertGreater(sum(1 for page in markdown.documents(root) for _ in markdown.links(page.read_text())), 100)
        self.assertEqual(list(links.wrong_in_markdown(root)), [])

    def test_are_listed_on_the_first_page(self):
        self.assertEqual(list(links.unlisted(root)), [])


class InAFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name).resolve()
        (self.root / "docs").mkdir()
        (self.root / "docs/README.md").write_text("# All\n\n- [one](one.md)\n- [two](../two.md#b--c)\n")
        (self.root / "docs/one.md").write_text("# One\n\n## With `code`, and more\n\n## Twice\n\n## Twice\n")
        (self.root / "two.md").write_text("# Two\n\n## b & *c*\n")

    def wrong_with(self, text):
        (self.root / "two.md").write_text("# Two\n\n## b & c\n\n" + text)
        return list(links.wrong_in_markdown(self.root))


class Markdown(InAFolder):
    def test_that_is_right_is_left_in_peace(self):
        self.assertEqual(self.wrong_with("[a](docs/one.md#with-code-and-more) [b](#b--c) [c](docs/one.md#twice-1)\n"
                                         "[d](https://example.org/nothing) `docs/one.md`\n"), [])

    def test_that_points_nowhere_is_told(self):
        for text, told in {"[a](docs/three.md)\n": "there is no docs/three.md", "![a](picture.svg)\n": "there is no picture.svg",
                           "[a](docs/one.md#two)\n": "docs/one.md has no heading #two",
                           "[a](#a)\n": "two.md has no heading #a", "[a\nb](c.md)\n": "there is no c.md",
                           "`a\nb` [c [d] `e`](f(g).md) `h`\n": "there is no f(g).md",
                           "see `examples/none.cpp`\n": "there is no examples/none.cpp",
                           "[a](../outside.md)\n": "there is no ../outside.md"}.items():
            self.assertEqual(self.wrong_with(text)[0], f"two.md: {told}")

    def test_in_code_is_no_link(self):
        self.assertEqual(self.wrong_with("`[a](b.md)`\n\n```text\n[a](b.md)\n## c\n```\n"), [])

    def test_that_the_first_page_does_not_list_is_told(self):
        self.assertEqual(list(links.unlisted(self.root)), [])
        (self.root / "docs/three.md").write_text("# Three\n")
        self.assertEqual(list(links.unlisted(self.root)), ["docs/README.md does not list docs/three.md"])


class Site(InAFolder):
    def wrong_with(self, text):
        (self.root / "index.html").write_text(f'<html><p id="here">{text}</p></html>')
        (self.root / "page.html").write_text('<html><a name="there">x</a></html>')
        self.external = set()
        return list(links.wrong_on_site(self.root, self.external))

    def test_that_is_right_is_left_in_peace(self):
        self.assertEqual(self.wrong_with('<a href="page.html#there">a</a><a href="#here">b</a>'
                                         '<a href="https://c.org">c</a>'), [])
        self.assertEqual(self.external, {"https://c.org"})

    def test_that_points_nowhere_is_told(self):
        for text, told in {'<a href="none.html">a</a>': "there is no none.html", '<img src="a.svg"/>': "there is no a.svg",
                           '<a href="page.html#here">a</a>': "page.html has no anchor #here",
                           '<a href="#there">a</a>': "index.html has no anchor #there"}.items():
            self.assertEqual(self.wrong_with(text), [f"index.html: {told}"])

    def test_without_pages_is_told(self):
        self.assertEqual(len(list(links.wrong_on_site(self.root / "docs", set()))), 1)


if __name__ == "__main__":
    unittest.main()
