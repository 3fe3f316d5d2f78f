#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""The types of the package: stub.py --check | --update, with the built package on PYTHONPATH.

nysalt/__init__.pyi has the functions of nysalt/__init__.py with the keywords that their options give them. --update writes
it, --check says whether it differs.
"""
import ast
import inspect
import sys
from pathlib import Path

folder = Path(__file__).resolve().parents[2] / "python" / "nysalt"
default = ast.Constant(value=...)


def without_body(node, keywords=()):
    """The declaration of a function; keywords, (name, type), stand in the place of its argument `options`."""
    node.body, node.decorator_list = [ast.Expr(default)], []
    node.args.defaults = [default] * len(node.args.defaults)
    own = [(one, value and default) for one, value in zip(node.args.kwonlyargs, node.args.kw_defaults) if one.arg != "options"]
    own += [(ast.arg(arg=name, annotation=ast.parse(kind, mode="eval").body), default) for name, kind in keywords]
    node.args.kwonlyargs, node.args.kw_defaults = [list(each) for each in zip(*own)] if own else ([], [])
    return node


def attributes(method):
    """Those that __init__ declares."""
    return [ast.AnnAssign(target=ast.Name(id=one.target.attr), annotation=one.annotation, value=None, simple=1)
            for one in method.body if isinstance(one, ast.AnnAssign) and isinstance(one.target, ast.Attribute)]


def class_without_bodies(node):
    body = []
    for one in node.body:
        if isinstance(one, ast.FunctionDef):
            body += attributes(one) if one.name == "__init__" else []
            body.append(without_body(one))
        elif isinstance(one, ast.AnnAssign):
            body.append(one)
    node.body = body or [ast.Expr(default)]
    return node


def is_public(name):
    return not name.startswith("_") or name in ("__all__", "__version__", "_FromFile")


def stub(package):
    lines = ["# SPDX-License-Identifier: BSL-1.0", "# Written by docs/site/stub.py --update."]
    for node in ast.parse((folder / "__init__.py").read_text()).body:
        if isinstance(node, ast.FunctionDef) and is_public(node.name):
            shown = inspect.signature(getattr(package, node.name)).parameters.values()
            own = {one.arg for one in node.args.args + node.args.kwonlyargs}
            node = without_body(node, [(one.name, one.annotation) for one in shown
                                       if one.name not in own and one.kind is one.KEYWORD_ONLY])
        elif isinstance(node, ast.ClassDef) and is_public(node.name):
            node = class_without_bodies(node)
        elif isinstance(node, ast.AnnAssign) and is_public(node.target.id):
            node.value = None
        elif not isinstance(node, (ast.Import, ast.ImportFrom)) and not (
                isinstance(node, ast.Assign) and is_public(node.targets[0].id)):
            continue
        lines.append(ast.unparse(ast.fix_missing_locations(node)))
    return "\n".join(lines) + "\n"


def main():
    import nysalt
    page = folder / "__init__.pyi"
    if sys.argv[1:] == ["--update"]:
        page.write_text(stub(nysalt))
    elif sys.argv[1:] != ["--check"]:
        sys.exit(__doc__)
    elif not page.is_file() or page.read_text() != stub(nysalt):
        sys.exit(f"{page.name} differs from the options: docs/site/stub.py --update")


if __name__ == "__main__":
    main()
