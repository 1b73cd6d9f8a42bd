"""What is wrong with a page by the rules of HTML."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

import html5lib

# Attributes that name other elements by their ids.
REFERENCES = ("for", "aria-labelledby", "aria-describedby", "aria-controls", "headers", "list")
# What belongs into the head alone.
OF_HEAD = ("style", "title", "base", "meta")


def faults(text: str) -> list[str]:
    """Errors of the parser, ids that are there twice or not at all, and elements that belong elsewhere."""
    parser = html5lib.HTMLParser(namespaceHTMLElements=False)
    tree = parser.parse(text)
    return [f"line {line}: {code}" for (line, _), code, _ in parser.errors] + list(_of_tree(tree))


def _of_tree(tree) -> Iterator[str]:
    elements = [one for one in tree.iter() if isinstance(one.tag, str)]
    ids = Counter(one.get("id") for one in elements if one.get("id"))
    yield from (f"{name}: {count} elements have this id" for name, count in ids.items() if count > 1)
    for one in elements:
        words = " ".join(one.get(name, "") for name in REFERENCES).split()
        yield from (f"{one.tag}: nothing has the id {word}" for word in words if word not in ids)
    yield from (f"{one.tag} in the body" for name in OF_HEAD for one in tree.find("body").iter(name))
