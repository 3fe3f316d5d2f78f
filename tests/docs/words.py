# SPDX-License-Identifier: BSL-1.0
"""Plain words: words.py [--record | --where WORD] [ROOT].

docs/notation.md lists words that are not used. This script finds them in comments, texts and names of the sources, and in
the pages. tests/docs/words_left.txt records how many are left, by folder and word; a count may only fall. --record writes
the counts of now, --where WORD lists where one is. Two rules have no exception: `its` is not an identifier, and no
message ends in "cannot be".
"""
import argparse
import io
import re
import shutil
import subprocess
import sys
import tokenize
from collections import Counter
from pathlib import Path

# The longest name that fits is the folder of a file.
folders = ("include", "src", "python", "examples", "docs", "docs/results", "README.md", "CONTRIBUTING.md")
languages = {".cpp": "c", ".hpp": "c", ".h": "c", ".c": "c", ".py": "python", ".sh": "text", ".md": "markdown"}

c_token = re.compile(
    r"""(?P<comment>//[^\n]*|/\*.*?\*/)|R"(?P<mark>\w*)\((?P<raw>.*?)\)(?P=mark)"|"(?P<text>(?:[^"\\\n]|\\.)*)"|"""
    r"""(?P<char>'(?:[^'\\\n]|\\.)+')|(?P<number>\d[\w.']*)|(?P<name>[A-Za-z_]\w*)|(?P<include>\#[ ]*include[^\n]*)|"""
    r"(?P<other>\S)", re.DOTALL | re.VERBOSE)

section_of_words = re.compile(r"^## Words that are not used\n.*?(?=^## |\Z)", re.DOTALL | re.MULTILINE)


def parts_of_c(code):
    """[(line, kind, text)] with the kinds comment, text (adjacent ones joined) and name."""
    found = []
    open_text = False
    for token in c_token.finditer(code):
        line = code.count("\n", 0, token.start()) + 1
        kind = token.lastgroup if token["raw"] is None else "raw"
        if kind == "include":
            continue
        if kind in ("text", "raw"):
            text = token[kind].replace('\\"', '"').replace("\\n", "\n")
            if open_text:
                found[-1] = (found[-1][0], "text", found[-1][2] + text)
            else:
                found.append((line, "text", text))
            open_text = True
            continue
        if kind == "comment":
            text = re.sub(r"^/[/*]+<?|\*/$", "", token["comment"])
            if found and found[-1][1] == "comment" and found[-1][3] == line - 1 and not open_text:
                found[-1] = (found[-1][0], "comment", found[-1][2] + "\n" + text, line)
            else:
                found.append((line, "comment", text, line + text.count("\n")))
            continue
        open_text = False
        if kind == "name":
            found.append((line, "name", token["name"]))
    return [entry[:3] for entry in found]


def parts_of_python(code):
    found = []
    for token in tokenize.generate_tokens(io.StringIO(code).readline):
        if token.type == tokenize.COMMENT:
            found.append((token.start[0], "comment", token.string[1:]))
        elif token.type == tokenize.STRING:
            found.append((token.start[0], "text", re.sub(r"^\w*(\"\"\"|'''|\"|')|(\"\"\"|'''|\"|')$", "", token.string)))
        elif token.type == tokenize.NAME:
            found.append((token.start[0], "name", token.string))
    return found


def parts_of_markdown(page):
    """Prose without fences, code and addresses, which quote other files."""
    def blank(match):
        return "\n" * match[0].count("\n")
    page = re.sub(r"^( *)(`{3,}).*?^\1\2 *$", blank, page, flags=re.DOTALL | re.MULTILINE)
    page = re.sub(r"`[^`\n]*`|\]\([^)]*\)|^<!--.*?-->$", " ", page, flags=re.MULTILINE)
    return [(1, "comment", page)]


def parts(path, text):
    language = languages[path.suffix]
    if language == "c":
        return parts_of_c(text)
    if language == "python":
        return parts_of_python(text)
    return parts_of_markdown(text) if language == "markdown" else [(1, "comment", text)]


def exceptions(page):
    """{word: (whether it may be a name, pieces of code with it)}: what follows "except" in the second column."""
    found = {}
    for word, rest in re.findall(r"^\| `(.*?)`.*?\| (.*?) \|$", section_of_words.search(page)[0], re.MULTILINE):
        _, _, excepted = rest.partition("except ")
        found[word] = (excepted.startswith("in names"), re.findall(r"`([^`]+)`", excepted))
    return found


def without_code(text, pieces, is_text):
    """The text without what is no prose: code between backticks, quoted names, and these pieces of code. A text of one
    word is a key."""
    def blank(match):
        return re.sub(r"[^\n]", " ", match[0])
    if is_text and text in pieces:
        return ""
    text = re.sub(r"`[^`\n]*`", blank, text)
    for piece in pieces:
        if " " in piece:
            text = re.sub(rf"(?<![-\w]){re.escape(piece)}(?![-\w])", blank, text)
    return text


