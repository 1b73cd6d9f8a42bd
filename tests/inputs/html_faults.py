"""Violations of the rules of HTML in a page."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

import html5lib

# Attributes that name other elements by their ids.
REFERENCES = ("for", "aria-labelledby", "aria-describedby", "aria-controls", "headers", "list")
# What belongs into the head alone.
OF_HEAD = ("style", "title", "base", "meta")


def faults(text: str) -> list[str]:
    """Return the parser's errors, duplicate or missing ids, and elements in the wrong place."""
    parser = html5lib.HTMLParser(namespaceHTMLElements=False)
    tree = parser.parse(text)
    return [f"line {line}: {code}" for (line, _), code, _ in parser.errors] + list(_of_tree(tree))


def _of_tree(tree) -> Iterator[str]:
    elements = [element for element in tree.iter() if isinstance(element.tag, str)]
    ids = Counter(element.get("id") for element in elements if element.get("id"))
    yield from (f"{name}: {count} elements have this id" for name, count in ids.items() if count > 1)
    for one in elements:
        words = " ".join(one.get(name, "") for name in REFERENCES).split()
        yield from (f"{one.tag}: nothing has the id {word}" for word in words if word not in ids)
    yield from (f"{element.tag} in the body" for name in OF_HEAD for element in tree.find("body").iter(name))
