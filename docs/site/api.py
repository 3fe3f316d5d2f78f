#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""The C++ interface for Breathe, of the comments that Doxygen reads: api.py ROOT FOLDER [--undocumented].

FOLDER/xml has what Doxygen says of the public headers, and FOLDER/api a page for each of them and for each group.
--undocumented only lists the public names without a comment, as FILE:LINE: SENTENCE. No comment of its own needs

- a member that a concept asks for: members.txt has its sentence;
- a declaration with a `// remark` behind it, or right below a commented overload;
- a constructor, a destructor or a deduction guide.
"""
import re
import subprocess
import sys
import xml.etree.ElementTree as xml
from pathlib import Path

# Every public header belongs to one group: files without .hpp, and folders.
groups = {
    "Entry points": "nysalt core learn analyse parallel odeint mpi version",
    "Scalars and states": "scalar scalars/ phase_point lanes",
    "Systems": "system local_system force energy systems/ model plugin system_declaration",
    "Baths and noise": "bath noise noises/ langevin",
    "Flows and words": "flow flows/ letters word stepper",
    "Families and methods": "family families/ method methods/",
    "Initial states": "ensemble ensembles/ initial_states",
    "References": "reference references/",
    "Learning": "flow_map_data losses/ learning/",
    "Runs": "integrate divergence integrate_ensemble ensemble_run distributed_run judgement hmc",
    "Stability and derivatives": "derivatives/",
    "Errors and statistics": "analysis/",
    "Comparisons": "compare recommend comparison_options export_to",
    "Ranks and files": "communicator communicators/ execution shard atomic_file",
}
internal = {"core", "kernels", "parallel", "stepping", "requirements.hpp"}


def public_headers(root):
    """{path below include/nysalt: text}"""
    folder = root / "include/nysalt"
    paths = (path for path in sorted(folder.rglob("*.hpp")) if internal.isdisjoint(path.relative_to(folder).parts))
    return {str(path.relative_to(folder)): path.read_text() for path in paths}


def group_of(path):
    """None if there is none."""
    def has(names):
        return any(path == f"{name}.hpp" or name.endswith("/") and path.startswith(name) for name in names.split())
    return next((group for group, names in groups.items() if has(names)), None)


def page_of_group(group):
    return "api/" + re.sub(r"\W+", "-", group.lower())


def read_members(text):
    """[(places, {name: sentence})] of members.txt."""
    sections = []
    for line in text.splitlines():
        if line.startswith("["):
            sections.append((tuple(line.strip("[]").split()), {}))
        elif line and not line.startswith("#"):
            name, sentence = line.split(None, 1)
            sections[-1][1][name] = sentence
    return sections


def sentence_for(members, path, name):
    """Of a member in a header; None if it needs a comment of its own."""
    for places, sentences in members:
        if name in sentences and any(path.startswith(place) if place.endswith("/") else path == place for place in places):
            return sentences[name]
    return None


def is_table(line):
    """Whether a line of a comment is one of a table made of spaces, of a formula or of code."""
    return bool(re.match(r" *///( {2,}\S| ?\S.*\S {2,}\S)", line))


def staged(text):
    """The header for Doxygen: the comment above `#pragma once` is that of the file, and tables keep their spaces."""
    lines = text.split("\n")
    pragma = lines.index("#pragma once") if "#pragma once" in lines else 0
    lines[:pragma] = ["/// @file", *(re.sub("^//(?=\\s|$)", "///", line) for line in lines[1:pragma])][:pragma]
    tables = [is_table(line) for line in lines]
    for i in range(1, len(lines) - 1):  # a row may go on at the margin
        tables[i] |= tables[i - 1] and is_table(lines[i + 1]) and lines[i].strip().startswith("/// ")
    out = []
    for i, line in enumerate(lines):
        margin = line[:len(line) - len(line.lstrip())]
        begins = tables[i] and not tables[i - 1]
        ends = tables[i] and not tables[i + 1]
        out += [f"{margin}/// @code{{.txt}}"] * begins + [line] + [f"{margin}/// @endcode"] * ends
    return "\n".join(out)


def run_doxygen(folder, headers):
    """What Doxygen complains of."""
    for path, text in headers.items():
        file = folder / "include/nysalt" / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
    settings = (Path(__file__).parent / "Doxyfile").read_text()
    settings += f"\nINPUT = {folder}/include\nSTRIP_FROM_PATH = {folder}/include\nOUTPUT_DIRECTORY = {folder}\n"
    result = subprocess.run(["doxygen", "-"], input=settings, stderr=subprocess.PIPE, text=True, check=False)
    if result.returncode:
        sys.exit(result.stderr)
    return [line.replace(f"{folder}/", "") for line in result.stderr.splitlines()]


def is_documented(entity):
    parts = [part for tag in ("brief", "detailed", "inbody") for part in entity.findall(f"{tag}description")]
    return any(text_of(part) for part in parts)


def text_of(element):
    return " ".join("".join(element.itertext()).split())


def path_of(entity):
    return entity.find("location").get("file").removeprefix("nysalt/")


def line_of(entity):
    return path_of(entity), int(entity.find("location").get("line"))


def remark_on(line, declaration):
    """The sentence that a line of code says behind its declaration, and why an overload is deleted."""
    found = re.search(r"[;}]\s+// (.*)$", line)
    if declaration.endswith("=delete"):
        return f"Refused: {found.group(1)}." if found else "Refused."
    return found.group(1)[0].upper() + found.group(1)[1:] + "." if found else None


class Interface:
    """Doxygen's XML of the headers, completed, and in the form that Breathe shows well: names are those in namespace
    nysalt, and free functions belong to their header."""

    def __init__(self, folder, headers, members):
        self.lines = {path: text.split("\n") for path, text in headers.items()}
        self.members = members
        self.used = set()  # the sentences of members.txt that a member needs
        self.undocumented = set()
        trees = {path: xml.parse(path) for path in sorted((folder / "xml").glob("*.xml")) if path.name != "index.xml"}
        compounds = [tree.getroot().find("compounddef") for tree in trees.values()]
        compounds = [compound for compound in compounds if compound is not None and compound.get("prot") != "private"]
        self.classes = {compound.findtext("compoundname") for compound in compounds}
        self.compounds = [compound for compound in compounds if compound.find("location") is not None]
        self.files = {path_of(compound): compound for compound in compounds if compound.get("kind") == "file"}
        self.concepts = [compound for compound in compounds if compound.get("kind") == "concept"]
        for compound in compounds:
            self.complete(compound)
        for compound in compounds:
            if compound.get("kind") == "namespace":
                self.move_members(compound)
        self.known = {entity.get("id") for compound in compounds if compound.get("kind") != "file"
                      for entity in [compound, *compound.iter("memberdef")]}
        self.known |= {entity.get("id") for compound in self.files.values() for entity in compound.iter("memberdef")}
        index = folder / "xml/index.xml"
        index.write_text(re.sub(r'(kind="concept"><name>)nysalt::', r"\1", index.read_text()))
        for path, tree in trees.items():
            text = xml.tostring(tree.getroot(), encoding="unicode")
            path.write_text(re.sub(r'<ref refid="([^"]*)"[^>]*>([^<]*)</ref>', self.known_link, text))

    def known_link(self, found):
        return found.group() if found.group(1) in self.known else found.group(2)

    def brief(self, path):
        """What the header says of itself, or of the first thing in it."""
        inside = [compound for compound in self.compounds if path_of(compound) == path and compound.get("kind") != "file"]
        inside += self.files[path].findall("sectiondef/memberdef")
        briefs = [text_of(entity.find("briefdescription")) for entity in [self.files[path], *sorted(inside, key=line_of)]]
        return next(filter(None, briefs), "")

    def complete(self, compound):
        name = compound.findtext("compoundname")
        kind = compound.get("kind")
        for shown_elsewhere in [*compound.findall("includes"), *compound.findall("innernamespace")]:
            compound.remove(shown_elsewhere)
        # A table does not say what a concept is.
        says = text_of(compound.find("briefdescription")) if kind == "concept" else is_documented(compound)
        if kind in ("class", "struct", "concept"):
            compound.find("compoundname").text = name.removeprefix("nysalt::")
            if not says:
                self.miss(compound, kind, name)
        documented = ("", None)  # name and description of the last member
        for section in compound.findall("sectiondef"):
            for member in sorted(section.findall("memberdef"), key=line_of):
                if f"{name}::{member.findtext('name')}" in self.classes and member.get("kind") == "function":
                    section.remove(member)  # a deduction guide
                elif member.get("prot") == "public" and (member.get("kind") != "friend" or member.findtext("argsstring")):
                    documented = self.complete_member(name, member, documented)
                self.simplify(member)

    def move_members(self, namespace):
        """From the namespace to the files where they are."""
        for section in namespace.findall("sectiondef"):
            namespace.remove(section)
            of_file = {}
            for member in sorted(section.findall("memberdef"), key=line_of):
                path = path_of(member)
                if path not in of_file:
                    of_file[path] = xml.SubElement(self.files[path], "sectiondef", kind=section.get("kind"))
                of_file[path].append(member)

    def complete_member(self, owner, member, before):
        name = member.findtext("name")
        path, line = line_of(member)
        if not is_documented(member):
            sentence = sentence_for(self.members, path, name)
            if sentence:
                self.used.add(sentence)
            else:
                sentence = remark_on(self.lines[path][line - 1], member.findtext("argsstring") or "")
            if not sentence and before[0] == name:
                sentence = before[1]
            if sentence:
                xml.SubElement(member.find("briefdescription"), "para").text = sentence
            elif name.lstrip("~") != owner.split("::")[-1]:
                self.miss(member, member.get("kind"), member.findtext("qualifiedname") or name)
        return name, text_of(member.find("briefdescription"))

    def miss(self, entity, kind, name):
        self.undocumented.add((*line_of(entity), f"{kind.capitalize()} {name} has no comment"))

    @staticmethod
    def simplify(member):
        """Without what Sphinx cannot read: initial values that are code, and ' in numbers."""
        value = member.find("initializer")
        if value is not None and re.search(r"[\[{]|\brequires\b", "".join(value.itertext())):
            member.remove(value)
        for text in [*member.iter("defval"), *member.findall("argsstring")]:
            if "'" in (text.text or ""):
                text.text = re.sub(r"(?<=\d) *'(?=\d)", "", text.text)


