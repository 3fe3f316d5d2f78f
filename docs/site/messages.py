#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Messages of exceptions, collected from the sources: messages.py --check | --update.

docs/run-time-messages.md lists the text of every throw and refusal in include, src, python and share, by form. --update writes
the lists, --check says whether they differ from the sources, and which messages have no form. A `{}` is a value.
"""
import argparse
import re
import sys
from pathlib import Path

root = Path(__file__).resolve().parents[2]

c_token = re.compile(
    r"""(?P<space>\s+|//[^\n]*|/\*.*?\*/)|R"(?P<mark>\w*)\((?P<raw>.*?)\)(?P=mark)"|"(?P<text>(?:[^"\\\n]|\\.)*)"|'(?:[^'\\\n]|\\.)+'|"""
    r"""\d[\w.']*|[A-Za-z_]\w*|.""", re.DOTALL)


def texts_of_c(code):
    """The string literals of C++ code; adjacent ones are one."""
    found, is_open = [], False
    for token in c_token.finditer(code):
        text = token["text"] if token["raw"] is None else token["raw"]
        if text is not None:
            text = text.replace('\\"', '"').replace("\\n", "\n")
            found[len(found):] = [found.pop() + text] if is_open else [text]
            is_open = True
        elif token["space"] is None:
            is_open = False
    return found


page_name = "docs/run-time-messages.md"
suffixes = (".hpp", ".cpp")

# A call that ends in an exception: throw TYPE(...), and our functions that throw what they are given. A logic_error is
# for developers: no caller can cause it.
call = re.compile(r"\bthrow\s+(?!std::logic_error\b)[\w:]+[({]|\b(?:refuse\w*|require|fail\w*|complain)\(")

# Texts that the function which is called puts into a message: conditions and reasons.
parts_of_messages = {
    "python/arguments.cpp": {"True or False", "a number", "a text", "a text of whole characters", "a whole number",
                             "a whole number that can be counted"},
    "src/nysalt/learning/reach.cpp": {"the systems are not of one kind"},
    "src/nysalt/derivatives/word_on_parts.cpp": {"K''(p) is not positive semidefinite",
                                                 "the letter {} is neither a drift nor a kick"},
    "src/nysalt/ensembles/burn_in.hpp": {"be that of equipartition", "not change afterwards"},
    "src/nysalt/family.cpp": {"have a part of H for each coefficient", "leave out what follows |",
                                       "not have two equal neighbours", "read the same from both ends"},
    "src/nysalt/systems/lennard_jones_liquid.cpp": {"finite and at least 1", "from 0 to 3", "positive and finite",
                                                    "the number of threads"},
}

forms = {
    "value": re.compile(r"\bmust\b"),
    "unknown": re.compile(r"^(?:\{\}: |[\w ,-]+: )?unknown \w[\w ]* '?\{\}'?"),
    "operation": re.compile(r"\bcannot (?!be\b)[a-z]+ "),
}


def end_of_call(code, start):
    """Index behind the bracket that closes the one before start; brackets in texts and comments do not count."""
    depth, i = 1, start
    token = re.compile(r'"(?:[^"\\\n]|\\.)*"|\'(?:[^\'\\\n]|\\.)+\'|//[^\n]*|[(){}]')
    while depth:
        found = token.search(code, i)
        if not found:
            return len(code)
        i = found.end()
        depth += {"(": 1, "{": 1, ")": -1, "}": -1}.get(found[0], 0)
    return i


def thrown(code):
    """[(line, text)]: the longest text of each call that ends in an exception; texts of one word are keys."""
    found = []
    code = re.sub(r"(?m)^ *//.*", "", code)
    for match in call.finditer(code):
        body = code[match.end():end_of_call(code, match.end()) - 1]
        field, *_ = all_texts = texts_of_c(body) or [""]
        texts = [text for text in all_texts if " " in text.strip()]
        if texts:
            name = "" if match[0] != "refuse_value(" else "{} " if field in texts else f"{field} "
            found.append((code.count("\n", 0, match.start()) + 1, name + max(texts, key=len)))
    return found


