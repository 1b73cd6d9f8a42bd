"""The sandbox of the process that translates a file, tested with the text filter disabled."""

import json
import os
import subprocess
import sys

import pytest
from test_wall import MINE

from normalbench.bench.ground.machine import children
from normalbench.bench.ground.machine.systems import landlock

pytestmark = pytest.mark.usefixtures("slang")


# The process as it is, but for a fault: Slang's compiler is given whatever stands here in front of each text.
FAULT = """
import runpy, sys
from normalbench.bench.ground.compilers import slang
from normalbench.bench.ground.machine.systems import landlock
from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.shaders.languages import translated

def unjudged(text, options, folder):
    {attempt}
    (folder / slang.GIVEN).write_text({head!r} + text)
    return slang.Compiled([str(folder / slang.GIVEN), "-enable-machine-readable-diagnostics", *options])

slang.compiled = unjudged
landlock.is_available = lambda: {is_walled}
runpy.run_module("normalbench.bench.shaders.languages.child", run_name="__main__")
"""


NOTE = "float secret() { return 1.2345; }\n"


@pytest.fixture
def wall():
    if not landlock.is_available():
        assert not os.environ.get("CI"), "no Landlock here"
        pytest.skip("no Landlock here")


def answer(tmp_path, head="", attempt="pass", is_walled=True, code=MINE):
    """Return the answer of the process to a file with a fault, and its output."""
    (tmp_path / "own").mkdir(exist_ok=True)
    (tmp_path / "work").mkdir(exist_ok=True)
    path = tmp_path / "own" / "mine.hlsl"
    path.write_text(code)
    fault = FAULT.format(head=head, attempt=attempt, is_walled=is_walled)
    words = [sys.executable, "-P", "-c", fault, str(tmp_path / "work"), str(path), "", "normal", "0:0"]
    done = subprocess.run(words, capture_output=True, encoding="utf-8", env=children.environment())
    assert done.stdout, done.stderr
    return json.loads(done.stdout), done.stdout + done.stderr


@pytest.mark.usefixtures("wall")
@pytest.mark.parametrize("way", ["#include", "import", "__include"])
def test_unchecked_include_cannot_read_a_file(tmp_path, way):
    """Without the sandbox the file is read, so the fault is real."""
    note = tmp_path / "note.slang"
    note.write_text(("implementing mine;\n" if way == "__include" else "") + NOTE)
    head = f'{way} "{note}"' + ("\n" if way == "#include" else ";\n")
    open_answer, _ = answer(tmp_path, head, is_walled=False)
    walled_answer, printed = answer(tmp_path, head)
    assert way == "__include" or "1.2345" in open_answer["texts"][0], open_answer
    assert "error" in walled_answer and "1.2345" not in printed and "secret() {" not in printed, walled_answer


ATTEMPTS = {
    "open": "open('/etc/passwd').read()",
    "list": "__import__('os').listdir('/')",
    "write": "open({elsewhere!r}, 'w')",
    "start": "__import__('subprocess').run(['/bin/sh', '-c', 'echo started'])",
    "start itself": "__import__('subprocess').run([{python!r}, '-c', 'open(\"/etc/passwd\")'], check=True)",
    "connect": "__import__('socket').create_connection(('127.0.0.1', 9))",
}


@pytest.mark.usefixtures("wall")
@pytest.mark.parametrize("name", ATTEMPTS)
def test_code_in_the_process_cannot_open_write_or_start_anything(tmp_path, name):
    attempt = ATTEMPTS[name].format(elsewhere=str(tmp_path / "written"), python=sys.executable)
    telling = f"""
    try:
        {attempt}
        tried = "done"
    except (OSError, __import__("subprocess").SubprocessError) as error:
        tried = type(error).__name__
    print("tried: " + tried, file=sys.stderr)
    """
    _, printed = answer(tmp_path, attempt=telling.strip(), code=MINE.replace(" * secret()", ""))
    assert "tried: PermissionError" in printed or "tried: CalledProcessError" in printed, printed
    assert "tried: done" not in printed and "root:" not in printed and not (tmp_path / "written").exists()


@pytest.mark.usefixtures("wall")
def test_only_variables_that_compilers_need_are_left_in_the_process(tmp_path, monkeypatch):
    """Access tokens, for example, are removed."""
    monkeypatch.setenv("SOME_TOKEN", "1")
    monkeypatch.setenv("PYPI_TOKEN", "1")
    attempt = "import os; print('variables: ' + ' '.join(os.environ), file=sys.stderr)"
    _, printed = answer(tmp_path, attempt=attempt, code=MINE.replace(" * secret()", ""))
    assert "variables: " in printed and "PATH" in printed and "_TOKEN" not in printed, printed


@pytest.mark.usefixtures("wall")
def test_files_are_translated_inside_the_sandbox(tmp_path):
    code = MINE.replace(" * secret()", "")
    answers = [answer(tmp_path, is_walled=is_walled, code=code)[0] for is_walled in (False, True)]
    assert answers[0] == answers[1] and answers[0]["components"] == 2
