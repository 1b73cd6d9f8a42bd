"""The sandbox of the process that translates a file, tested with the text filter disabled."""

import json
import subprocess

import pytest

from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.ground.user_files import UserFile
from normalbench.bench.shaders.languages import translated

pytestmark = pytest.mark.usefixtures("slang")


MINE = (
    "float2 p_encode(float3 n) { return n.xy * secret(); }\n"
    "float3 p_decode(float2 e) { return float3(e, sqrt(saturate(1.0 - dot(e, e)))); }\n"
)


def test_translation_cache_depends_on_the_text_filter():
    """Otherwise a text that an earlier check accepted would be measured forever."""
    names = {f"{path.parent.name}/{path.name}" for path in translated.sources_of_this()}
    assert {"compilers/text.py", "compilers/lines.py", "languages/slang.py", "translator/tree.py"} <= names


GOOD = {"name": "a", "prefix": "a", "components": 2, "packed": "", "notes": [], "texts": ["", ""], "text": ""}


GOOD |= {"functions": [], "read_by": "", "named": "", "shaped": {}}


SAID = {
    "a path": json.dumps(GOOD | {"prefix": "../../out/pwned"}),
    "another type": json.dumps(GOOD | {"texts": [1, 2]}),
    "a number": "5",
    "no end": "[" * 10**5,
    "odd pairs": '{"pairs": 1}',
    "no JSON": "x",
}


@pytest.mark.parametrize("name", SAID)
def test_answer_of_a_compromised_process_writes_nothing_elsewhere(tmp_path, monkeypatch, name):
    """A compromised compiler may print anything; the answer becomes a one-line error and is never used as a path."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    path = tmp_path / "mine.hlsl"
    path.write_text(MINE)
    done = subprocess.CompletedProcess([], 0, SAID[name], "")
    monkeypatch.setattr(translated.children, "finished", lambda *_: done)
    with pytest.raises(UsageError) as refused:
        translated.translated(UserFile(str(path)))
    assert str(refused.value).isprintable()
    assert not (tmp_path / "out").exists()


def test_error_from_the_process_is_a_one_line_error(tmp_path, monkeypatch):
    path = tmp_path / "mine.hlsl"
    path.write_text(MINE)
    stdout = json.dumps({"error": "a\x1b[31m\nnormalbench: all is well"})
    monkeypatch.setattr(translated.children, "finished", lambda *_: subprocess.CompletedProcess([], 0, stdout, ""))
    with pytest.raises(UsageError, match=r"^a \[31m normalbench: all is well$"):
        translated.translated(UserFile(str(path)))
