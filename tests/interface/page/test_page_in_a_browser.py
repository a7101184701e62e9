"""The page in a real browser: it draws what Python computes, visitors do not mix, nothing leaves the machine."""

import http.client
import re

import numpy as np
import pytest
from browsing import PATIENCE, Visitor, axe_faults, start, wait_until
from playwright.sync_api import expect

import frahm
from frahm.analysis import analyse
from frahm.loads import vortex_shedding

CASE = frahm.load_case("jacket-pipe")
CHANGES = {
    "kappa": lambda case, value: case.with_absorber(kappa=value),
    "xi2": lambda case, value: case.with_absorber(xi2=value),
    "rho2": lambda case, value: case.with_absorber(rho2=value),
    "wind-speed": lambda case, value: case.with_wind(speed=value),
    "pipe-frequency": lambda case, value: case.with_pipe(frequency=value),
    "pipe-damping_ratio": lambda case, value: case.with_pipe(damping_ratio=value),
}


def points_of(traces, start, dash):
    """Points (x, y) of the traces of the upper plot whose name begins so, without the gaps, sorted."""
    found = {
        (x, y)
        for trace in traces
        if trace["name"].startswith(start) and trace["dash"] == dash and trace["row"] == 0
        for x, y in zip(trace["x"], trace["y"], strict=True)
        if x is not None
    }
    return np.array(sorted(found)).reshape(-1, 2)


def expected_points(curve, stable):
    on = curve.stable == stable
    return np.unique(np.stack([curve.detuning[on], curve.pipe_peak[on]], axis=1), axis=0)


def slow_curve(case):
    return frahm.frequency_response(case, detuning=case.analysis.detuning, method="slow-flow", points=400)


def shows(visitor, case):
    """Whether the slow flow of a case is drawn: every point of Python's curve, to 1e-9, and no other."""
    curve, traces = slow_curve(case), visitor.lines()
    for stable, dash in ((True, "solid"), (False, "dash")):
        drawn, expected = points_of(traces, "slow flow", dash), expected_points(curve, stable)
        if not len(expected):
            if len(drawn):
                return False
            continue
        # A line runs on to the first point of the next one, so that no gap is seen between them.
        distance = [np.min(np.max(np.abs(drawn - point) / (1e-12 + np.abs(point)), axis=1)) for point in expected]
        everything = np.concatenate([expected_points(curve, s) for s in (True, False) if np.any(curve.stable == s)])
        foreign = [np.min(np.max(np.abs(everything - p) / (1e-12 + np.abs(p)), axis=1)) for p in drawn]
        if max(distance) > 1e-9 or max(foreign) > 1e-9:
            return False
    return True


def test_each_slider_draws_the_numbers_of_python(visit):
    visitor, case = visit().rest(), CASE
    assert shows(visitor, case)
    for name, change in CHANGES.items():
        before, last = visitor.field(name).input_value(), case
        visitor.slider(name).focus()
        for _ in range(3):
            visitor.page.keyboard.press("ArrowRight")
        expect(visitor.field(name)).not_to_have_value(before)
        visitor.page.wait_for_timeout(500)  # until the field shows the last of the keys, too

        def as_in_the_field(change=change, last=last, name=name):
            return change(last, float(visitor.field(name).input_value()))

        assert wait_until(lambda now=as_in_the_field: shows(visitor, now())), name
        case = as_in_the_field()
    visitor.rest()
    curve = frahm.frequency_response(case, detuning=case.analysis.detuning)
    drawn = np.concatenate([points_of(visitor.lines(), "exact", dash) for dash in ("solid", "dash")])
    distance = [np.min(np.max(np.abs(np.stack([curve.detuning, curve.pipe_peak], 1) - p), axis=1)) for p in drawn]
    assert len(drawn) > 50
    assert max(distance) < 1e-9


