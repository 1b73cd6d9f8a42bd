"""The laboratory of a page in a browser with WebGL 2: controls, pixels, encoders and recovery from faults."""

import json

from normalbench.reports.page.live import Live, script


def test_text_from_a_run_cannot_end_the_script():
    hostile = {"encoding": "</script><b>", "storage": "x", "rounding": "nearest", "source": "</script>"}
    text = Live([hostile], []).data({"run": "</script>"})
    assert json.loads(text)["codecs"][0]["label"] == "</script><b> x", "it is packed before it is put into a page"
    assert "</script" not in script()
