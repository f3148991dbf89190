"""The page of a run, as people meet it: in a browser, at a desk and on a phone, by day and by night."""

import pytest

from footfall.scenarios.report.page import write_page
from tests.helpers.pages import METHODS, NASTY, gate_folder, run_folder, sweep_folder

pytest.importorskip("selenium", reason="pages are looked at by footfall[test]'s selenium")


@pytest.fixture(scope="module")
def browser():
    from tests.helpers.browser import Browser

    found = Browser()
    yield found
    found.close()


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    return write_page(run_folder(tmp_path_factory.mktemp("looked-at") / "run"))


@pytest.fixture
def desk(browser, page):
    """As the tests before left it, who must put back what they chose."""
    browser.open(page, anew=False)
    browser.js("scrollTo(0, 0)")
    return browser


@pytest.fixture
def phone(browser, page):
    browser.open(page, width=390, dark=True, anew=False)
    return browser


def sideways(browser):
    """How much wider a page is than the screen: a phone's innerWidth grows with what is too wide."""
    return browser.js("document.documentElement.scrollWidth") - browser.width


@pytest.mark.parametrize(("width", "dark"), [(1280, False), (390, True)])
def test_it_opens_without_a_complaint_a_request_or_sideways_scroll(browser, page, width, dark):
    browser.open(page, width, dark)
    assert browser.lines("map") == ["truth", "start", *[shown(name) for name in METHODS for _ in range(2)]]
    assert browser.complaints() == []
    assert {address.partition(":")[0] for address in browser.requests()} <= {"file", "data", "blob"}
    assert sideways(browser) <= 0
    assert browser.js("window.hacked === undefined")
    places = browser.js("[...document.querySelectorAll('.chart')].map((c) => [c.id, c.data.length > 0])")
    assert places == [["map", True], ["error", True], ["drift", True], ["budget", True]]


def shown(name):
    """As plotly's own markup has it."""
    return name.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")


def test_pointing_at_a_footfall_tells_all_of_it(desk):
    curve = desk.lines("map").index("hdr")
    desk.point_at("map", curve, 20)
    told = desk.wait("document.querySelector('#map .hoverlayer')?.textContent")
    for part in ("hdr", "time 48.2 s", "heading ", "error 0.4 deg", "drift ", "attenuator 0.250"):
        assert part in told
    read = desk.wait("document.getElementById('map-readout').textContent")
    assert read.startswith("hdr: time 48.2 s, heading 25.")
    assert "error 0.4 deg, drift 0.010 deg/s, integrator 0.059 deg/s, attenuator 0.250" in read


def test_a_name_is_told_as_it_is_and_does_nothing(desk):
    desk.point_at("map", desk.lines("map").index(shown(NASTY)), 30)
    assert NASTY in desk.wait("document.querySelector('#map .hoverlayer')?.textContent")
    assert desk.js("window.hacked === undefined")
    assert desk.js("document.images.length") == 0


def test_a_method_is_taken_off_and_put_on_again(desk):
    before = desk.lines("map"), desk.lines("error"), desk.lines("drift"), desk.lines("budget")
    desk.js("document.querySelector('input[value=hdr]').click()")
    after = desk.lines("map"), desk.lines("error"), desk.lines("drift"), desk.lines("budget")
    assert after == (*([name for name in part if name != "hdr"] for part in before[:3]), before[3])
    desk.js("document.querySelector('input[value=hdr]').click()")
    assert desk.lines("map") == before[0]


def test_another_walk_is_drawn_in_all_charts(desk):
    ends = "['map', 'error', 'drift', 'budget'].map((id) => document.getElementById(id).data.at(-1).y.at(-1))"
    first = desk.js(ends)
    desk.js("document.querySelector('input[name=walk][value=\"2\"]').click()")
    assert [a != b for a, b in zip(desk.js(ends), first, strict=True)] == [True] * 4
    assert desk.js("document.querySelectorAll('input[name=walk]:checked').length") == 1
    desk.js("document.querySelector('input[name=walk]').click()")
    assert desk.js(ends) == first


