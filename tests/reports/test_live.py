"""The laboratory of a page in a browser with WebGL2: controls, pixels, encoders, and what it survives."""

import json

from normalbench.reports.page.live import Live, script


def test_no_text_of_a_run_ends_its_script():
    hostile = {"encoding": "</script><b>", "storage": "x", "rounding": "nearest", "source": "</script>"}
    made = Live([hostile], []).data({"run": "</script>"})
    assert json.loads(made)["codecs"][0]["label"] == "</script><b> x", "it is packed before it is put into a page"
    assert "</script" not in script()
