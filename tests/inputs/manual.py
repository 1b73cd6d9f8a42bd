"""README.md and the pages of the manual, for tests of what they say."""

from pathlib import Path

ROOT = Path(__file__).parents[2]
README = ROOT / "README.md"
PAGES = {path: path.read_text() for path in (README, *sorted((ROOT / "docs").glob("*.md")))}


def table(marker: str) -> str:
    """The table under a marker, which one page has."""
    (text,) = [text for text in PAGES.values() if f"\n<!-- {marker} -->\n" in text]
    return text[text.index(f"\n<!-- {marker} -->\n") + 1 :].split("\n\n")[0]
