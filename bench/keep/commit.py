"""The commit of a run: the commit of the working folder, or the user's name for the change."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

from ..tables.table import Row

SECONDS = 20
# How many letters of a commit's name people read, and what they are followed by where files were changed since.
SHORT, CHANGED = 8, "+"


def commit_of(named: str | None, folder: Path) -> Row:
    """Return the facts that a run records about its commit: only `name` if the change is named; empty if it has no
    name and the folder is not in a repository.

    Otherwise the facts are `name`, `time` in seconds, `subject`, whether files of the repository were `changed`
    since, and `rank`, which orders commits of the same second, such as the commits of a rebase.
    """
    if named:
        return {"name": named}
    if not (log := _git(folder, "log", "-1", "--no-show-signature", "--format=%H%n%ct%n%s")):
        return {}
    # A commit may have no message.
    name, time, subject = (*log.split("\n", 2), "")[:3]
    # Of a clone that is not deep, the rank is the same for all.
    rank = _git(folder, "rev-list", "--count", f"--max-age={time}", "HEAD") or "0"
    about = {"name": name, "time": int(time), "rank": int(rank), "subject": subject.strip()}
    # Filters of a repository are programs, which git runs to compare files: one from a stranger is not asked.
    if _has_filters(folder):
        return about | {"changed": False}
    # A submodule has settings of its own, and its filters run too.
    status = _git(folder, "status", "--porcelain", "--untracked-files=no", "--ignore-submodules=all")
    return about | {"changed": bool(status)}


def _has_filters(folder: Path) -> bool:
    """Whether the repository's own settings, rather than the user's, name programs that convert files."""
    lines = _git(folder, "config", "--show-scope", "--get-regexp", r"^filter\.").splitlines()
    return any(line.startswith(("local", "worktree")) for line in lines)


def _git(folder: Path, *words: str) -> str:
    """Return git's output for a repository; empty if git, the repository or a commit is missing."""
    try:
        # What a repository's settings name as programs: those that watch its files, and hooks.
        safe = ("-c", "core.fsmonitor=false", "-c", f"core.hooksPath={os.devnull}", "--no-optional-locks", "--no-pager")
        # What is missing in a partial clone would be fetched, by a program that its settings name.
        variables = os.environ | {"GIT_ALLOW_PROTOCOL": "none", "GIT_NO_LAZY_FETCH": "1", "GIT_TERMINAL_PROMPT": "0"}
        done = subprocess.run(["git", *safe, *words], cwd=folder, env=variables, capture_output=True, timeout=SECONDS)
    except (OSError, subprocess.TimeoutExpired):
        return ""
    return done.stdout.decode(errors="replace").strip() if done.returncode == 0 else ""


def short_name(commit: Row) -> str:
    """Return a commit's name for people: a hash is shortened, and uncommitted changes are marked."""
    name = str(commit["name"])
    is_hash = "time" in commit
    return (name[:SHORT] if is_hash else name) + CHANGED * bool(commit.get("changed"))
