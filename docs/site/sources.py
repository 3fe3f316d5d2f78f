#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Pages of the site that show the sources and folders to which our pages link: sources.py ROOT FOLDER."""
import sys
from pathlib import Path

import markdown
from api import group_of, page_of_group, title, write

languages = {".cpp": "cpp", ".hpp": "cpp", ".c": "c", ".h": "c", ".py": "python", ".sh": "sh", ".cmake": "cmake",
             ".txt": "text", ".toml": "toml", ".bib": "bibtex", ".cff": "yaml", "": "text"}


def language_of(path):
    return "cmake" if path.name == "CMakeLists.txt" else languages[path.suffix]


def page_of(root, path):
    """The page that shows a source or folder; None of other files, which can be downloaded."""
    inside = path.relative_to(root)
    if path.is_dir() and (path / "README.md").exists():
        return str(inside / "README")
    if path.is_dir() or path.suffix in languages:
        if inside.parts[:2] == ("include", "nysalt") and "core" not in inside.parts:
            header = "/".join(inside.parts[2:])
            return page_of_group(group_of(f"{header}/")) if path.is_dir() else f"api/{header}"
        return f"sources/{inside}"
    return None


def linked(root, page):
    """{address of a link: file or folder of the project that is no page}"""
    found = {address: (page.parent / address).resolve() for address in markdown.links(page.read_text()) if address[:1] != "#"}
    return {address: path for address, path in found.items()
            if path.exists() and path.is_relative_to(root) and path.suffix != ".md"}


def shown(root, path):
    """The page itself."""
    inside = path.relative_to(root)
    text = ":orphan:\n\n" + title(str(inside))
    if path.is_file():
        return f"{text}.. literalinclude:: /{inside}\n   :language: {language_of(path)}\n"
    for file in sorted(path.iterdir()):
        if file.suffix == ".md":
            text += f"- :doc:`/{inside / file.stem}`\n"
        elif file.is_file() and file.suffix in languages:
            text += f"- :doc:`{file.name} </{page_of(root, file)}>`\n"
    return text


def main():
    root, folder = (Path(argument).resolve() for argument in sys.argv[1:3])
    paths = {path for page in markdown.documents(root) for path in linked(root, page).values()}
    paths |= {file for path in paths if path.is_dir() for file in path.iterdir() if file.is_file()}
    for path in paths:
        page = page_of(root, path)
        if page and page.startswith("sources/"):
            write(folder / f"{page}.rst", shown(root, path))


if __name__ == "__main__":
    main()
