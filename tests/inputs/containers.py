"""The lines of a Dockerfile, run in a Debian chroot as `docker build` and `docker run` would run them."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
from dataclasses import dataclass, field
from pathlib import Path

from manual import ROOT

DOCKERFILE = ROOT / "Dockerfile"
PATH = "/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin"
# How this machine reaches its registries. Docker gives a container the first; a machine behind a proxy has the others.
REACHED_BY = ("/etc/resolv.conf", "/etc/pip.conf", "/etc/ssl/certs/ca-certificates.crt")
MOUNTED = 'mount -t proc proc "$1/proc"; mount --rbind /dev "$1/dev"; root=$1; shift; exec chroot "$@"'


def instructions(text: str) -> list[tuple[str, str]]:
    """Return the word and the text of each instruction; a backslash continues it on the next line."""
    plain = re.sub(r"^\s*#.*\n", "", text, flags=re.M).replace("\\\n", " ")
    return [tuple(line.split(None, 1)) for line in plain.splitlines() if line.strip()]


def suite(image: str) -> str:
    """Return Debian's suite of an image such as debian:bookworm-slim."""
    return re.fullmatch(r"debian:([a-z]+)-slim", image)[1]


def missing() -> str:
    """Return the reason why no chroot can be made here, or an empty text."""
    lacks = [name for name in ("debootstrap", "unshare", "chroot") if not shutil.which(name)]
    return "a chroot needs root" if os.geteuid() else f"no {lacks[0]}; install it with apt-get" if lacks else ""


def mirror() -> str:
    """Return the address from which this machine gets Debian's packages."""
    told = subprocess.run(["apt-get", "indextargets", "--format", "$(REPO_URI)"], capture_output=True, text=True)
    mirrors = [line for line in told.stdout.splitlines() if line.rstrip("/").endswith("/debian")]
    return mirrors[0] if mirrors else "http://deb.debian.org/debian"


def context() -> list[str]:
    """Return the files that Docker would receive: all except those that .dockerignore names."""
    paths: list[str] = []
    for folder, folders, files in os.walk(ROOT):
        own = Path(folder).relative_to(ROOT)
        folders[:] = [name for name in folders if not _is_ignored(own / name)]
        paths += [str(own / name) for name in files if not _is_ignored(own / name)]
    return paths


def _is_ignored(path: Path) -> bool:
    patterns = (ROOT / ".dockerignore").read_text().split()
    return any(path.match(p.removeprefix("**/")) if p.startswith("**/") else str(path) == p for p in patterns)


@dataclass
class Container:
    """A chroot, with the Dockerfile's settings for the remaining lines."""

    root: Path
    variables: dict[str, str] = field(default_factory=dict)
    user: str = "root"
    folder: str = "/"
    entry: tuple[str, ...] = ()
    command: tuple[str, ...] = ()

    def make(self) -> subprocess.CompletedProcess[str]:
        """Make the image that FROM names, and let it reach this machine's registries."""
        (image,) = [text for word, text in instructions(DOCKERFILE.read_text()) if word == "FROM"]
        words = [
            "debootstrap",
            "--variant=minbase",
            "--include=ca-certificates",
            suite(image),
            str(self.root),
            mirror(),
        ]
        done = subprocess.run(words, capture_output=True, text=True)
        if done.returncode == 0:
            self._reach_registries()
        return done

    def _reach_registries(self) -> None:
        for name in filter(os.path.exists, REACHED_BY):
            self._place(Path(name), name)
        own = Path("~/.config/pip/pip.conf").expanduser()
        if own.exists():
            self._place(own, "/root/.config/pip/pip.conf")

    def _place(self, source: Path, name: str) -> None:
        target = self.root / name.lstrip("/")
        target.parent.mkdir(parents=True, exist_ok=True)
        target.unlink(missing_ok=True)
        shutil.copyfile(source, target)

    def build(self) -> None:
        """Run all lines except FROM. Raises CalledProcessError."""
        for word, text in instructions(DOCKERFILE.read_text()):
            if word != "FROM":
                getattr(self, f"_{word.lower()}")(text)

    def run(self, *words: str, user: str = "") -> subprocess.CompletedProcess[str]:
        """Run these words as `docker run` does, through the entry point."""
        return self._within([*self.entry, *(words or self.command)], user or self.user)

    def _within(self, words: list[str], user: str) -> subprocess.CompletedProcess[str]:
        given = {"PATH": PATH, "HOME": "/root", **self._certificates(), **self.variables}
        told = [f"{name}={value}" for name, value in given.items()]
        inside = ["sh", "-c", 'cd "$1" && shift && exec "$@"', "sh", self.folder, *words]
        chroot = [f"--userspec={user}:{user}", str(self.root), "env", "-i", *told, *inside]
        command = ["unshare", "-m", "sh", "-ec", MOUNTED, "sh", str(self.root), *chroot]
        return subprocess.run(command, capture_output=True, text=True)

    def _certificates(self) -> dict[str, str]:
        """Return the variable that tells pip which certificates to trust, if this machine has its own."""
        return {name: os.environ[name] for name in ("PIP_CERT",) if name in os.environ}

    def _env(self, text: str) -> None:
        name, _, value = text.partition("=")
        self.variables[name] = value

    def _copy(self, text: str) -> None:
        source, target = text.split()
        assert source == "."
        for name in context():
            place = self.root / target.lstrip("/") / name
            place.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, place)

    def _workdir(self, text: str) -> None:
        self.folder = text
        (self.root / text.lstrip("/")).mkdir(parents=True, exist_ok=True)

    def _user(self, text: str) -> None:
        self.user = text

    def _run(self, text: str) -> None:
        done = self._within(["sh", "-c", text], self.user)
        print(done.stdout)
        assert done.returncode == 0, f"RUN {text}\n{done.stdout[-3000:]}\n{done.stderr[-3000:]}"

    def _entrypoint(self, text: str) -> None:
        self.entry = tuple(json.loads(text))

    def _cmd(self, text: str) -> None:
        self.command = tuple(json.loads(text))