def test_the_detuning_moves_the_mark_and_the_manifold(visit):
    visitor = visit().rest()
    visitor.slider("detuning").focus()
    visitor.page.keyboard.press("Home")
    expect(visitor.field("detuning")).to_have_value("-0.4")
    visitor.field("detuning").fill("-0.05")
    visitor.field("detuning").press("Enter")
    found = frahm.slow_flow_map(CASE, detuning=-0.05)
    expected = found["pipe_amplitude"].values[found["stability"].values >= 0]

    def marked():
        marks = [t for t in visitor.lines() if t["name"] == "at the detuning set" and t["row"] == 0]
        return marks and marks[0]["x"] == [-0.05] * expected.size and np.allclose(marks[0]["y"], expected, rtol=1e-12)

    assert wait_until(marked)
    (fold,) = [t for t in visitor.lines("manifold") if t["name"] == "fold"]
    W = CASE.pipe.frequency - 0.05
    lam = CASE.absorbers[0].normalised(247.0)["xi2"] / (0.02 * W)
    nu = (2 - np.sqrt(1 - 3 * lam**2)) / 3  # domain: closed form of the folds
    assert wait_until(
        lambda: np.isclose(
            next(t for t in visitor.lines("manifold") if t["name"] == "fold")["x"][0],
            np.sqrt(nu * 0.02 * W**2 / (0.75 * CASE.absorbers[0].normalised(247.0)["kappa"])), rtol=1e-9,
        )
    ), fold  # fmt: skip
    assert visitor.text("exact-status").startswith("Exact response:")  # it does not depend on the detuning


def test_presets_show_the_curves_of_the_paper(visit):
    visitor = visit()
    for figure, kappa, xi2 in ((5, 97.97, 0.0085), (6, 24.425, 0.0085), (7, 367.38, 0.0085), (10, 367.38, 0.0044),
                               (11, 367.38, 0.0117)):  # fmt: skip
        visitor.page.get_by_role("button", name=f"Fig. {figure}", exact=True).click()
        expect(visitor.field("kappa")).to_have_value(str(kappa))
        expect(visitor.field("xi2")).to_have_value(str(xi2))
        case = CASE.with_absorber(kappa=kappa, xi2=xi2)
        assert wait_until(lambda now=case: shows(visitor, now)), figure
        assert f"Fig. {figure} of Yang" in visitor.text("case-name")


def test_bad_entries_are_explained_beside_the_field(visit):
    visitor = visit().rest()
    before = visitor.lines()
    for name, text, change in (
        ("pipe-frequency", "0.8 kg", lambda: CASE.with_pipe(frequency="0.8 kg")),
        ("xi2", "-1", lambda: CASE.with_absorber(xi2=-1.0)),
    ):
        with pytest.raises(frahm.ParameterError) as caught:
            change()
        visitor.field(name).fill(text)
        visitor.field(name).press("Enter")
        expect(visitor.page.locator(f"#problem-{name}")).to_have_text(str(caught.value))
        expect(visitor.field(name)).to_have_attribute("aria-invalid", "true")
        expect(visitor.page.locator("#slow-status")).to_contain_text("last valid values")
    assert visitor.lines() == before
    visitor.page.locator("#save").click()
    expect(visitor.page.locator("#notice")).to_contain_text("see the field marked")
    for name, text in (("pipe-frequency", "0.78 Hz"), ("xi2", "0.0117")):
        visitor.field(name).fill(text)
        visitor.field(name).press("Enter")
    expect(visitor.page.locator("#problem-xi2")).to_be_empty()
    expect(visitor.field("xi2")).not_to_have_attribute("aria-invalid", "true")
    assert wait_until(lambda: shows(visitor, CASE.with_pipe(frequency="0.78 Hz").with_absorber(xi2=0.0117)))


