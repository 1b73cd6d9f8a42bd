"""CONTRIBUTING.md: its examples can be added to a copy of the code as described, and its commands exist."""

import re

from contributing import EXAMPLES, PAGE
from manual import ROOT


def test_each_example_has_the_stated_number_of_files_and_lines():
    """The table at the top of the page states both numbers."""
    rows = re.findall(r"^\| (an? \w+) +\| +(\d+) \| +(\d+) \|$", PAGE, re.M)
    counts = {name: (int(files), int(lines)) for name, files, lines in rows}
    assert counts == {name: (len(example.files), len(example.lines)) for name, example in EXAMPLES.items()}


def test_commands_and_paths_on_the_page_exist():
    targets = re.findall(r"^    make (\w+)", PAGE, re.M)
    makefile = (ROOT / "Makefile").read_text()
    assert targets and all(re.search(rf"^{target}:", makefile, re.M) for target in targets)
    for path in re.findall(r"(?:tests|docs|bench)/[\w/-]+(?:\.py|\.md)?", PAGE):
        is_example = any(path in name for example in EXAMPLES.values() for name in example.files)
        assert is_example or (ROOT / path).exists(), path