def test_a_metre_is_as_long_along_x_as_along_y(desk):
    scale = "((f) => [f.xaxis._m, -f.yaxis._m])(document.getElementById('map')._fullLayout)"
    along_x, along_y = (abs(value) for value in desk.js(scale))
    assert along_x == pytest.approx(along_y, rel=1e-6)


def cells(browser, column):
    return browser.js(
        "[...document.querySelectorAll('table.sortable')[0].tBodies[0].rows]"
        f".map((row) => row.cells[{column}].textContent)"
    )


def test_a_table_is_sorted_by_its_heads(desk):
    click = "document.querySelectorAll('table.sortable')[0].querySelectorAll('th button')[{}].click()"
    sorted_by = (
        "[...document.querySelectorAll('table.sortable')[0].tHead.rows[0].cells].map((c) => c.ariaSort)"
    )
    assert desk.js(sorted_by) == [None] * 9
    desk.js(click.format(3))
    rising = [float(cell) for cell in cells(desk, 3)]
    assert rising == sorted(rising)
    assert desk.js(sorted_by) == [None] * 3 + ["ascending"] + [None] * 5
    desk.js(click.format(3))
    assert [float(cell) for cell in cells(desk, 3)] == rising[::-1]
    assert desk.js(sorted_by)[3] == "descending"
    desk.js(click.format(2))
    assert cells(desk, 2) == [NASTY, NASTY, "hdr", "hdr", "pdr", "pdr"]
    foot = "[...document.querySelectorAll('table.sortable')[0].tFoot.rows].map((r) => r.cells[0].textContent)"
    assert desk.js(foot) == ["mean"] * 3  # stays below


def test_keys_step_along_a_track(browser, page, desk):
    browser.open(page)
    desk.wait("(document.getElementById('map').focus(), document.activeElement.id === 'map')")
    press = (
        "document.getElementById('map').dispatchEvent("
        "new KeyboardEvent('keydown', {{ key: '{}', bubbles: true, cancelable: true }}))"
    )
    said = []
    for key in ("ArrowRight", "ArrowRight", "ArrowDown", "End", "ArrowLeft"):
        desk.js(press.format(key))
        said.append(desk.js("document.getElementById('map-readout').textContent").split(", ")[0])
    assert said == [
        "pdr: time 26.2 s",
        "pdr: time 27.3 s",
        "hdr: time 27.3 s",
        "hdr: time 69.1 s",
        "hdr: time 68.0 s",
    ]
    assert desk.js("document.activeElement.id") == "map"


def test_dark_and_light_follow_the_system(desk):
    colours = (
        "[getComputedStyle(document.body).backgroundColor, document.getElementById('map').data[2].line.color]"
    )
    light = desk.js(colours)
    assert light == [
        "rgb(255, 255, 255)",
        desk.js("getComputedStyle(document.documentElement).getPropertyValue('--s0')"),
    ]
    desk.colours(dark=True)
    dark = desk.wait(f"(([ground, line]) => line !== '{light[1]}' && [ground, line])({colours})")
    assert dark[0] == "rgb(19, 22, 26)"
    desk.colours(dark=False)
    desk.wait(f"(([ground, line]) => line === '{light[1]}')({colours})")


def test_print_is_light(browser, page):
    browser.open(page, dark=True)
    before = browser.js("document.getElementById('map').data[2].line.color")
    browser.js("window.dispatchEvent(new Event('beforeprint'))")
    assert browser.js("document.getElementById('map').data[2].line.color") != before
    assert browser.js("getComputedStyle(document.body).backgroundColor") == "rgb(255, 255, 255)"
    browser.js("window.dispatchEvent(new Event('afterprint'))")
    assert browser.js("document.getElementById('map').data[2].line.color") == before


def test_a_phone_scrolls_over_charts_and_has_no_bar_of_tools(phone):
    assert phone.js("document.getElementById('map')._fullLayout.dragmode") is False
    assert phone.js("document.querySelector('#map .modebar-btn')") is None
    x, y = phone.place("map", 2, 20)
    before = phone.js("scrollY")
    phone.touch([(x, y - 20 * step) for step in range(8)])
    phone.wait(f"scrollY > {before} + 50")