def test_a_wind_that_sheds_outside_the_window_is_said_and_not_clamped(visit):
    visitor = visit().rest()
    visitor.field("detuning").fill("0.2")
    visitor.field("wind-speed").fill("5")
    visitor.page.locator("#to-wind").click()
    at = vortex_shedding(CASE.with_wind(speed=5.0)).detuning
    assert at == pytest.approx(4.38, abs=0.005)
    expect(visitor.page.locator("#notice")).to_contain_text(
        "The wind sheds at detuning 4.38 rad/s, outside the window -0.4 ... 0.4 rad/s"
    )
    assert visitor.field("detuning").input_value() == "0.2"
    visitor.field("wind-speed").fill(f"{CASE.wind.speed}")
    visitor.page.locator("#to-wind").click()
    expect(visitor.page.locator("#notice")).to_be_empty()
    at = vortex_shedding(CASE).detuning
    expect(visitor.field("detuning")).to_have_value(f"{at:.6g}")


def test_an_answer_that_is_overdue_is_said_and_what_is_drawn_pales(visit):
    visitor, held = visit().rest(), []
    response, status = visitor.page.locator("#response"), visitor.page.locator("#slow-status")
    pale = re.compile(r"\bstale\b")
    expect(response).not_to_have_class(pale)
    before = visitor.lines()
    visitor.page.route(
        "**/drawn/response", lambda route: held.append(route)
    )  # as long as a curve without damping may take
    visitor.field("xi2").fill("0")
    expect(status).to_contain_text("Computing … What is drawn, in a paler tint, is of the last values.")
    for name in ("response", "map", "manifold"):
        expect(visitor.page.locator(f"#{name}")).to_have_class(pale)
    assert visitor.lines() == before
    while held:
        held.pop().continue_()
    visitor.page.unroute("**/drawn/response")
    expect(status).to_contain_text("Slow flow:")
    for name in ("response", "map", "manifold"):
        expect(visitor.page.locator(f"#{name}")).not_to_have_class(pale)
    assert wait_until(lambda: shows(visitor, CASE.with_absorber(xi2=0)))
    visitor.page.route("**/drawn/response", lambda route: route.abort())
    visitor.field("xi2").fill("0.01")
    expect(status).to_contain_text("No answer came")
    visitor.page.unroute("**/drawn/response")
    visitor.faults.clear()  # the browser tells of the request that was cut off
    visitor.field("xi2").fill("0.02")
    expect(status).to_contain_text("Slow flow:")
    assert wait_until(lambda: shows(visitor, CASE.with_absorber(xi2=0.02)))


def test_two_visitors_do_not_mix(visit):
    one, two = visit(), visit()
    one.field("kappa").fill("50")
    two.field("kappa").fill("800")
    for visitor, kappa in ((one, 50), (two, 800)):
        assert wait_until(lambda v=visitor, k=kappa: shows(v, CASE.with_absorber(kappa=k)))
    one.page.locator("#find").click()
    expect(one.page.locator("#attractors")).to_contain_text("κ = 50,")
    assert two.page.locator("#attractors table").count() == 0
    assert two.field("kappa").input_value() == "800"


def test_a_click_on_the_curve_shows_the_motion_there(visit):
    visitor = visit().rest()
    curve = frahm.frequency_response(CASE, detuning=(-0.4, 0.4))
    index = int(np.argmin(np.abs(curve.detuning + 0.1)))
    visitor.page.evaluate(
        """([x, y]) => { const gd = document.querySelector('#response .js-plotly-plot');
          gd.emit('plotly_click', {points: [{curveNumber: 1, x, y, pointNumber: 0, data: gd.data[1]}]}); }""",
        [float(curve.detuning[index]), float(curve.pipe_peak[index])],
    )
    expect(visitor.page.locator("#motion-status")).to_contain_text("from the stable periodic response")
    expect(visitor.page.locator("#motion-status")).to_contain_text("periodic; at the end the pipe peaks at")
    expect(visitor.page.locator("#motion-status")).to_contain_text("κ = 367.38, ξ₂ = 0.0117, ρ₂ = 0.02,")
    peak = float(re.search(r"pipe peaks at ([\d.e-]+) m", visitor.text("motion-status"))[1])
    assert peak == pytest.approx(curve.pipe_peak[index], rel=1e-3)
    assert visitor.field("detuning").input_value() == f"{curve.detuning[index]:.6g}"
    assert wait_until(lambda: len(visitor.lines("motion")) >= 6)
    assert max(len(trace["x"]) for trace in visitor.lines("motion")) <= 2000

    def on_the_manifold():
        return [trace["y"] for trace in visitor.lines("manifold") if trace["name"] == "motion"]

    assert wait_until(on_the_manifold)
    assert on_the_manifold()[0][-1] == pytest.approx(curve.pipe_amplitude[index], rel=1e-3)
    visitor.field("kappa").fill("300")  # the motion of other values leaves the manifold
    assert wait_until(lambda: not on_the_manifold())


