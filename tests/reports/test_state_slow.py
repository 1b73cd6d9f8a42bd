"""The page's state in a browser: its address, A and B, views, and every row from its packed block."""

import json
from pathlib import Path

import numpy as np
import pytest
from browsing import no_files
from playwright.sync_api import expect

STATES = 200


def random_states(opened) -> list[dict]:
    """Return states with the page's views, codecs and places, and with keys that another version may have written."""
    rng = np.random.default_rng(7)
    views = opened.page.eval_on_selector_all(".view", "all => all.map((one) => one.dataset.view)")
    codecs = ["", *opened.page.evaluate("known.codecs")]
    words = ["", "x=1&y", "ä ö", "%", "a#b?c", "50 %/2"]
    states = []
    for _ in range(STATES):
        a, b = (codecs[i] for i in rng.choice(len(codecs), 2, replace=False))
        others = [[f"key {i}", words[rng.integers(len(words))]] for i in range(rng.integers(3))]
        asked = {
            key: str(rng.integers(9)) if rng.random() < 0.3 else "" for key in ("most", "readers", "worth", "enough")
        }
        yes = {key: ("", "yes", "no")[rng.integers(3)] for key in ("holes", "lengths", "tables")}
        yes |= {"uses": ("", "none", "filter,blend")[rng.integers(3)], "gpu": ("", "navi31")[rng.integers(2)]}
        about = {"view": views[rng.integers(len(views))], "for": words[rng.integers(len(words))], **asked, **yes}
        states.append({**about, "a": a, "b": b, "at": "", "live": "", "others": others})
    return states


BOTH_WAYS = """(states) => states.map((state) => {
  const address = hashOf(state), [given, unknown] = stateOf(address);
  return [address, given, unknown, hashOf(given)];
})"""


def test_an_address_restores_its_state(opened):
    """Keys from another version are kept, and default values are left out."""
    states = random_states(opened)
    for state, (address, given, unknown, again) in zip(states, opened.page.evaluate(BOTH_WAYS, states), strict=True):
        assert given == state and unknown == [], address
        assert again == address
    assert opened.page.evaluate("hashOf({ ...DEFAULTS, others: [] })") == "#v1/codecs"


def test_unknown_names_in_the_address_are_reported(opened):
    opened.page.evaluate("location.hash = '#v1/nowhere?a=nothing%20rg8&b=xy%20rgba8&zoom=3'")
    opened.says(
        "#unknown", "The address names the view nowhere and the codec nothing rg8, which this page does not have."
    )
    assert opened.page.evaluate("[state.view, state.a, state.b]") == ["codecs", "", "xy rgba8"]
    assert opened.page.evaluate("location.hash") == "#v1/codecs?b=xy%20rgba8&zoom=3"
    opened.page.evaluate("change({ b: '' })")
    assert opened.page.evaluate("location.hash") == "#v1/codecs?zoom=3"


def go_back(opened):
    """Go back as the browser's button does, without waiting for a load."""
    gone = "new Promise((done) => { addEventListener('popstate', done, { once: true }); history.back(); })"
    opened.page.evaluate(gone)


def test_back_undoes_one_step_and_one_view_is_shown(opened):
    shown = "all => all.filter((one) => !one.hidden).map((one) => one.dataset.view)"
    opened.page.locator("nav [data-to=data]").click()
    opened.page.evaluate("choose('xy rgba8')")
    opened.page.evaluate("choose('octahedral rgba8', true)")
    assert opened.page.evaluate("location.hash") == "#v1/data?a=xy%20rgba8&b=octahedral%20rgba8"
    # What is A and becomes B changes places.
    opened.page.evaluate("choose('octahedral rgba8')")
    assert opened.page.evaluate("[state.a, state.b]") == ["octahedral rgba8", "xy rgba8"]
    for expected in (["xy rgba8", "octahedral rgba8"], ["xy rgba8", ""], ["", ""]):
        go_back(opened)
        assert opened.page.evaluate("[state.a, state.b]") == expected
        assert opened.page.eval_on_selector_all(".view", shown) == ["data"]
    go_back(opened)
    assert opened.page.eval_on_selector_all(".view", shown) == ["codecs"]
    assert opened.page.locator("nav [aria-current=page]").get_attribute("data-to") == "codecs"


