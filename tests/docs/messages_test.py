# SPDX-License-Identifier: BSL-1.0
"""docs/messages.md shows what compilers say: every sentence of the headers, and nothing that none of them prints.
Every message of an exception has a form, and docs/run-time-messages.md lists it; a planted one without a form is found."""
import re
import sys
import tempfile
import unittest
from pathlib import Path

root = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(root / "tests" / "must_not_compile"), str(root / "docs" / "site")]
import check
import messages

page = (root / "docs" / "messages.md").read_text()


def sentences(code):
    """What static assertions say: literals that stand one after the other are one."""
    return {"".join(re.findall(r'"([^"]*)"', found)) for found in re.findall(r'"nysalt: [^"]*"(?:\s+"[^"]*")*', code)}


def expected(cases):
    """What the cases of a file expect to read, of one compiler or of all."""
    return {sentence for case in check.cases_of(cases) for _, sentence in case.expected}


def shown(document):
    """What a document quotes of our sentences, and the lines of its fences of text."""
    fences = re.findall(r"^```text\n(.*?)^```$", document, re.MULTILINE | re.DOTALL)
    return {line for fence in fences for line in fence.splitlines()} | set(
        re.findall(r"^> (nysalt: .+)$", document, re.MULTILINE))


def of_all(read, files):
    return set().union(*(read(file.read_text()) for file in files))


class Messages(unittest.TestCase):
    def setUp(self):
        self.sentences = of_all(sentences, (root / "include").rglob("*.hpp"))
        self.expected = of_all(expected, (root / "tests" / "must_not_compile").glob("*.cpp"))

    def test_of_the_headers_are_all_shown(self):
        self.assertGreater(len(self.sentences), 20)
        self.assertEqual(self.sentences - shown(page), set())

    def test_that_are_shown_are_said_by_a_compiler(self):
        self.assertGreater(len(shown(page)), 30)
        self.assertEqual(shown(page) - self.sentences - self.expected, set())

    def test_mostly_have_a_case(self):
        self.assertGreater(len(self.sentences & self.expected), len(self.sentences) / 2)

    def test_are_read_whole(self):
        self.assertEqual(sentences('static_assert(a, "nysalt: one "\n      "two");  g("nysalt: three", "four")'),
                         {"nysalt: one two", "nysalt: three"})
        cases = "// About.\n// expect: a\n//   b\n// expect GNU: c\nnamespace d {\ne;\n}  // namespace d\n// expect: f\n"
        self.assertEqual(expected(cases), {"a b", "c"})
        self.assertEqual(shown("> nysalt: a\n\n```text\nb\nc\n```\n\n> d\n\n```cpp\ne\n```\n"), {"nysalt: a", "b", "c"})


found = messages.messages(root)


class Thrown(unittest.TestCase):
    def test_are_found_in_all_areas(self):
        areas = {messages.area_of(name) for name in found.values()}
        self.assertEqual(len(areas), 3)
        self.assertGreater(len(found), 600)

    def test_have_a_form(self):
        self.assertEqual([f"{name}: {text}" for text, name in found.items() if messages.form_of(text) is None], [])

    def test_are_listed(self):
        self.assertEqual((root / messages.page_name).read_text(), messages.page_of(found),
                         "docs/site/messages.py --update writes the page")

    def test_parts_of_messages_are_in_the_sources(self):
        for name, parts in messages.parts_of_messages.items():
            read = {text for _, text in messages.thrown((root / name).read_text())}
            self.assertEqual(parts - read, set(), name)


class ThrownInACopy(unittest.TestCase):
    def read(self, code, name="report/a.cpp", reader=messages.messages):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "src" / name
            file.parent.mkdir(parents=True)
            file.write_text(code)
            return reader(Path(folder))

    def test_name_options_in_programs_alone(self):
        self.assertEqual(messages.options_named(root), [])
        code = '// --steps\nrefuse("give one of "\n  "--steps");\n'
        self.assertEqual(self.read(code, reader=messages.options_named), ["src/report/a.cpp: give one of --steps"])
        self.assertEqual(self.read(code, "program/a.cpp", messages.options_named), [])

    def test_throws_and_refusals_are_read(self):
        for code, text in {
            'throw std::invalid_argument("run: steps must be >= 0");': "run: steps must be >= 0",
            'throw refusal{"cannot read \\"a\\""};': 'cannot read "a"',
            'refuse("unknown metric \'{}\': " "it is one of {}", name, list);': "unknown metric '{}': it is one of {}",
            'refuse_value("bins", "must be {}", bins);': "bins must be {}",
            'refuse_value(field, "must be {}", bins);': "{} must be {}",
            'refuse_export("{} must have no \')\' (\\"{}\\")", a(b("x y")), c);': "{} must have no ')' (\"{}\")",
            'require(x > 0 /* ( */, "x must be > 0");  // )': "x must be > 0",
            'fail(fmt::format("cannot write {}: {}", path, "the disk is full"));': "cannot write {}: {}",
        }.items():
            with self.subTest(code):
                self.assertEqual(list(self.read(f"void f() {{ {code} }}\nauto b = \"another text\";\n")), [text])

        self.assertEqual(self.read('// throw refusal("a b")\nauto a = f("one two");\nrefuse("key");\nrefuse(text);\n'
                                   'throw std::logic_error("not for users");\n'), {})

    def test_heads_of_export_templates_are_read(self):
        self.assertEqual(messages.refused("what: a: b\nrequire has A and two_stage: x must be y, got @method@; z\n---\nrequire b: c\n"),
                         ["export: x must be y, got {}; z"])

    def test_forms(self):
        for form, texts in {
            "value": ("--steps must hold different steps, got {} twice", "{} must not be read"),
            "unknown": ("unknown metric '{}': {}", "run: unknown observable '{}' of {}: {}"),
            "operation": ("cannot write {}: another run is writing it; wait for that run",),
            None: ("--steps names {} twice", "{} is being written by another run: wait for it", "{}: it is mustard",
                   "lags of 0 are refused", "what is unknown '{}'")}.items():
            self.assertEqual([messages.form_of(text) for text in texts], [form] * len(texts))


if __name__ == "__main__":
    unittest.main()
