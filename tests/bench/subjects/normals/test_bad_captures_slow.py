"""Bad captures, each refused with a one-line error that does not end the process."""

import numpy as np
import pytest
from attack.files import ENDINGS, picture
from written import planes_of, some_normals, write_exr

from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.subjects.normals.captures import Reading, capture


@pytest.mark.parametrize("share", [0.0, 0.01, 0.5, 0.9, 0.999])
def test_truncated_exr_is_a_one_line_error(tmp_path, capfd, share):
    """The library's own output is not shown."""
    path = write_exr(tmp_path / "frame.exr", planes_of(some_normals()), compression="zip")
    data = path.read_bytes()
    path.write_bytes(data[: max(int(share * len(data)), 4)])
    with pytest.raises(UsageError, match=r"frame.exr: .*cut off or damaged; save it again"):
        capture(path, Reading())
    assert capfd.readouterr() == ("", "")


def test_exr_of_wrong_size_or_sampling_is_a_one_line_error(tmp_path):
    """The header is changed to more pixels than are allowed, to far more, and to half the samples. No memory of that
    size is allocated."""
    path = write_exr(tmp_path / "frame.exr", planes_of(some_normals()), compression="zip")
    data, window = path.read_bytes(), np.array([0, 0, 63, 47], "<i4").tobytes()
    channel = b"N.X\0" + np.array([2, 0, 1, 1], "<i4").tobytes()
    assert data.count(window) == 2 and data.count(channel) == 1
    changes = {
        r"67108864 pixels of 3 channels; at most 33554432 pixels": (window, [0, 0, 2**13 - 1, 2**13 - 1]),
        r"far more pixels than the file can hold; at most 33554432 pixels": (window, [0, 0, 2**15 - 1, 2**15 - 1]),
        r"subsampled; save all channels at full resolution": (channel[4:], [2, 0, 2, 1]),
    }
    for message, (old, new) in changes.items():
        path.write_bytes(data.replace(old, np.array(new, "<i4").tobytes()))
        with pytest.raises(UsageError, match=message):
            capture(path, Reading())


@pytest.mark.parametrize("kind", ["png8", "tiff", "float tiff", "dds", "hdr", "webp"])
def test_truncated_image_is_a_one_line_error(tmp_path, capfd, kind):
    data = picture(tmp_path, kind)
    path = tmp_path / f"a.{ENDINGS.get(kind, kind)}"
    for share in (0.3, 0.9):
        path.write_bytes(data[: int(share * len(data))])
        with pytest.raises(UsageError, match=r"cut off or damaged; save it again"):
            capture(path, Reading(normalise=True, unpack=True))
    assert capfd.readouterr() == ("", "")