def test_a_place_in_another_view_is_scrolled_to(opened):
    """This works for the anchors of headings, and for tables of all rows, which are opened."""
    for key in opened.page.eval_on_selector_all("section[id], details[id]", "all => all.map((one) => one.id)"):
        opened.page.evaluate("key => location.hash = key", key)
        opened.page.locator(f"#{key}").wait_for(state="visible")
        opened.page.wait_for_timeout(50)
        top, room, end = opened.page.evaluate(
            """key => [document.getElementById(key).getBoundingClientRect().top,
              navigation.getBoundingClientRect().bottom,
              document.documentElement.scrollHeight - innerHeight - scrollY]""",
            key,
        )
        # At the end of a page there is nothing more to scroll.
        assert -1 <= top - room <= 22 or end <= 1, (key, top, room)
        if key.startswith("rows-"):
            assert opened.page.locator(f"#{key} tbody tr").count() > 0


@no_files
def test_every_row_matches_the_csv_file_byte_for_byte(opened, results):
    """Each table's block gives the CSV file next to the page; a filter leaves some of its lines."""
    opened.page.locator("nav [data-to=data]").click()
    tables = opened.page.eval_on_selector_all("details[data-table]", "all => all.map((one) => one.dataset.table)")
    assert tables
    for name in tables:
        details = opened.page.locator(f"#rows-{name}")
        details.locator("summary").first.click()
        details.locator("tbody tr").first.wait_for()
        expected = (results[0] / f"{name}.csv").read_text(encoding="utf-8")
        with opened.page.expect_download() as download:
            details.locator("[data-copy=csv]").click()
        assert Path(download.value.path()).read_text(encoding="utf-8") == expected
        details.locator("input[type=search]").fill("octahedral rgba8")
        count = details.locator("[data-count]").text_content()
        lines = [line for line in expected.splitlines()[1:] if "octahedral" in line and "rgba8" in line]
        assert count == f"{len(lines)} of {len(expected.splitlines()) - 1} rows"
        details.locator("summary").first.click()
        opened.page.wait_for_timeout(50)
        assert details.locator("*").count() == 1, "what is closed takes no elements"


def test_the_conditions_of_a_table_match_its_rows(opened, results):
    """The conditions are built when the section is opened, and removed when it is closed."""
    rows = json.loads((results[0] / "quality.json").read_text(encoding="utf-8"))
    opened.come_to("#quality .method")
    method = opened.page.locator("#quality .method")
    method.locator("summary").click()
    method.locator("dd").first.wait_for()
    conditions = dict(zip(*(method.locator(tag).all_text_contents() for tag in ("dt", "dd")), strict=True))
    for name in ("encoding", "storage", "count"):
        values = list(dict.fromkeys(str(row[name]) for row in rows))
        assert conditions[name] == ", ".join(values[:8]) + (" ..." if len(values) > 8 else "")
    method.locator("summary").click()
    expect(method.locator("dt")).to_have_count(0)


ODD = [
    1e-7,
    1e16,
    123456789.0,
    0.1,
    -0.0,
    0.0,
    1.0,
    5e-324,
    1.7976931348623157e308,
    0.0001,
    0.00012345,
    -3.5,
    1e22,
    2e15,
]


def test_numbers_are_written_as_in_python(opened):
    rng = np.random.default_rng(3)
    values = [*ODD, *(rng.uniform(-1, 1, 300) * 10.0 ** rng.integers(-30, 30, 300)).tolist()]
    assert opened.page.evaluate("all => JSON.parse(all).map(exactText)", json.dumps(values)) == list(map(repr, values))


@pytest.mark.parametrize("name", ["octahedral", "octahedral rgba8"])
def test_a_rule_covers_the_codecs_of_an_encoding(opened, name):
    """A row of an encoding alone belongs to each of its codecs, but not to an encoding with a longer name."""
    codes = ["octahedral", "octahedral rgba8", "octahedral rg8", "octahedral_precise rgba8", "xy rgba8"]
    answers = opened.page.evaluate(
        """([name, codes]) => {
          const style = element("style", {}, ruleOf(name, "a")), root = element("div", {}, style);
          root.append(...codes.map((code) => element("i", { "data-codec": code })));
          document.body.append(root);
          const isSide = (one) => getComputedStyle(one).getPropertyValue("--side") !== "";
          const all = Array.from(root.querySelectorAll("i"), (one) => [one.dataset.codec, isSide(one)]);
          root.remove();
          return all.map(([code, is]) => [code, is, agrees(code, name)]);
        }""",
        [name, codes],
    )
    of_all = {code for code in codes if code.startswith(f"{name} ")} if " " not in name else set()
    expected = {name, "octahedral"} | of_all
    for column in (1, 2):
        assert {answer[0] for answer in answers if answer[column]} == expected, answers