programs = ("program", "reproduction")


def options_named(folder):
    """["FILE: TEXT"] of the texts below src that name options, but for the programs, which have them."""
    return [f"{path.relative_to(folder)}: {text}" for path in sorted((folder / "src").rglob("*.?pp"))
            if path.relative_to(folder / "src").parts[0] not in programs
            for text in texts_of_c(path.read_text()) if re.search(r"--[a-z]", text)]


def refused(template):
    """The messages in the head of an export template: `require CONDITION: MESSAGE`."""
    head = template.partition("\n---\n")[0]
    return ["export: " + re.sub(r"@\w+@", "{}", text) for text in re.findall(r"^require [^:]*: (.*)$", head, re.MULTILINE)]


def messages(folder):
    """{text: name of the first file with it} of the sources and export templates below a folder."""
    found = {}
    for top in ("include", "src", "python"):
        for path in sorted((folder / top).rglob("*")):
            if path.suffix in suffixes:
                name = path.relative_to(folder).as_posix()
                for _, text in thrown(path.read_text()):
                    if text not in parts_of_messages.get(name, ()):
                        found.setdefault(text, name)
    for path in sorted((folder / "share" / "exports").glob("*.in")):
        for text in refused(path.read_text()):
            found.setdefault(text, path.relative_to(folder).as_posix())
    return found


def form_of(text):
    """value, unknown or operation; None for a text without a form."""
    return next((name for name, form in forms.items() if form.search(text)), None)


def area_of(name):
    """The part of the project that a message comes from, as a heading."""
    if name.startswith(("include/", "src/nysalt/", "share/")):
        return "The library"
    return "The Python module" if name.startswith("python/") else "The program"


headings = {"value": "a value that must meet a condition", "unknown": "names that are not known",
            "operation": "what failed for a reason outside the arguments"}
intro = """# Messages of exceptions

What the library throws and the program refuses with exit code 2 or 4, by part and form, so that the words of a message can
be searched for here. `{}` is a value, or a parameter: `learn_horizon` is `--learn-horizon` in the program and
`learning.horizon` in C++. `docs/site/messages.py` collected this page from the sources; a test compares both.
What the compiler says is on [another page](messages.md).

A message has one of three forms:

1. `WHO: PARAMETER must CONDITION, got VALUE; REMEDY`. WHO is the function, option, file or object; the remedy is left out
   where the condition says what to do.
2. `unknown KIND 'NAME': CHOICES`
3. `cannot VERB OBJECT: REASON; REMEDY`
"""


def page_of(found):
    lines = [intro]
    for area in ("The library", "The program", "The Python module"):
        for form, heading in headings.items():
            texts = sorted((text for text, name in found.items() if area_of(name) == area and form_of(text) == form),
                           key=lambda text: (re.sub(r"\W+", " ", text).strip().lower(), text))
            if texts:
                lines.append(f"## {area}: {heading}\n")
                lines += [f"- `` {' '.join(text.split())} ``" for text in texts]
                lines.append("")
    return "\n".join(lines).rstrip() + "\n"


def main():
    parser = argparse.ArgumentParser(description="Messages of exceptions, collected from the sources.")
    mode = parser.add_mutually_exclusive_group(required=True)
    mode.add_argument("--check", action="store_true")
    mode.add_argument("--update", action="store_true")
    arguments = parser.parse_args()
    found = messages(root)
    page = root / page_name
    if arguments.update:
        page.write_text(page_of(found))
    formless = [f"{name}: \"{text}\": write `WHO: PARAMETER must CONDITION, got VALUE; REMEDY`"
                for text, name in sorted(found.items()) if form_of(text) is None]
    outdated = [] if page.is_file() and page.read_text() == page_of(found) else [
        f"{page_name} differs from the sources: docs/site/messages.py --update"]
    print("\n".join(formless + outdated), file=sys.stderr)
    return 1 if formless or outdated else 0


if __name__ == "__main__":
    sys.exit(main())
