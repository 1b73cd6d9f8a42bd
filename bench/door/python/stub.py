"""The stub of `import normalbench` for type checkers and editors, made from the registry when the package is built.

setup.py writes it next to the package; for an editable install it is in the checkout.
"""

from __future__ import annotations

import textwrap

from ...ground.options.option import Field, fields_of
from ...run.workers.words import HELP
from ...tables.registry import TABLES
from ...tables.table import Table

HEAD = '''"""normalbench in Python: every table as a function, and codecs on arrays. Made by bench/door/python."""

from collections.abc import Mapping, Sequence
from typing import Any

from .bench.door.python.codecs import Codes as Codes
from .bench.door.python.codecs import decode as decode
from .bench.door.python.codecs import encode as encode
from .bench.door.python.codecs import encoding as encoding
from .bench.door.python.layouts import pack as pack
from .bench.door.python.layouts import unpack as unpack
from .bench.door.python.tables import Rows as Rows
from .encodings.codecs.codec import Codec as Codec
from .encodings.codecs.encoding import Encoding as Encoding
from .encodings.storages.storage import Storage as Storage

Named = str | Encoding | Storage
Names = Named | Sequence[Named | float] | Mapping[str, Any]

'''


def stub() -> str:
    """The text of the file."""
    return HEAD + "\n".join(map(_function, TABLES.values()))


def _function(table: Table) -> str:
    options = fields_of(table.options)
    arguments = "".join(f"\n    {name}: {field.option.help}" for name, field in options.items()) + f"\n    on: {HELP}"
    doc = textwrap.indent(f'"""{table.help}\n\nArgs:{arguments}\n"""', "    ")
    parameters = "".join(f"    {name}: {_type(field)} = ...,\n" for name, field in options.items())
    parameters += "    on: str | None = ...,\n"
    return f"def {table.name}(\n    *,\n{parameters}) -> Rows:\n{doc}\n"


def _type(field: Field) -> str:
    """Return the type of an option in the stub; for text, `Names` also covers lists and the caller's own values."""
    kind = "Names" if field.kind is str else field.kind.__name__
    return kind if field.default is not None else f"{kind} | None"