def test_the_motion_of_a_click_is_at_the_detuning_that_the_field_shows(visit):
    visitor = visit().rest()
    asked = []
    visitor.page.on("request", lambda request: asked.append(request.post_data or ""))
    for x, text in ((-0.10000000000000003, "-0.1"), (0.1234567890123, "0.123457"), (1e-17, "0"), (-0.4, "-0.4")):
        visitor.page.evaluate(
            """(x) => { const gd = document.querySelector('#response .js-plotly-plot');
              gd.emit('plotly_click', {points: [{curveNumber: 1, x, y: 0.01, pointNumber: 0, data: gd.data[1]}]}); }""",
            x,
        )
        expect(visitor.field("detuning")).to_have_value(text)
        expect(visitor.page.locator("#motion-status")).to_contain_text(f"At σ = {float(text):.4g} rad/s")
        clicked = re.findall(r'"place":([^,]+),"near"', "".join(asked))
        assert float(clicked[-1]) == float(text)


def test_attractors_are_searched_and_marked(visit):
    visitor = visit().rest()
    visitor.field("detuning").fill("0")
    visitor.field("detuning").press("Enter")
    visitor.page.locator("#find").click()
    expect(visitor.page.locator("#job-status")).to_contain_text("attractor")
    found = frahm.find_attractors(CASE, detuning=0.0, samples=200, seed=1)
    expect(visitor.page.locator("#attractors tbody tr")).to_have_count(len(found))
    expect(visitor.page.locator("#attractors tbody tr").first).to_contain_text(f"{found[0].pipe_peak:.4g}")
    stars = [trace for trace in visitor.lines() if trace["name"] == "attractor found"]
    assert stars[0]["y"] == [one.pipe_peak for one in found]
    expect(visitor.page.locator("#attractors")).not_to_have_class("stale")
    visitor.field("detuning").fill("0.01")  # elsewhere: the marks go, the table pales
    expect(visitor.page.locator("#attractors")).to_have_class("stale")
    assert wait_until(lambda: not [trace for trace in visitor.lines() if trace["name"] == "attractor found"])


def endless(tmp_path):
    """A case whose search for attractors does not end while a test looks at it."""
    CASE.with_analysis(samples=1_000_000).with_name("endless").to_yaml(tmp_path / "endless.yaml")
    return tmp_path / "endless.yaml"


def test_long_work_is_cancelled_and_ends_with_its_tab(visit, server, tmp_path):
    visitor = visit().rest()
    visitor.page.locator("#load input[type=file]").set_input_files(endless(tmp_path))
    expect(visitor.page.locator("#case-name")).to_contain_text("endless")
    visitor.rest()
    for end in (visitor.page.locator("#cancel").click, visitor.page.close):
        visitor.page.locator("#find").click()
        expect(visitor.page.locator("#progress")).to_contain_text("attractors")
        expect(visitor.page.locator("#cancel")).to_be_enabled()
        at_work = server.children()
        end()
        assert wait_until(lambda before=at_work: before - server.children())  # what did the work is no more
        if not visitor.page.is_closed():
            expect(visitor.page.locator("#job-status")).to_contain_text("Cancelled.")


