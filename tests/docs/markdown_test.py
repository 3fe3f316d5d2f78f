# SPDX-License-Identifier: BSL-1.0
"""Our Markdown in the form in which Doxygen shows what the forge shows."""
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "docs" / "site"))
import markdown


def staged(text):
    return markdown.staged(text, "page", lambda address: f"to/{address}", {"hopper_1952"}).split("\n")[:-1]


class Pages(unittest.TestCase):
    def test_have_anchors_of_their_own(self):
        self.assertEqual(staged("# A b\n## C `d`, e\n## C `d`, e"),
                         ["# A b {#page}", "## C d, e {#page--c-d-e}", "## C d, e {#page--c-d-e-1}"])
        self.assertEqual(markdown.slug("Where it *pays*: [a](b.md) & more"), "where-it-pays-a--more")

    def test_of_many_parts_have_a_table_of_contents(self):
        self.assertIn("[TOC]", staged("# A\n## b\n## c\n## d\n## e"))
        self.assertNotIn("[TOC]", staged("# A\n## b\n## c\n## d"))

    def test_link_pictures_and_keys(self):
        self.assertEqual(staged("[a `b`](c.md)"), ['<a href="to/c.md">a `b`</a>'])
        self.assertEqual(staged('![a "b"](c.svg)'), ['<img src="to/c.svg" alt="a &quot;b&quot;"/>'])
        its = '<a href="bibliography.html#bibliography--hopper_1952">hopper_1952</a>'
        self.assertEqual(staged("[hopper_1952, table 1] and [knuth_1968]"), [f"[{its}, table 1] and [knuth_1968]"])

    def test_say_nothing_to_doxygen(self):
        self.assertEqual(staged("a@b, \\alpha, 50 %c, #d, <e> and --f"),
                         [r"a\@b, \\alpha, 50 \%c, \#d, \<e> and \--f"])
        self.assertEqual(staged("`a@b \\alpha #d --f` <br>"), ["`a@b \\alpha #d --f` <br>"])
        self.assertEqual(staged("`f'(q) v`"), ["``f'(q) v``"])
        self.assertEqual(staged("<!-- quote a.cpp b -->\n```cpp\n#include <a> // @b\n```"),
                         ["", "```{.cpp}", "#include <a> // @b", "```"])

    def test_let_doxygen_link_no_code_that_is_no_name_of_ours(self):
        self.assertEqual(staged("`nysalt::learn`, `s.size()`, `nysalt::learner`, `size()`"),
                         ["`%nysalt::learn`, `%s.size()`, `nysalt::learner`, `size()`"])

    def test_stress_what_begins_with_code(self):
        self.assertEqual(staged("**`a` b** and *c* but \\*d\\* and e * f * g"),
                         ["<b>`a` b</b> and <em>c</em> but \\*d\\* and e * f * g"])

    def test_read_code_and_links_over_two_lines(self):
        self.assertEqual(staged("`a\nb` and `c`"), ["`a b` and `c`"])
        self.assertEqual(staged("[a\nb](c.md) on [0, 1)\n- d"), ['<a href="to/c.md">a b</a> on [0, 1)', "- d"])


class Tables(unittest.TestCase):
    def test_keep_bars_in_cells(self):
        table = staged("| a | b |\n|---|--:|\n| \\|p\\| | `c | d` |")
        self.assertIn("<th>a</th>", table)
        self.assertIn("<td>|p|</td>", table)
        self.assertIn('<td align="right">`c | d`</td>', table)

    def test_break_long_code_and_no_other(self):
        table = staged("| a | b |\n|---|---|\n| `--seed N` | `method.apply(system, prepared, x)` |")
        self.assertIn("<td>`--seed N`</td>", table)
        self.assertIn('<td><span class="long">`%method.apply(system, prepared, x)`</span></td>', table)

    def test_end_where_the_rows_end(self):
        self.assertEqual(staged("| a |\n|---|\n| b |\n\nc")[-2:], ["", "c"])
        self.assertEqual(staged("| a |\n|---|\n| b |")[-1], "</table>")


if __name__ == "__main__":
    unittest.main()