def words_not_used(page):
    """{word: expression} of the section `Words that are not used`; a word in a table's first column stands for all its
    listed forms, and `cannot be` is one where nothing follows that says what."""
    section = section_of_words.search(page)
    if not section:
        raise ValueError("docs/notation.md has no section `Words that are not used`")
    gap = r"\s+(?:///?<?\s+|\*\s+|#\s+)?"  # the marks of a comment may be between two words
    found = {}
    for row in re.findall(r"^\| (`.*?) \|", section[0], re.MULTILINE):
        forms = re.findall(r"`([^`]+)`", row)
        expression = r"(?i)(?<![-\w/])(?:" + "|".join(gap.join(map(re.escape, form.split())) for form in forms) + r")(?![-\w])"
        if forms == ["cannot be"]:
            expression += r"(?=\s*(?:[.,:;?!)\"]|$|of\b|at\b))"
        found[forms[0]] = re.compile(expression)
    return found


def files(root):
    """The files of ours that are looked through, in order; those that git ignores are left out where there is git."""
    listed = ""
    if shutil.which("git"):
        listed = subprocess.run(["git", "-C", str(root), "ls-files", "--cached", "--others", "--exclude-standard"],
                                capture_output=True, text=True, check=False).stdout
    paths = [root / name for name in listed.splitlines()] or root.rglob("*")
    for path in sorted(paths):
        if path.suffix in languages and path.is_file() and folder_of(root, path):
            yield path


def folder_of(root, path):
    name = path.relative_to(root).as_posix()
    fitting = [folder for folder in folders if name == folder or name.startswith(folder + "/")]
    return max(fitting, key=len, default=None)


def found_in(root):
    """[(path, line, folder, word)] of the words, also as parts of names, and sentences on what has no exception."""
    page = (root / "docs/notation.md").read_text()
    words, excepted = words_not_used(page), exceptions(page)
    places, wrong, names = [], [], set()  # a name counts once in a folder
    for path in files(root):
        name = path.relative_to(root).as_posix()
        text_of_file = path.read_text()
        if name == "docs/notation.md":
            text_of_file = section_of_words.sub(lambda match: "\n" * match[0].count("\n"), text_of_file)  # it lists them
        for line, kind, text in parts(path, text_of_file):
            if kind == "name":
                if text == "its":
                    wrong.append(f"{name}:{line}: `its` is not an identifier; name what it is")
                for word, expression in words.items():
                    may_be_name, pieces = excepted[word]
                    if may_be_name or text in pieces:
                        continue
                    if expression.search(text.replace("_", " ")) and (folder_of(root, path), text) not in names:
                        names.add((folder_of(root, path), text))
                        places.append((name, line, folder_of(root, path), f"{word} (names)"))
                continue
            if kind == "text" and re.search(r"cannot be\s*(?:[.:;,]|$)", text):
                wrong.append(f"{name}:{line}: \"{text[:60]}\": write `WHO: PARAMETER must CONDITION, got VALUE; REMEDY`")
            for word, expression in words.items():
                may_be_name, pieces = excepted[word]
                keys = [*pieces, word] if may_be_name else pieces
                for match in expression.finditer(without_code(text, keys, kind == "text")):
                    at = line + text.count("\n", 0, match.start())
                    places.append((name, at, folder_of(root, path), word))
    return places, wrong


def recorded(path):
    """{(folder, word): count}"""
    rows = (line.split(maxsplit=2) for line in path.read_text().splitlines() if line and not line.startswith("#"))
    return {(folder, word): int(count) for folder, count, word in rows}


def judged(counts, record):
    """Sentences on counts that rose, and on counts that fell."""
    rose, fell = [], []
    for folder, word in sorted(set(counts) | set(record)):
        now, before = counts.get((folder, word), 0), record.get((folder, word), 0)
        if now > before:
            rose.append(f"{folder}: '{word}' {now} times, {before} are recorded; see docs/notation.md for a plain word "
                        f"(words.py --where '{word}')")
        elif now < before:
            fell.append(f"{folder}: '{word}' {now} times, {before} are recorded: lower the record (words.py --record)")
    return rose, fell


def record_of(counts):
    head = ("# Words that are not used (docs/notation.md) and are not yet cleaned: folder, count, word.\n"
            "# A count may only fall; tests/docs/words.py --record writes this file.\n")
    return head + "".join(f"{folder} {count} {word}\n" for (folder, word), count in sorted(counts.items()))


def main():
    parser = argparse.ArgumentParser(description="Words that are not used, in sources and pages.")
    parser.add_argument("--record", action="store_true", help="write the counts of now into words_left.txt")
    parser.add_argument("--where", metavar="WORD", help="list the places of a word")
    parser.add_argument("root", nargs="?", type=Path, default=Path(__file__).resolve().parents[2])
    arguments = parser.parse_args()
    root = arguments.root.resolve()
    places, wrong = found_in(root)
    if arguments.where:
        print("\n".join(f"{name}:{line}" for name, line, _, word in places if word == arguments.where))
        return 0
    counts = Counter((folder, word) for _, _, folder, word in places)
    record = root / "tests/docs/words_left.txt"
    if arguments.record:
        record.write_text(record_of(counts))
        return 0
    rose, fell = judged(counts, recorded(record))
    print("\n".join(fell))
    print("\n".join(wrong + rose), file=sys.stderr)
    return 1 if wrong or rose else 0


if __name__ == "__main__":
    sys.exit(main())