def test_a_case_is_saved_loaded_and_refused(visit, tmp_path):
    visitor = visit()
    visitor.field("kappa").fill("222.5")
    assert wait_until(lambda: shows(visitor, CASE.with_absorber(kappa=222.5)))
    with visitor.page.expect_download() as saved:
        visitor.page.locator("#save").click()
    file = tmp_path / saved.value.suggested_filename
    saved.value.save_as(file)
    title = f"{CASE.title} (changed: kappa)"  # it is the case of the paper no more
    assert frahm.load_case(file).digest == CASE.with_absorber(kappa=222.5).with_name(CASE.name, title).digest
    assert wait_until(lambda: visitor.text("case-name") == f"{CASE.name}: {title}")
    with visitor.page.expect_download() as saved:
        visitor.page.locator("#save-curve").click()
    rows = [line for line in saved.value.path().read_text(encoding="utf-8").splitlines() if line[0] != "#"]
    assert len(rows) - 2 == slow_curve(CASE.with_absorber(kappa=222.5)).detuning.size
    text = file.read_text(encoding="utf-8")
    upload = visitor.page.locator("#load input[type=file]")
    upload.set_input_files(
        {"name": "typo.yaml", "mimeType": "text/yaml", "buffer": text.replace("speed", "sped").encode()}
    )
    expect(visitor.page.locator("#notice")).to_contain_text("Did you mean 'speed'?")
    expect(visitor.page.locator("#notice")).to_contain_text("typo.yaml:")
    visitor.page.get_by_role("button", name="Fig. 6", exact=True).click()
    expect(visitor.field("kappa")).to_have_value("24.425")
    expect(visitor.page.locator("#case-name")).not_to_contain_text("changed")
    upload.set_input_files(file)
    expect(visitor.field("kappa")).to_have_value("222.5")
    expect(visitor.page.locator("#case-name")).to_contain_text("(changed: kappa)")


def test_the_tuned_mass_damper_is_drawn_on_demand(visit):
    visitor = visit()
    assert not [trace for trace in visitor.lines() if trace["name"].startswith("tuned")]
    visitor.page.get_by_role("button", name="Compare with a tuned mass damper").click()
    assert wait_until(lambda: any(trace["name"].startswith("tuned") for trace in visitor.lines()))
    (tuned,) = [trace for trace in visitor.lines() if trace["name"].startswith("tuned") and trace["row"] == 0]
    assert max(tuned["y"]) == pytest.approx(0.0026, abs=5e-5)  # domain: of the same mass, on this pipe


def test_the_map_follows_its_plane_and_sets_values(visit):
    visitor = visit()
    visitor.page.get_by_role("button", name="damping ξ₂").click()
    expect(visitor.page.locator("#plane-xi2")).to_have_attribute("aria-pressed", "true")
    script = "document.querySelector('#map .js-plotly-plot').layout.yaxis.title.text"
    assert wait_until(lambda: "damping" in visitor.page.evaluate(script))
    visitor.page.evaluate(
        "() => document.querySelector('#map .js-plotly-plot').emit('plotly_click', {points: [{x: 0.02, y: 0.005}]})"
    )
    expect(visitor.field("xi2")).to_have_value("0.005")
    expect(visitor.field("detuning")).to_have_value("0.02")
    assert wait_until(lambda: shows(visitor, CASE.with_absorber(xi2=0.005)))


def test_a_drag_is_drawn_while_it_lasts(visit):
    visitor = visit().rest()
    box = visitor.slider("kappa").bounding_box()
    y = box["y"] + box["height"] / 2
    visitor.page.evaluate(
        "() => { window.redrawn = 0; document.querySelector('#response .js-plotly-plot')"
        ".on('plotly_afterplot', () => { window.redrawn += 1; }); }"
    )
    visitor.page.mouse.move(box["x"] + 0.4 * box["width"], y)
    visitor.page.mouse.down()
    for step in range(40):
        visitor.page.mouse.move(box["x"] + (0.4 + 0.005 * step) * box["width"], y)
    assert wait_until(lambda: visitor.page.evaluate("window.redrawn") >= 3)
    visitor.page.mouse.up()
    case = CASE.with_absorber(kappa=float(visitor.field("kappa").input_value()))
    assert wait_until(lambda: shows(visitor, case))


