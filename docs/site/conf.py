# SPDX-License-Identifier: BSL-1.0
"""Sphinx's settings for the site; docs/site/build.sh runs it over the root of the project."""
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from docutils import nodes
from pybtex.plugin import register_plugin
from pybtex.style.formatting.plain import Style
from sphinx import addnodes
from sphinx.domains.cpp import CPPDomain
from sphinx.transforms import SphinxTransform

sys.path.insert(0, str(Path(__file__).parent))
import markdown
import sources

root = Path(__file__).resolve().parents[2]

project = "nysalt"
version = release = re.search(r"version = \"(.*)\"", (root / "include/nysalt/version.hpp").read_text()).group(1)
commit = ""  # of a folder without git, or where git is not installed
if shutil.which("git"):
    commit = subprocess.run(["git", "-C", root, "describe", "--always", "--dirty", "--exclude=*"], capture_output=True,
                            text=True).stdout.strip()
extensions = ["myst_parser", "breathe", "sphinxcontrib.bibtex", "sphinx_copybutton"]

# Pages.
root_doc = "README"
include_patterns = ["*.md", "docs/**.md", "examples/*.md", "api/**.rst", "sources/**.rst"]
exclude_patterns = ["docs/site", "src", "include", "tests", "bench", "python", "cmake"]
nitpicky = True
nitpick_ignore_regex = [("cpp:.*", ".*")]  # names of C++, Eigen's and the standard's among them
smartquotes = False
highlight_language = "text"
myst_heading_anchors = 6

# The C++ interface.
breathe_projects = {"nysalt": os.environ["NYSALT_SITE_XML"]}
breathe_default_project = "nysalt"
copybutton_selector = ".highlight-cpp pre, .highlight-python pre, .highlight-sh pre, .highlight-cmake pre"
primary_domain = "cpp"

# The bibliography: works by their keys, as the program and the comments name them.
bibtex_bibfiles = ["docs/bibliography.bib"]
bibtex_default_style = "by_key"
bibtex_cite_id = "{key}"

# Theme and layout.
html_theme = "furo"
html_title = "nysalt"
html_static_path = ["site.css"]
html_css_files = ["site.css"]
html_copy_source = False
html_show_sphinx = html_show_copyright = False
templates_path = ["templates"]
html_sidebars = {"**": ["sidebar/scroll-start.html", "sidebar/brand.html", "version.html", "sidebar/search.html",
                        "sidebar/navigation.html", "sidebar/scroll-end.html"]}
# NYSALT_SITE_VERSIONS is `NAME=URL ...` of sites of other versions, to which the sidebar links.
html_context = {"commit": commit,
                "versions": [other.split("=", 1) for other in os.environ.get("NYSALT_SITE_VERSIONS", "").split()]}


class ByKey(Style):
    def __init__(self, **options):
        super().__init__(**options)
        self.sort = lambda entries: sorted(entries, key=lambda entry: entry.key)
        self.format_labels = lambda entries: (entry.key for entry in entries)

    def format_entry(self, label, entry, bib_data=None):
        entry.fields["title"] = entry.fields["title"].replace(r"$\phi^4$", "phi^4")
        return super().format_entry(label, entry, bib_data)


register_plugin("pybtex.style.formatting", "by_key", ByKey)


def add_what_only_the_site_needs(app, page, source):
    """The pages are for a forge too: tables of contents follow from the lists of links in README.md."""
    file = root / f"{page}.md"
    if not file.exists():
        return
    text = source[0]
    for address, path in sources.linked(root, file).items():
        if target := sources.page_of(root, path):
            text = text.replace(f"]({address})", f"](/{target})")
    if not text.startswith("# "):  # tables that programs write: their title is that of the link to them
        text = f"# {titles.get(page, page)}\n\n{text}"
    if page == root_doc:
        text += toctree("", ["docs/README"])
        for title, section in sections:
            text += toctree(f":caption: {title}", linked_pages("docs/README", section))
        text += toctree(":caption: C++ interface", ["api/index"])
    elif page.endswith("/README") and page != "docs/README":
        inside = [other for other in linked_pages(page, text) if other.startswith(page.removesuffix("README"))]
        text += toctree("", inside) if inside else ""
    elif page == "docs/bibliography":
        text += "\n```{bibliography}\n:all:\n```\n"
    source[0] = text


def linked_pages(page, text):
    """Those that a text of a page links to, in order."""
    targets = [os.path.normpath(os.path.join(os.path.dirname(page), address)) for address in markdown.links(text)]
    return [target.removesuffix(".md") for target in dict.fromkeys(targets) if target.endswith(".md")]


def toctree(caption, pages):
    lines = "".join(f"/{page}\n" for page in pages if page != root_doc)
    return f"\n\n```{{toctree}}\n:hidden:\n{caption}\n\n{lines}```\n"


index = (root / "docs/README.md").read_text()
sections = [section.split("\n", 1) for section in index.split("\n## ")[1:]]
titles = {page: link.group(2) for link in markdown.link.finditer(index)
          for page in linked_pages("docs/README", link.group())}


class Citations(SphinxTransform):
    """Keys of the bibliography, and docs/PAGE.md, in texts and comments are links."""
    default_priority = 5
    name = re.compile(r"\b[a-z]+(?:_[a-z]+)*_(?:18|19|20)\d\d\b|\bdocs/[\w/-]+\.md\b")
    kept = (nodes.FixedTextElement, nodes.literal, nodes.reference, nodes.title, addnodes.pending_xref)

    def apply(self):
        for text in list(self.document.findall(nodes.Text)):
            parts = list(self.name.finditer(text))
            if parts and not any(isinstance(node, self.kept) for node in ancestors(text)):
                new, end = [], 0
                for part in parts:
                    new += [nodes.Text(text[end:part.start()]), self.link(part.group())]
                    end = part.end()
                text.parent.replace(text, [*new, nodes.Text(text[end:])])

    def link(self, name):
        is_page = name.endswith(".md")
        domain, kind, target = ("std", "doc", f"/{name.removesuffix('.md')}") if is_page else ("cite", "label", name)
        return addnodes.pending_xref("", nodes.inline("", name), refdomain=domain, reftype=kind, reftarget=target,
                                     refexplicit=True, refwarn=True, refdoc=self.env.docname)


class Names(CPPDomain):
    """Without names of parameters, which are many; what can only be one of these or of other libraries is no link."""
    known = None

    def get_objects(self):
        return (found for found in super().get_objects() if not found[2].endswith("Param"))

    def resolve_xref(self, env, fromdocname, builder, typ, target, node, contnode):
        if self.known is None:
            self.known = {re.findall(r"\w+", name)[-1] for name, *_ in self.get_objects()}
        if target.split("::")[-1] in self.known:
            return super().resolve_xref(env, fromdocname, builder, typ, target, node, contnode)
        return None


def open_citations(app, doctree, page):
    """docutils 0.19 takes the last sibling for one before the first, and would close a list that it has not opened."""
    for citation in list(doctree.findall(nodes.citation)):
        if citation.parent.index(citation) == 0:
            citation.parent.insert(0, nodes.comment())


def ancestors(node):
    while node.parent is not None:
        node = node.parent
        yield node


def setup(app):
    app.connect("source-read", add_what_only_the_site_needs)
    app.connect("doctree-resolved", open_citations)
    app.add_transform(Citations)
    app.add_domain(Names, override=True)
