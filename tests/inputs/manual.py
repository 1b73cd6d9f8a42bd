"""README.md and the pages of the manual, for tests of their statements."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
README = ROOT / "README.md"
# An example is a fenced block under the name of its file.
NAMED = re.compile(r"^<!-- file (\S+) -->\n```(?:glsl|hlsl|json|python|toml)\n(.*?)^```$", re.S | re.M)
PAGES = {path: path.read_text() for path in (README, *sorted((ROOT / "docs").rglob("*.md")))}