def test_nothing_leaves_the_machine_and_there_is_no_cloud(browser, server):
    context = browser.new_context(bypass_csp=False, viewport={"width": 1280, "height": 900})
    page, requests, faults = context.new_page(), [], []
    page.on("request", lambda request: requests.append(request.url))
    page.on("console", lambda said: said.type == "error" and faults.append(said.text))
    page.goto(server.address)
    page.wait_for_selector("#exact-status:has-text('Exact response:')", timeout=240_000)
    page.locator("#from-rest").click()
    expect(page.locator("#motion-status")).to_contain_text("pipe peaks", timeout=240_000)
    assert faults == []  # a breach of the policy of the page would be one
    foreign = [url for url in requests if not url.startswith((server.address, "data:", "blob:" + server.address))]
    assert foreign == []
    page.locator("#response").hover()
    titles = page.locator(".modebar-btn").evaluate_all("all => all.map((a) => a.getAttribute('data-title') || '')")
    assert any("Zoom" in title for title in titles)
    assert not [title for title in titles if re.search("cloud|share|chart studio|produced with", title, re.IGNORECASE)]
    assert not re.search(r"\bshare\b(?! of)|cloud", page.locator("body").inner_text(), re.IGNORECASE)
    context.close()


def test_everything_is_reached_and_operated_with_the_keyboard(visit):
    visitor = visit()
    page, seen = visitor.page, []
    page.locator("body").press("Tab")
    for _ in range(60):
        seen.append(page.evaluate("document.activeElement.id || document.activeElement.textContent"))
        page.keyboard.press("Tab")
    for name in (*CHANGES, "detuning"):
        assert f"field-{name}" in seen
        assert f"slider-{name}" in seen
    assert {"save", "save-curve", "to-wind", "tuned", "plane-xi2", "from-rest", "find", "report", "load-button"} <= set(
        seen
    )
    assert any("Fig. 10" in text for text in seen)
    page.locator("#save").focus()
    for _ in range(20):
        page.keyboard.press("Shift+Tab")
        if page.evaluate("document.activeElement.textContent") == "Fig. 6":
            break
    page.keyboard.press("Enter")
    expect(visitor.field("kappa")).to_have_value("24.425")
    page.locator("#tuned").focus()
    page.keyboard.press("Space")
    assert wait_until(lambda: any(trace["name"].startswith("tuned") for trace in visitor.lines()))
    page.locator("#plane-xi2").focus()
    page.keyboard.press("Enter")
    script = "document.querySelector('#map .js-plotly-plot').layout.yaxis.title.text"
    assert wait_until(lambda: "damping" in page.evaluate(script))
    outline = page.evaluate("getComputedStyle(document.activeElement).outlineStyle")
    assert outline != "none"


@pytest.mark.parametrize("width", [1280, 390])
def test_no_serious_accessibility_fault_and_nothing_is_cut_off(visit, width):
    visitor = visit()
    visitor.page.set_viewport_size({"width": width, "height": 844})
    visitor.rest()
    visitor.page.locator("#from-rest").click()
    expect(visitor.page.locator("#motion-status")).to_contain_text("pipe peaks")
    visitor.page.locator("#find").click()
    expect(visitor.page.locator("#attractors tbody tr").first).to_be_visible()
    visitor.field("kappa").fill("none")
    expect(visitor.page.locator("#problem-kappa")).not_to_be_empty()
    assert axe_faults(visitor.page) == []
    wide, cut = visitor.page.evaluate(
        """() => {
          const right = document.documentElement.clientWidth + 1;
          const texts = [...document.querySelectorAll('button, label, h2, p, .key li')];
          const outside = (one) => !one.closest('.js-plotly-plot, .table, .unseen')
            && one.getBoundingClientRect().right > right;
          const short = (one) => !one.matches('.unseen') && one.clientWidth > 0
            && one.scrollWidth > one.clientWidth + 1;
          return [[...document.querySelectorAll('body *')].filter(outside), texts.filter(short)]
            .map((all) => all.map((one) => one.outerHTML)); }"""
    )
    assert wide == []
    assert cut == []


