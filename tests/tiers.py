"""The tiers of tests. A test file's name ends in its tier; other files are quick. A tier includes lower tiers."""

from pathlib import Path

TIERS = ("quick", "slow", "nightly")


def tier_of(path: Path) -> str:
    """Return the tier of a test file."""
    return next((tier for tier in TIERS if path.stem.endswith(f"_{tier}")), TIERS[0])


def is_in(path: Path, last: str) -> bool:
    """Whether a test file is run when this is the last tier."""
    return TIERS.index(tier_of(path)) <= TIERS.index(last)


def files_of(tests: Path, name: str) -> list[Path]:
    """Return the test files below a folder with a name in any tier: `test_x`, `test_x_slow` and so on."""
    return [path for end in ("", *(f"_{tier}" for tier in TIERS)) for path in tests.rglob(f"{name}{end}.py")]
