"""The cache ignores anything that another user could have written."""

import os

import pytest
import test_cache
from test_cache import ELSE, KEY, as_root

from normalbench.bench.ground.output import cache
from normalbench.bench.shaders.isa import null_device

folder = test_cache.folder


@as_root
def test_a_cache_of_another_user_is_not_used_and_doctor_reports_it(run, folder):
    folder.mkdir(parents=True)
    os.chown(folder, ELSE, ELSE)
    cache.write(KEY, {})
    assert not [*folder.iterdir()]
    with pytest.raises(null_device.NullDeviceError, match="another user's folder; set XDG_CACHE_HOME to another"):
        null_device.library()
    _, out, _ = run("doctor", "--format", "csv")
    assert f"no: another user's folder: {folder}; name another folder with XDG_CACHE_HOME" in out
