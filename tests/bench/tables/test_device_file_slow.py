"""Device files: what is read of them, and that damaged, hostile and enormous ones are one line each."""

import json
import random

import devices as made

from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.tables.devices.device_file import read_device_file


def test_whatever_is_damaged_is_read_or_refused_in_one_line(tmp_path):
    """Bytes flipped, cut out and doubled at random."""
    random.seed(7)
    path, refused = tmp_path / "a.json", 0
    small = json.dumps(made.content(codecs=made.codec_rows()[:2])).encode()
    for _ in range(1500):
        data = bytearray(small)
        at, end = sorted(random.choices(range(len(data)), k=2))
        end = min(end, at + 40)
        how = random.randrange(4)
        if how == 0:
            data[at] = random.randrange(256)
        elif how == 1:
            del data[at:end]
        elif how == 2:
            data[at:at] = data[at:end]
        else:
            data[at:end] = random.choice([b"null", b"-1", b"[]", b"{}", b'"x"', b"1e400", b"true"])
        path.write_bytes(data)
        try:
            read_device_file(path)
        except UsageError as error:
            refused += 1
            assert str(error).startswith(f"{path}: ") and "\n" not in str(error).removeprefix(str(path)), data
    assert 1000 < refused < 1500, refused