def test_a_tap_tells_what_is_there(browser, page, phone):
    browser.open(page, width=390, dark=True)  # a tap after a swipe would only end that
    told = "document.getElementById('map-readout').textContent"
    for _ in range(5):  # where the machine is busy a tap may last as long as a press
        phone.touch([phone.place("map", 2, 20)])
        phone.settle()
        if phone.js(told):
            break
    assert ": time 48.2 s, heading" in phone.wait(told)


def test_tables_are_there_without_a_script(browser, page):
    browser.open(page, script=False)
    browser.tell("Emulation.setScriptExecutionDisabled", value=False)
    assert browser.js("document.querySelectorAll('table').length") >= 5
    assert browser.js("document.querySelector('table th button')") is None
    assert browser.js("document.querySelector('noscript').textContent").startswith("The charts need a script")
    assert browser.js("getComputedStyle(document.querySelector('.controls')).display") == "none"
    assert browser.js("getComputedStyle(document.querySelector('figure')).display") == "none"
    assert sideways(browser) <= 0


def test_what_can_be_used_can_be_reached_by_keys_and_has_a_name(desk):
    assert desk.js("document.documentElement.lang") == "en"
    assert desk.js("document.querySelectorAll('h1').length") == 1
    assert desk.js("[...document.querySelectorAll('section')].every((s) => s.querySelector('h2'))")
    assert desk.js("[...document.querySelectorAll('input')].every((i) => i.labels.length === 1)")
    named = "e.ariaLabel || document.getElementById(e.getAttribute('aria-labelledby'))"
    wide = "[...document.querySelectorAll('.scroll, .chart')]"
    assert desk.js(f"{wide}.every((e) => e.tabIndex === 0 && ({named}))")
    assert desk.js(
        "[...document.querySelectorAll('nav a')].every((a) => document.querySelector(a.getAttribute('href')))"
    )
    ids = desk.js("[...document.querySelectorAll('main [id]')].map((e) => e.id)")
    assert len(ids) == len(set(ids))


@pytest.mark.parametrize("made", [sweep_folder, gate_folder])
def test_sweeps_and_gates_open_on_a_phone_as_at_a_desk(browser, tmp_path, made):
    page = write_page(made(tmp_path / "results"))
    for width, dark in ((1280, False), (390, True)):
        browser.open(page, width, dark)
        assert browser.js("[...document.querySelectorAll('.chart')].every((c) => c.data.length > 0)")
        assert browser.complaints() == []
        assert {address.partition(":")[0] for address in browser.requests()} <= {"file", "data", "blob"}
        assert sideways(browser) <= 0


def test_another_score_of_a_sweep_is_drawn_in_all_panels(browser, tmp_path):
    browser.open(write_page(sweep_folder(tmp_path / "results")))
    titles = "[0, 1, 2].map((i) => document.getElementById(`axis-${i}`).layout.yaxis.title.text)"
    assert browser.js(titles) == ["mean heading error (deg)"] * 3
    browser.js("document.querySelector('input[value=return_error_pct]').click()")
    assert browser.js(titles) == ["return error (%)"] * 3
    before = browser.js("document.getElementById('track').data.at(-1).y")
    browser.js("document.querySelectorAll('input[name=track]')[1].click()")
    assert browser.js("document.getElementById('track').data.at(-1).y") != before


def test_long_tables_are_shown_in_pages(browser, tmp_path):
    browser.open(write_page(sweep_folder(tmp_path / "results", radii=tuple(range(1, 101)))))
    rows = "[...document.querySelectorAll('#settings tbody tr')].filter((row) => !row.hidden).length"
    assert browser.js(rows) == 500
    on = "document.querySelectorAll('.pager button')[1]"
    browser.js(f"{on}.click()")
    assert browser.js(rows) == 100
    assert browser.js("document.querySelector('.pager span').textContent") == "501 to 600 of 600 rows"
    assert browser.js(f"{on}.disabled")
    browser.js("document.querySelectorAll('#settings th button')[2].click()")
    assert browser.js("document.querySelector('#settings tbody tr').cells[2].textContent") == "1"
    assert browser.js(rows) == 500
