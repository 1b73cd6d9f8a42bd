"""Device files: reading them, and one-line errors for damaged, hostile and enormous files."""

import json
import random

import devices as made

from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.tables.devices.device_file import read_device_file


def test_damaged_file_is_read_or_refused_with_a_one_line_error(tmp_path):
    """Bytes are flipped, cut out and doubled at random."""
    random.seed(7)
    path, refused = tmp_path / "a.json", 0
    small = json.dumps(made.content(codecs=made.codec_rows()[:2])).encode()
    for _ in range(1500):
        data = bytearray(small)
        start, end = sorted(random.choices(range(len(data)), k=2))
        end = min(end, start + 40)
        how = random.randrange(4)
        if how == 0:
            data[start] = random.randrange(256)
        elif how == 1:
            del data[start:end]
        elif how == 2:
            data[start:start] = data[start:end]
        else:
            data[start:end] = random.choice([b"null", b"-1", b"[]", b"{}", b'"x"', b"1e400", b"true"])
        path.write_bytes(data)
        try:
            read_device_file(path)
        except UsageError as error:
            refused += 1
            assert str(error).startswith(f"{path}: ") and "\n" not in str(error).removeprefix(str(path)), data
    assert 1000 < refused < 1500, refused
