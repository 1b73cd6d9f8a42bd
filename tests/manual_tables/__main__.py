"""A command that measures tables of the manual and writes them into their pages, and their data into `kept`.

    python -m tests.manual_tables --write [MARKER ...]

Without a marker all tables are measured, which takes most of an hour. The page's conclusions are checked first.
"""

import argparse
import sys

from .measuring import measure
from .table import page_with
from .tables import TABLES

parser = argparse.ArgumentParser(prog="python -m tests.manual_tables", description=__doc__)
parser.add_argument("--write", nargs="*", choices=[[], *TABLES], metavar="MARKER", required=True)
for marker in parser.parse_args().write or TABLES:
    print(marker, file=sys.stderr)
    table = TABLES[marker]
    measured = measure(table)
    table.holds(measured.lines)
    table.keep(measured)
    path, page = page_with(marker)
    before, _, after = table.parts(page)
    path.write_text(before + table.text(table, measured) + after)