def test_foreign_hosts_and_origins_are_refused_by_the_running_server(server):
    for headers, status in (
        ({}, 200), ({"Host": f"localhost:{server.port}"}, 200), ({"Host": "frahm.example"}, 403),
        ({"Host": f"127.0.0.1:{server.port}", "Origin": "http://evil.example"}, 403),
    ):  # fmt: skip
        connection = http.client.HTTPConnection("127.0.0.1", server.port)
        connection.request("GET", "/_dash-layout", headers=headers)
        assert connection.getresponse().status == status
        connection.close()


BARE = frahm.load_case(
    {
        "name": "brace",
        "pipe": {
            "kind": "tube", "diameter": "24 inch", "wall": "0.5 inch", "length": "28 m", "damping_ratio": 0.0015,
            "mode_count": 3, "supports": [{"at": 0, "kind": "clamped"}, {"at": "28 m", "kind": "pinned"}],
        },
        "wind": {"speed": 12.0, "range": [0.0, 14.0], "strouhal": "en1991", "lift_coefficient": "en1991"},
        "absorbers": [], "limits": {"amplitude_ratio": 0.05},
    }
)  # fmt: skip


@pytest.mark.parametrize("width", [1280, 390])
def test_a_bare_pipe_in_the_wind_is_decided(visit, tmp_path, width):
    visitor = visit().rest()
    visitor.page.set_viewport_size({"width": width, "height": 844})
    load(visitor, BARE, tmp_path)
    results = analyse(BARE).results
    cell = visitor.page.locator("#decision-bare-peak")
    expect(cell).to_have_text(f"{1e3 * results['without_absorber']['worst']['pipe_peak']:.1f} mm")
    expect(visitor.page.locator("#decision-bare-verdict")).to_have_text(results["acceptance"]["verdict"].upper())
    expect(visitor.page.locator("#decision-tuned-verdict")).to_have_text("PASS")
    expect(visitor.page.locator("#decision-this")).to_be_hidden()
    expect(visitor.page.locator("#decision-status")).to_contain_text(results["acceptance"]["sentence"])


def test_a_server_that_has_ended_is_reported_and_leaves_no_process(context):
    server = start("jacket-pipe")
    visitor = Visitor(context.new_page(), server.address).open()
    assert wait_until(lambda: server.children())
    workers = server.children()
    server.process.kill()
    server.process.wait()
    expect(visitor.page.locator("#lost")).to_be_visible()
    expect(visitor.page.locator("#lost")).to_contain_text("has ended")
    assert axe_faults(visitor.page) == []

    def alive(pid):
        try:
            with open(f"/proc/{pid}/stat", encoding="ascii") as stat:
                return stat.read().split()[2] != "Z"
        except OSError:
            return False

    assert wait_until(lambda: not any(alive(pid) for pid in workers))


def test_the_way_of_a_newcomer(visit, tmp_path):
    """Change a slider, save the case, get the report of the page, run the same case: the numbers are the same."""
    quick = CASE.with_absorber(kappa=5.0, xi2=0.1).with_analysis(samples=2, periods=100, detuning=(-0.02, 0.02))
    quick.with_name("quick").to_yaml(tmp_path / "quick.yaml")
    visitor = visit()
    visitor.page.locator("#load input[type=file]").set_input_files(tmp_path / "quick.yaml")
    expect(visitor.page.locator("#case-name")).to_contain_text("quick")
    visitor.slider("kappa").focus()
    visitor.page.keyboard.press("ArrowRight")
    expect(visitor.field("kappa")).not_to_have_value("5")
    with visitor.page.expect_download() as saved:
        visitor.page.locator("#save").click()
    saved.value.save_as(tmp_path / "mine.yaml")
    mine = frahm.load_case(tmp_path / "mine.yaml")
    assert mine.absorbers[0].normalised(mine.pipe.mass)["kappa"] == pytest.approx(
        float(visitor.field("kappa").input_value()), rel=1e-12
    )
    with visitor.page.expect_download(timeout=PATIENCE) as saved:
        visitor.page.locator("#report").click()
        expect(visitor.page.locator("#progress")).to_contain_text(re.compile(r"report: .*\(\d+ of \d+\)"))
    text = saved.value.path().read_text(encoding="utf-8")
    assert "<html" in text
    assert mine.digest in text
    assert mine.title == f"{CASE.title} (changed: kappa)"
    heading = re.search(r"<h1[^>]*>(.*?)</h1>", text, re.DOTALL)[1]
    assert "(changed: kappa)" in heading
    verdict = visitor.text("job-status").removeprefix("The report was saved by the browser. ")
    assert verdict == analyse(mine).verdict


