"""Bad captures: each is refused in one line, and the process lives on."""

import pytest
from attack.files import ENDINGS, picture

from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.subjects.normals.captures import Reading, capture


@pytest.mark.parametrize("kind", ["png8", "tiff", "float tiff", "dds", "hdr", "webp"])
def test_a_truncated_image_is_one_line(tmp_path, capfd, kind):
    data = picture(tmp_path, kind)
    path = tmp_path / f"a.{ENDINGS.get(kind, kind)}"
    for share in (0.3, 0.9):
        path.write_bytes(data[: int(share * len(data))])
        with pytest.raises(UsageError, match=r"cut off or damaged; save it again"):
            capture(path, Reading(normalise=True, unpack=True))
    assert capfd.readouterr() == ("", "")