def escaped(text):
    """Text as reStructuredText."""
    return re.sub(r"([\\*`_|])", r"\\\1", " ".join(text.split()))


def title(text):
    return f"{text}\n{'=' * len(text)}\n\n"


def write(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)


def write_pages(folder, headers, interface):
    """A page for each group, with its headers, and one for each header, which is in no table of contents."""
    of_group = {group: [path for path in headers if group_of(path) == group] for group in groups}
    listed = "".join(f"   /{page_of_group(group)}\n" for group, paths in of_group.items() if paths)
    write(folder / "api/index.rst", title("C++ interface") +
          "The public headers by what they are for. What a type must offer to take part is on the pages of the\n"
          ":doc:`concepts </docs/concepts/README>`. All names are in the :ref:`index <genindex>`.\n\n"
          f".. toctree::\n\n{listed}")
    for group, paths in of_group.items():
        if not paths:
            continue
        rows = [f"* - :doc:`{path} </api/{path}>`\n  - {escaped(interface.brief(path))}\n" for path in paths]
        table = "".join(rows).replace("\n", "\n   ").rstrip()
        write(folder / f"{page_of_group(group)}.rst", f"{title(group)}.. list-table::\n\n   {table}\n")
    for path in headers:
        text = ":orphan:\n\n" + title(path)
        text += f"Of :doc:`{group_of(path)} </{page_of_group(group_of(path))}>`: ``#include <nysalt/{path}>``\n\n"
        text += f".. cpp:namespace:: nysalt\n\n.. doxygenfile:: nysalt/{path}\n"
        for concept in interface.concepts:
            if path_of(concept) == path:
                code = "".join(concept.find("initializer").itertext()).strip().replace("concept nysalt::", "concept ")
                text += f"\n.. doxygenconcept:: {concept.findtext('compoundname')}\n\n"
                text += ".. code-block:: cpp\n\n   " + code.replace("\n", "\n   ") + "\n"
        write(folder / f"api/{path}.rst", text)


def main():
    root, folder = (Path(argument).resolve() for argument in sys.argv[1:3])
    only_lists = sys.argv[3:] == ["--undocumented"]
    headers = public_headers(root)
    shown = headers if only_lists else {path: staged(text) for path, text in headers.items()}
    wrong = run_doxygen(folder, shown)
    members = read_members((Path(__file__).parent / "members.txt").read_text())
    interface = Interface(folder, shown, members)
    if only_lists:  # of lines as they are in the headers, in whose tables Doxygen sees mistakes
        for file, line, sentence in sorted(interface.undocumented):
            print(f"include/nysalt/{file}:{line}: {sentence}")
        return 0
    wrong += [f"include/nysalt/{file}: {sentence}" for file, _, sentence in sorted(interface.undocumented)]
    wrong += [f"include/nysalt/{path} belongs to no group of docs/site/api.py"
              for path in headers if not group_of(path)]
    print("".join(f"{sentence}\n" for sentence in wrong), end="", file=sys.stderr)
    write_pages(folder, {path: text for path, text in headers.items() if group_of(path)}, interface)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
