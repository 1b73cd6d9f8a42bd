"""A process behind a Landlock wall, and its children, can access only the listed files and folders."""

import os
import shutil
import socket
import subprocess
import sys
from pathlib import Path

import pytest

from normalbench.bench.ground.compilers import tools
from normalbench.bench.ground.machine import children
from normalbench.bench.ground.machine.systems import landlock, walls
from normalbench.bench.ground.machine.systems.walls import Wall
from normalbench.bench.ground.output.errors import MissingError

pytestmark = pytest.mark.skipif(
    not landlock.is_available() and not os.environ.get("CI"), reason="this kernel has no Landlock"
)


SECRET = "what nobody may read"


# What a stranger's program tries; it prints the name of all that it could do. SECRET_FILE and OUTSIDE are paths.
STRANGER = r"""
#define _GNU_SOURCE
#include <arpa/inet.h>
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static void tell(const char *name, int is_done) { if (is_done) printf("%s\n", name), fflush(stdout); }

static void try_all(void) {
    tell("read", open(SECRET_FILE, O_RDONLY) >= 0);
    tell("passwd", open("/etc/passwd", O_RDONLY) >= 0);
    tell("environ", open("/proc/self/environ", O_RDONLY) >= 0);
    tell("list", opendir(OUTSIDE) != NULL);
    tell("write", open(SECRET_FILE, O_WRONLY) >= 0);
    tell("truncate", truncate(SECRET_FILE, 0) == 0);
    tell("make", open(OUTSIDE "/made", O_CREAT | O_WRONLY, 0600) >= 0);
    tell("mkdir", mkdir(OUTSIDE "/folder", 0700) == 0);
    tell("remove", unlink(SECRET_FILE) == 0);
    tell("rename", rename(SECRET_FILE, "stolen") == 0);
    tell("hard link", link(SECRET_FILE, "linked") == 0);
    tell("link", symlink(SECRET_FILE, "symlinked") == 0);
    tell("pipe", mkfifo("fifo", 0600) == 0);
    tell("signal", kill(PARENT, 0) == 0);
    tell("variable", getenv("SECRET") != NULL);
    tell("system", system("id") == 0);
    struct sockaddr_in place = {.sin_family = AF_INET, .sin_port = htons(PORT)};
    inet_pton(AF_INET, "127.0.0.1", &place.sin_addr);
    tell("connect", connect(socket(AF_INET, SOCK_STREAM, 0), (void *)&place, sizeof place) == 0);
    place.sin_port = 0;
    int listening = socket(AF_INET, SOCK_STREAM, 0);
    tell("bind", bind(listening, (void *)&place, sizeof place) == 0);
    if (!fork()) { execl("/bin/sh", "sh", "-c", "echo shell", NULL); _exit(0); }
    wait(NULL);
    if (!fork()) { execl("/usr/bin/cc", "cc", "--version", NULL); _exit(0); }
    wait(NULL);
}

int main(int count, char **words) {
    FILE *own = fopen(FOLDER "/made.bin", "w");
    if (chdir(FOLDER) || !own || fputs("own", own) < 0 || fclose(own)) return 3;
    try_all();
    if (!fork()) { try_all(); _exit(0); }
    wait(NULL);
    if (count == 1) { fflush(stdout); execl(words[0], words[0], "again", NULL); }
    puts("end");
    return 0;
}
"""


@pytest.fixture
def place(tmp_path):
    """A folder that may be written, next to a folder with a secret."""
    (tmp_path / "outside").mkdir()
    (tmp_path / "outside" / "secret").write_text(SECRET)
    (tmp_path / "place").mkdir()
    return tmp_path / "place"


def compiled(place: Path, text: str, tool: str = "cc") -> subprocess.CompletedProcess[str]:
    (place / "main.c").write_text(text)
    wall = walls.of_c_compiler(tool) | Wall(writes=(str(place),))
    return children.finished(wall.around([tool, str(place / "main.c"), "-o", str(place / "main"), "-lm"]), 60)


def tried(place: Path, line: str, *reads: str) -> subprocess.CompletedProcess[str]:
    """Run a line of Python behind a wall; return the finished process."""
    wall = walls.of_python() | Wall(reads=reads, writes=(str(place),))
    return children.finished(wall.around([sys.executable, "-I", "-c", line]), 60)


def test_a_compiler_works_and_its_program_runs(place):
    """The program is compiled and linked in the folder, which also has the temporary files."""
    done = compiled(place, "#include <stdio.h>\n#include <math.h>\nint main(int n, char **w) {"
        "(void)w; printf(\"%g\\n\", sqrt(4.0 * n)); return 0; }")  # fmt: skip
    assert done.returncode == 0, done.stderr
    ran = children.finished(walls.of_program(place / "main").around([str(place / "main")]), 60)
    assert (ran.returncode, ran.stdout) == (0, "2\n"), ran.stderr


@pytest.mark.parametrize("line", ['#include "{0}"', 'const char *s = __FILE__; __asm__(".incbin \\"{0}\\"");'])
def test_a_compiler_includes_nothing_from_outside(place, line):
    """Both the preprocessor and the assembler are blocked, and the message does not quote the file."""
    done = compiled(place, line.format(place.parent / "outside" / "secret") + "\nint main(void) { return 0; }\n")
    assert done.returncode != 0 and SECRET not in done.stderr


