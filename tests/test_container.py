"""Dockerfile: its instructions, run in a Debian chroot, yield the same rows as this machine."""

from containers import DOCKERFILE, Container, context, instructions, suite
from manual import PAGES, ROOT


def test_the_dockerfile_has_only_instructions_that_the_chroot_supports():
    lines = instructions(DOCKERFILE.read_text())
    assert lines[0][0] == "FROM" and suite(lines[0][1]) == "bookworm"
    assert all(hasattr(Container, f"_{word.lower()}") for word, _ in lines[1:])
    assert [text for word, text in lines if word == "USER"] == ["bench"], "it runs as somebody who is not root"


def test_the_install_page_has_both_docker_commands():
    shown = [line.lstrip("# ") for line in DOCKERFILE.read_text().splitlines() if line.startswith("#     docker ")]
    assert len(shown) == 2 and all(f"    {line}\n" in PAGES[ROOT / "docs" / "install.md"] for line in shown)


def test_docker_gets_the_package_and_no_tests():
    names = context()
    assert {"pyproject.toml", "README.md", "LICENSE", ".ci/setup", "encodings/catalogue.py"} <= set(names)
    assert not [name for name in names if name.startswith(("tests/", "docs/", ".git/"))]
