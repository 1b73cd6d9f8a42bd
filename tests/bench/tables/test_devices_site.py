"""`normalbench site`: its page for ten devices, all-or-nothing writing, and users' files that stay unchanged."""

import json
import os
import shutil
from html.parser import HTMLParser
from pathlib import Path

import devices as made
import pytest

from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.show.site_files import MARKER, write_site
from normalbench.bench.tables.devices.device_file import read_device_file
from normalbench.bench.tables.devices.reading import codec_rows, devices
from normalbench.bench.tables.devices.site.answers import Known, answers

MARKUP = "<script>alert(1)</script>\"'><img src=x onerror=alert(2)>"


class Read(HTMLParser):
    """A page's tags, the text of its tables' cells and its links."""

    def __init__(self, path: Path):
        super().__init__()
        self.tags, self.links, self.text = [], [], ""
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))
        self.links += [value for name, value in attrs if name == "href"]

    def handle_data(self, data):
        self.text += data


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """The site of the ten altered devices."""
    from normalbench.bench.show.site_command import site_command

    folder = tmp_path_factory.mktemp("site")
    made.write_ten(folder / "files" / "deeper")
    assert site_command([folder / "files"], folder / "site") == 0
    return folder / "site"


def files_of(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_page_lists_the_devices_that_agree_and_the_encoding_for_each(site):
    text = Read(site / "index.html").text
    assert "5 devices agree with the run in every code of 35 codecs." in text
    assert "Mali-G78, Chromium 156 differs in 8 of 35 codecs, most in xyz rgb10a2: 87.6% of its codes" in text
    assert "rg8, 2 bytes: take octahedral." in text and "ms per megapixel to encode" in text
    assert "stereographic, hemi_octahedral (only for normals with z >= 0)" in " ".join(text.split())
    assert "No times were measured on it" in text


def answered(tmp_path, **more) -> dict[str, str]:
    """Return the encoding to use on a device, by storage."""
    (device,) = devices([read_device_file(made.write(tmp_path / "a.json", **more))])
    rows = codec_rows(device)
    sheets = list(answers(rows, Known([rows])))
    return {sheet.keys["storage"]: sheet.keys["take"] for sheet in sheets}


def test_the_answer_uses_the_devices_own_errors(tmp_path):
    """If a device decodes octahedral with large errors, the answer is another encoding."""
    usual = answered(tmp_path)
    assert usual == {
        "rg8": "octahedral",
        "rg16": "octahedral",
        "rg16f": "octahedral",
        "rgb10a2": "cube",
        "rgba8": "best_fit",
    }
    rows = made.codec_rows()
    for row in rows:
        if (row["encoding"], row["storage"]) == ("octahedral", "rg8"):
            row |= {"mean_deg": 20 * row["mean_deg"], "max_deg": 20 * row["max_deg"]}
    assert answered(tmp_path, codecs=rows) == usual | {"rg8": "octahedral_precise"}


def test_encodings_that_do_not_decode_to_length_1_are_not_recommended(tmp_path):
    """Both encodings have the same errors, but lighting needs a normalise after `xyz`."""
    codec, other = made.codec_rows()[5], made.codec_rows()[25]
    assert (codec["encoding"], other["encoding"]) == ("octahedral", "xyz")
    other |= {name: codec[name] for name in ("mean_deg", "max_deg", "target", "storage")}
    assert answered(tmp_path, codecs=[codec, other]) == {codec["storage"]: "octahedral"}
    assert answered(tmp_path, codecs=[other]) == {codec["storage"]: None}


def test_a_users_own_encoding_is_left_out_of_the_answer(tmp_path):
    """The program does not know which normals a user's encoding is made for."""
    rows = [made.codec_rows()[5], made.codec_rows()[5] | {"encoding": "mine", "mean_deg": 0.0}]
    assert answered(tmp_path, codecs=rows) == {rows[0]["storage"]: "octahedral"}
    assert answered(tmp_path, codecs=rows[1:]) == {rows[0]["storage"]: None}


def test_damaged_files_are_reported_and_left_out(run, tmp_path):
    files = tmp_path / "files"
    made.write(files / "good.json")
    (files / "bad.json").write_text("{")
    (files / "notes.txt").write_text("no device")
    os.mkfifo(files / "pipe.json")
    status, out, err = run("site", str(files), "-o", str(tmp_path / "site"))
    assert status == 1 and out.endswith("1 device\n")
    assert err.splitlines() == [
        f"normalbench: {files}/bad.json: line 1, column 2: this is not JSON; file skipped",
        f"normalbench: {files}/pipe.json: it is not a plain file; file skipped",
    ]
    (files / "good.json").unlink()
    shutil.rmtree(tmp_path / "site")
    status, out, err = run("site", str(files), "-o", str(tmp_path / "site"))
    assert (status, out) == (2, "") and "contains no device file" in err.splitlines()[-1]
    assert not (tmp_path / "site").exists()


@pytest.mark.parametrize("name, said", [("nowhere", "no such folder"), ("a.json", "is not a folder")])
def test_missing_folder_is_a_one_line_error(run, tmp_path, name, said):
    made.write(tmp_path / "a.json")
    status, out, err = run("site", str(tmp_path / name), "-o", str(tmp_path / "site"))
    assert (status, out, err.count("\n")) == (2, "", 1) and said in err


def test_a_second_site_replaces_only_its_own_files(run, tmp_path):
    files, site = tmp_path / "files", tmp_path / "site"
    made.write(files / "a.json")
    gone = made.write(files / "b.json", renderer=made.MALI)
    assert run("site", str(files), "-o", str(site))[0] == 0
    (site / "CNAME").write_text("devices.example")
    (site / "devices").mkdir()
    (site / "devices" / "mine.html").write_text("mine")
    gone.unlink()
    assert run("site", str(files), "-o", str(site))[0] == 0
    names = {"CNAME", "index.html", MARKER, "devices/mine.html"}
    assert set(files_of(site)) == names
    assert json.loads((site / MARKER).read_text())["files"] == ["index.html"]
    assert "Mali" not in (site / "index.html").read_text()


def test_a_page_that_no_longer_belongs_to_the_site_is_deleted(tmp_path):
    write_site(tmp_path / "site", {"index.html": "first", "codecs/xy.html": "xy", "codecs/xyz.html": "xyz"})
    write_site(tmp_path / "site", {"index.html": "second", "codecs/xyz.html": "xyz"})
    assert set(files_of(tmp_path / "site")) == {"index.html", "codecs/xyz.html", MARKER}
    assert json.loads((tmp_path / "site" / MARKER).read_text())["files"] == ["codecs/xyz.html", "index.html"]


@pytest.mark.parametrize(
    "name, text, said",
    [
        ("index.html", "mine", "index.html is not from an earlier site"),
        (MARKER, "{", "this is not JSON; delete it"),
        (MARKER, '{"files": ["../outside.html"]}', "it lists files that are not part of a site"),
        (MARKER, '{"files": 3}', "delete it"),
        (MARKER, "[]", "delete it"),
    ],
)
def test_users_files_in_the_site_folder_are_not_changed(run, tmp_path, name, text, said):
    made.write(tmp_path / "files/a.json")
    (tmp_path / "outside.html").write_text("outside")
    path = tmp_path / "site" / name
    path.parent.mkdir(parents=True)
    path.write_text(text)
    before = files_of(tmp_path)
    status, out, err = run("site", str(tmp_path / "files"), "-o", str(tmp_path / "site"))
    assert (status, out, err.count("\n")) == (2, "", 1) and said in err, err
    assert files_of(tmp_path) == before


def test_a_link_in_the_site_is_not_followed(tmp_path):
    (tmp_path / "other").mkdir()
    (tmp_path / "site").mkdir()
    (tmp_path / "site/devices").symlink_to(tmp_path / "other")
    with pytest.raises(UsageError, match="a symbolic link where the site's files go"):
        write_site(tmp_path / "site", {"devices/index.html": "text"})
    assert not list((tmp_path / "other").iterdir())


def test_a_full_disk_leaves_the_earlier_site_unchanged(run, tmp_path, monkeypatch):
    files, site = tmp_path / "files", tmp_path / "site"
    made.write(files / "a.json")
    assert run("site", str(files), "-o", str(site))[0] == 0
    before = files_of(site)
    made.write(files / "b.json", renderer=made.MALI)
    write = Path.write_text

    def full(self, text, **more):
        if self.name.startswith("index.html"):
            raise OSError(28, "No space left on device")
        return write(self, text, **more)

    monkeypatch.setattr(Path, "write_text", full)
    status, _, err = run("site", str(files), "-o", str(site))
    assert status == 2 and "No space left on device" in err and err.count("\n") == 1
    assert files_of(site) == before and [p.name for p in tmp_path.iterdir() if "partial" in p.name] == []


def test_two_files_of_one_device_become_one_section(run, tmp_path):
    made.write(tmp_path / "files/a.json", made="2026-11-22T15:00:00Z")
    made.write(tmp_path / "files/b.json")
    status, out, err = run("site", str(tmp_path / "files"), "-o", str(tmp_path / "site"))
    assert status == 0 and "1 device\n" in out
    assert err == (
        f"normalbench: left out: {tmp_path}/files/a.json: {tmp_path}/files/b.json is from the same device and browser "
        "and at least as recent\n"
    )


def test_markup_in_a_device_file_stays_text(run, tmp_path):
    """Markup in any text of a device file is escaped on every page of the site."""
    row = made.codec_rows()[0] | dict.fromkeys(("encoding", "storage", "rounding", "target", "timer"), MARKUP)
    about = dict.fromkeys(("renderer", "vendor", "browser", "program", "sources"), MARKUP)
    made.write(tmp_path / "files/a.json", codecs=[row], facts={MARKUP: MARKUP}, **about)
    assert run("site", str(tmp_path / "files"), "-o", str(tmp_path / "site"))[0] == 0
    for path in (tmp_path / "site").rglob("*.html"):
        read, text = Read(path), path.read_text()
        assert "<script>alert" not in text and "<img" not in text and "<script>alert(1)</script>" in read.text, path
        assert not any(name.startswith("on") for _, attributes in read.tags for name in attributes)
        assert sum(tag == "script" for tag, _ in read.tags) == 2
        assert "default-src 'none'" in text and "http" not in text.replace("http-equiv", "")


def test_devices_whose_names_give_the_same_address_have_separate_sections(run, tmp_path):
    for number, renderer in enumerate(("GPU+", "GPU-", "\u7a7a", "\u7a7a\u7a7a")):
        made.write(tmp_path / f"files/{number}.json", renderer=renderer, browser="\u7a7a")
    assert run("site", str(tmp_path / "files"), "-o", str(tmp_path / "site"))[0] == 0
    sections = [attributes["id"] for tag, attributes in Read(tmp_path / "site/index.html").tags if tag == "section"]
    assert sections[-4:] == ["device-gpu", "device-gpu-2", "device-one", "device-one-2"], sections
