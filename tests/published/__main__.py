"""A command that measures figures of articles, books and engines, and prints a verdict on each.

    python -m tests.published [WORDS]

WORDS are words of sources' names, comma-separated, such as `cigolle,tyler`. Exit status: 1 if a figure differs
without a reason. `python -m tests.manual_tables --write "published figures"` writes the manual's page.
"""

import sys

from .rows import rows, text, unexplained

measured = rows(*sys.argv[1:2])
print(text(measured, 120))
wrong = unexplained(measured)
print(*wrong, sep="\n", end="\n" * bool(wrong), file=sys.stderr)
sys.exit(bool(wrong) or not measured)
