#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""What must not compile, and the sentence that a person reads then: check.py COMPILER FLAGS_FILE

Each top-level namespace of the files beside, named in a comment at its end, is a case. The comment before it lists what the
compiler must print:
    // expect: a sentence, which may
    //   go on in further lines
With "expect GNU:" or "expect Clang:" it is that compiler's alone. All files are one unit, which must compile with
-DNYSALT_CONTROL, as then each case fails for the named cause only; without it each case must fail with its sentences.
docs/messages.md shows the cases, and tests/docs/messages_test.py compares the sentences of the page with those here.
"""
import os
import re
import subprocess
import sys
import tempfile
from collections import namedtuple
from pathlib import Path

Case = namedtuple("Case", "name file first last expected")  # expected: [(compiler or "", sentence)]


def cases_of(text, file=""):
    found = []
    opened = re.compile(r"((?:^//[^\n]*\n)*)^namespace (\w+) \{\n.*?^\}  // namespace \2$", re.M | re.S)
    for match in opened.finditer(text):
        comment = re.sub(r"\n//  +", " ", match[1])
        expected = [(whose.strip(), sentence)
                    for whose, sentence in re.findall(r"^// expect( GNU| Clang)?: (.+)$", comment, re.M)]
        line = text.count("\n", 0, match.start()) + 1
        found.append(Case(match[2], file, line, text.count("\n", 0, match.end()) + 1, expected))
    return found


def errors_of(output):
    """The errors of a compiler, each with the lines before that say how it came there, and its notes."""
    errors, context = [], []
    for line in output.splitlines():
        if re.search(r"(?:^|: )(?:fatal )?error: ", line):
            errors.append("\n".join([*context, line]))
            context = []
        elif re.match(r"In file included|\s+from |\S+: (?:In|At) |\S+:\d+:(?:\d+:)?\s+(?:recursively )?(?:required|in '?constexpr'? expansion)", line):
            context.append(line)
        elif errors:
            errors[-1] += "\n" + "\n".join([*context, line])
            context = []
    return errors


def wrong_of(files, compile_unit, compiler_id):
    """Sentences on what is wrong in {name: text}. compile_unit(options) returns the exit code and the errors' text."""
    cases = [case for name, text in files.items() for case in cases_of(text, name)]
    found = [f"{case.file}: {case.name} expects no sentence" for case in cases if not case.expected]
    code, output = compile_unit(["-DNYSALT_CONTROL"])
    if code:
        found.append(f"with NYSALT_CONTROL it must compile:\n{output}")
    _, output = compile_unit([])
    said = {case.name: [] for case in cases}
    last = []
    for error in errors_of(output):
        places = [(file, int(line)) for file, line in re.findall(r"([\w.]+):(\d+):", error)]
        of_case = [case for case in cases if any(case.file == file and case.first <= line <= case.last for file, line in places)]
        if of_case:
            last = of_case
        for case in last:  # g++ explains why a concept is not met by further errors, which are of the last case
            said[case.name].append(error.replace(f"{case.name}::", ""))
        if not last:
            found.append(f"an error of no case:\n{error}")
    for case in cases:
        if not said[case.name]:
            found.append(f"{case.file}: {case.name} compiles, and must not")
            continue
        text = "\n".join(said[case.name])
        found += [f"{case.file}: {case.name}: the compiler does not say '{sentence}', but\n{text}"
                  for whose, sentence in case.expected if whose in ("", compiler_id) and sentence not in text]
    return found


def compiler_of(compiler, flags, folder):
    """compile_unit() for the files of a folder, and which compiler it is."""
    told = subprocess.run([compiler, "--version"], capture_output=True, text=True, check=True).stdout
    is_clang = "clang" in told
    options = ["-ferror-limit=0"] if is_clang else ["-fmax-errors=0", "-fconcepts-diagnostics-depth=3"]
    unit = "".join(f'#include "{file}"\n' for file in sorted(folder.glob("*.cpp")))

    def compile_unit(more):
        done = subprocess.run([compiler, *flags, *options, *more, "-w", "-fsyntax-only", "-x", "c++", "-"], input=unit,
                              capture_output=True, text=True, env={**os.environ, "LC_ALL": "C"}, check=False)
        return done.returncode, done.stderr
    return compile_unit, "Clang" if is_clang else "GNU"


def check(compiler, flags, folder):
    files = {file.name: file.read_text() for file in sorted(folder.glob("*.cpp"))}
    return wrong_of(files, *compiler_of(compiler, flags, folder))


PLANTED = """// expect: nysalt: one of
//   two lines
namespace sound {
#ifndef NYSALT_CONTROL
template <class T>
struct a {
  static_assert(sizeof(T) == 0, "nysalt: one of two lines");
};
a<int> b;
#endif
}  // namespace sound

// expect: nysalt: one of two lines
namespace sentence_of_another_case {
#ifndef NYSALT_CONTROL
static_assert(false, "nysalt: three");
#endif
}  // namespace sentence_of_another_case

// expect: nysalt: four
namespace mistake_without_error {
int a;
}  // namespace mistake_without_error

namespace without_a_sentence {
#ifndef NYSALT_CONTROL
int a = "five";
#endif
}  // namespace without_a_sentence

// expect: six
namespace control_that_fails {
static_assert(false, "six");
}  // namespace control_that_fails
"""


def check_itself(compiler):
    """Each planted mistake of a case must be reported, and nothing else."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "planted.cpp").write_text(PLANTED)
        found = [one.split("\n")[0] for one in check(compiler, ["-std=c++20"], folder)]
    wanted = ["planted.cpp: without_a_sentence expects no sentence", "with NYSALT_CONTROL it must compile:",
              "planted.cpp: sentence_of_another_case: the compiler does not say 'nysalt: one of two lines', but",
              "planted.cpp: mistake_without_error compiles, and must not"]
    return [] if found == wanted else [f"of planted mistakes these must be reported:\n{wanted}\nnot\n{found}"]


def main():
    compiler, flags = sys.argv[1:]
    found = check_itself(compiler) + check(compiler, [f"@{flags}"], Path(__file__).resolve().parent)
    print("\n".join(found), file=sys.stderr)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