def load(visitor, case, tmp_path):
    case.to_yaml(tmp_path / f"{case.name}.yaml")
    visitor.page.locator("#load input[type=file]").set_input_files(tmp_path / f"{case.name}.yaml")
    expect(visitor.page.locator("#case-name")).to_contain_text(case.name)


def exact_is_drawn(visitor, case):
    """Whether what is drawn of the exact response are points of Python's curve, to 1e-9, from end to end."""
    curve = frahm.frequency_response(case, detuning=case.analysis.detuning)
    traces = [trace for trace in visitor.lines() if trace["opacity"] != 0.35]
    drawn = np.concatenate([points_of(traces, "exact", dash) for dash in ("solid", "dash")])
    if len(drawn) < 50:
        return False
    here = np.stack([curve.detuning, curve.pipe_peak], axis=1)
    distance = [np.min(np.max(np.abs(here - point), axis=1)) for point in drawn]
    ends = np.allclose([drawn[:, 0].min(), drawn[:, 0].max()], case.analysis.detuning, atol=1e-9)
    return max(distance) < 1e-9 and ends


def damped(kind, **law):
    """The case with an absorber of another kind."""
    absorber = {"name": kind, "mass": 4.94, "law": {"kind": kind, "damping": 4.16, **law}}
    return CASE.model_validate({**CASE.to_dict(), "name": kind, "absorbers": [absorber]})


@pytest.mark.parametrize(
    ("case", "slider", "change"),
    [
        (frahm.load_case("jacket-pipe-elastic"), "position", lambda case, value: case.with_absorber(position=value)),
        (damped("linear", stiffness=114.0), "law-stiffness", lambda case, value: damped("linear", stiffness=value)),
        (
            damped("polynomial", coefficients=[60.0, 0.0, 60000.0]), "law-c3",
            lambda case, value: damped("polynomial", coefficients=[60.0, 0.0, value]),
        ),
    ],
    ids=["elastic pipe", "tuned mass damper", "linear and cubic spring"],
)  # fmt: skip
def test_cases_without_slow_flow_are_drawn_exactly_when_the_sliders_rest(visit, tmp_path, case, slider, change):
    visitor = visit().rest()
    load(visitor, case, tmp_path)
    expect(visitor.page.locator("#slow-status")).to_contain_text("each time the sliders rest")
    expect(visitor.page.locator("#beside")).to_be_hidden()
    visitor.rest()
    assert wait_until(lambda: exact_is_drawn(visitor, case))
    assert not [trace for trace in visitor.lines() if trace["name"].startswith("slow flow")]
    before = visitor.field(slider).input_value()
    visitor.slider(slider).focus()
    for _ in range(30):
        visitor.page.keyboard.press("ArrowLeft")
    expect(visitor.field(slider)).not_to_have_value(before)
    visitor.rest()
    changed = change(case, float(visitor.field(slider).input_value()))
    assert wait_until(lambda: exact_is_drawn(visitor, changed))
    visitor.page.locator("#from-rest").click()
    expect(visitor.page.locator("#motion-status")).to_contain_text("pipe peaks")
    with visitor.page.expect_download() as saved:
        visitor.page.locator("#save-curve").click()
    assert saved.value.suggested_filename == f"{case.name}-exact.csv"
    visitor.page.get_by_role("button", name="Fig. 6", exact=True).click()
    expect(visitor.page.locator("#beside")).to_be_visible()
    assert wait_until(lambda: shows(visitor, CASE.with_absorber(kappa=24.425, xi2=0.0085)))