@pytest.mark.parametrize("tool", ["glslangValidator", "spirv-cross", "spirv-opt", tools.SLANG])
def test_shader_tools_run_behind_a_wall(tool, place):
    """Tools on the system's path or in a wheel print the same help as without a wall."""
    try:
        path = str(tools.path_of(tool) if tool == tools.SLANG else shutil.which(tool) or "")
    except MissingError:
        path = ""
    if not path:
        pytest.skip(f"no {tool}")
    wall = walls.of_tool(path) | Wall(writes=(str(place),))
    free, held = (children.finished(words, 60) for words in ([path, "-h"], wall.around([path, "-h"])))
    assert (held.returncode, held.stdout, held.stderr) == (free.returncode, free.stdout, free.stderr)
    assert free.stdout or free.stderr


def test_an_untrusted_program_can_access_nothing_outside(place, monkeypatch):
    """The program's child and its restart are blocked too; the program can write only to its own folder."""
    monkeypatch.setenv("SECRET", SECRET)
    outside = place.parent / "outside"
    with socket.create_server(("127.0.0.1", 0)) as server:
        facts = {"FOLDER": place, "OUTSIDE": outside, "SECRET_FILE": outside / "secret"}
        head = "".join(f'#define {name} "{path}"\n' for name, path in facts.items())
        head += f"#define PORT {server.getsockname()[1]}\n#define PARENT {os.getpid()}\n"
        built = compiled(place, head + STRANGER)
        assert built.returncode == 0, built.stderr
        # It can do all of it, if nothing holds it.
        assert {"read", "truncate", "remove"} & set(subprocess.check_output([place / "main"], text=True).splitlines())
        (outside / "secret").write_text(SECRET)
        for path in {*place.iterdir()} - {place / "main"}:
            path.unlink()
        before = {path.name for path in outside.iterdir()}
        wall = walls.of_program(place / "main") | Wall(writes=(str(place),))
        ran = children.finished(wall.around([str(place / "main")]), 60)
    assert (ran.returncode, ran.stdout) == (0, "end\n"), ran.stdout + ran.stderr
    assert (outside / "secret").read_text() == SECRET and {path.name for path in outside.iterdir()} == before
    assert {path.name for path in place.iterdir()} == {"main", "made.bin"}


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("open('/etc/passwd')", "PermissionError"),
        ("open({secret!r})", "PermissionError"),
        ("open({secret!r}, 'w')", "PermissionError"),
        ("import os; os.listdir({home!r})", "PermissionError"),
        ("import os; os.execv('/bin/sh', ['sh', '-c', 'echo 1'])", "PermissionError"),
        ("import subprocess; subprocess.run(['id'])", "PermissionError"),
        ("import socket; socket.create_connection(('127.0.0.1', 9))", "PermissionError"),
        ("open('/dev/tty')", "PermissionError|OSError"),
    ],
)
def test_python_behind_a_wall_is_denied_access(place, line, says):
    """A forked child, as in `multiprocessing`, is denied access too."""
    line = line.format(secret=str(place.parent / "outside" / "secret"), home=str(Path.home()))
    done = tried(place, line)
    assert done.returncode == 1 and any(says_one in done.stderr for says_one in says.split("|")), done.stderr
    forked = f"import os\nif not os.fork():\n    {line.replace('; ', chr(10) + '    ')}\nos._exit(os.wait()[1] >> 8)"
    assert tried(place, forked).returncode == 1


def test_a_running_process_walls_itself_in(place):
    """The process keeps its open files, opens no others, and cannot remove the wall."""
    line = (
        "from normalbench.bench.ground.machine.systems.landlock import restrict\n"
        f"file = open({str(place.parent / 'outside' / 'secret')!r})\n"
        f"restrict([], [{str(place)!r}], [])\nrestrict(['/'], ['/'], [])\nprint(file.read())\n"
        "open(file.name)"
    )
    done = subprocess.run([sys.executable, "-c", line], capture_output=True, text=True)
    assert done.stdout == f"{SECRET}\n" and "PermissionError" in done.stderr, done.stderr


def test_a_process_with_several_threads_is_refused():
    """The other threads would stay outside the wall."""
    line = (
        "import threading, time\nfrom normalbench.bench.ground.machine.systems import landlock\n"
        "threading.Thread(target=time.sleep, args=[1]).start()\nlandlock.restrict([], [], [])"
    )
    done = subprocess.run([sys.executable, "-c", line], capture_output=True, text=True)
    assert done.returncode == 1 and "RuntimeError: a wall binds one thread" in done.stderr, done.stderr


def test_resource_limits_still_apply_behind_a_wall(place):
    """The limits that a process had before the wall also apply behind it."""
    wall = walls.of_python() | Wall(writes=(str(place),))
    line = "import resource; print(resource.getrlimit(resource.RLIMIT_CORE)[0], resource.getrlimit(1)[0])"
    words = wall.around([sys.executable, "-I", "-c", line])
    limits = "from normalbench.bench.ground.machine import children; children.limit_this_process(); import os, sys; "
    done = subprocess.run(
        [sys.executable, "-c", f"{limits} os.execv(sys.argv[1], sys.argv[1:])", *words], capture_output=True, text=True
    )
    assert done.stdout == f"0 {children.FILE}\n", done.stderr


def test_a_program_that_cannot_be_executed_has_its_own_status(place):
    """The status is 126, as in shells: the script needs an interpreter that it may not execute."""
    (place / "script").write_text("#!/bin/sh\necho 1\n")
    (place / "script").chmod(0o755)
    done = children.finished(walls.of_program(place / "script").around([str(place / "script")]), 60)
    assert done.returncode == 126 and done.stderr.endswith("Permission denied\n"), done.stderr


def test_a_home_folder_is_never_readable_as_a_whole():
    """Tools or a Python inside the home folder make only their own folders readable."""
    home = Path.home().resolve()
    for wall in (walls.of_python(), walls.of_c_compiler("cc"), walls.of_tool(home / "bin" / "tool")):
        assert not [path for path in wall.reads if home.is_relative_to(path)], wall
