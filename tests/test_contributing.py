"""What CONTRIBUTING.md says is added as it says, in a copy of the code; and its commands are there."""

import re

from contributing import EXAMPLES, PAGE
from manual import ROOT


def test_each_example_has_the_files_and_lines_that_it_says():
    """The table at the top counts them."""
    rows = re.findall(r"^\| (an? \w+) +\| +(\d+) \| +(\d+) \|$", PAGE, re.M)
    said = {name: (int(files), int(lines)) for name, files, lines in rows}
    assert said == {name: (len(one.files), len(one.lines)) for name, one in EXAMPLES.items()}


def test_its_commands_are_those_of_the_makefile_and_of_the_tests():
    targets = re.findall(r"^    make (\w+)", PAGE, re.M)
    makefile = (ROOT / "Makefile").read_text()
    assert targets and all(re.search(rf"^{target}:", makefile, re.M) for target in targets)
    for path in re.findall(r"(?:tests|docs|bench)/[\w/-]+(?:\.py|\.md)?", PAGE):
        is_example = any(path in name for one in EXAMPLES.values() for name in one.files)
        assert is_example or (ROOT / path).exists(), path
