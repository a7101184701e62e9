"""The pages of the documentation: formulas without a script, nothing from another host, every public name described."""

import re
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest

ROOT = Path(__file__).resolve().parents[3]
DOCS = ROOT / "docs"
sys.path.insert(0, str(DOCS))
from mathml import mathml, outside  # noqa: E402

PAGES = sorted(DOCS.glob("*.md"))
CONFIGURATION = """
import sys
sys.path.insert(0, {docs!r})
extensions = ["myst_parser", "mathml"]
html_math_renderer = "mathml"
html_theme = "furo"
html_static_path = [{docs!r} + "/_static"]
html_css_files = ["tables.css"]
myst_enable_extensions = ["dollarmath", "amsmath"]
"""


def formulas(text):
    """LaTeX of every formula of a page, and whether it stands on lines of its own."""
    text = re.sub(r"```.*?```|`[^`\n]*`", "", text, flags=re.DOTALL)
    found = re.findall(r"\$\$(.*?)\$\$|\$([^$\n]+(?:\n[^$\n]+)?)\$", text, re.DOTALL)
    return [(block or inline, bool(block)) for block, inline in found]


def read(element):
    """A formula as a reader sees it: rows, indices and powers in brackets."""
    parts = [read(child) for child in element]
    name = element.tag.rpartition("}")[2]
    if name == "msub":
        return f"{parts[0]}_({parts[1]})"
    if name == "msup":
        return f"{parts[0]}^({parts[1]})"
    if name == "msubsup":
        return f"{parts[0]}_({parts[1]})^({parts[2]})"
    if name == "mfrac":
        return f"({parts[0]})/({parts[1]})"
    if name == "msqrt":
        return f"√({''.join(parts)})"
    if name == "mtable":
        return " ; ".join(parts)
    if name == "mtr":
        return " & ".join(parts)
    return (element.text or "").strip() + "".join(parts)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_every_formula_of_the_pages_becomes_mathml(page):
    for tex, block in formulas(page.read_text(encoding="utf-8")):
        assert ElementTree.fromstring(mathml(tex, block)).get("display") == ("block" if block else "inline")


def test_there_are_formulas():
    assert sum(len(formulas(page.read_text(encoding="utf-8"))) for page in PAGES) > 200


@pytest.mark.parametrize(
    ("tex", "seen"),
    [
        (r"x_1'' + q'", "x_(1)″+q′"),
        (r"N = \frac{4\rho_2\omega^2}{9\kappa}", "N=(4ρ_(2)ω^(2))/(9κ)"),
        (r"m^3 + 2cm^2 + m = h", "m^(3)+2cm^(2)+m=h"),
        (r"\pm\sqrt{L_0^2 - L^2}", "±√(L_(0)^(2)−L^(2))"),
        (r"\begin{aligned} a &= b, \\ c_k &= -d \end{aligned}", "a & =b, ; c_(k) & =−d"),
        (r"\begin{align} a &= b \\ c &= d \end{align}", "a & =b ; c & =d"),
        (r"\begin{equation} a = b \end{equation}", "a=b"),
        (r"F\cos\Omega t", "FcosΩt"),
        (r"\bigl|\,a\,\bigr|^2", "|a|^(2)"),
    ],
)
def test_a_formula_says_what_its_latex_says(tex, seen):
    assert read(ElementTree.fromstring(mathml(tex))) == seen


def test_the_letters_of_a_product_are_no_length():
    """2cm is two, c and m; upright letters in one piece would be centimetres."""
    letters = [e.text for e in ElementTree.fromstring(mathml("2cm^2")).iter() if e.tag.endswith("}mi")]
    assert letters == ["c", "m"]


@pytest.mark.parametrize("tex", [r"\nosuchcommand x", r"\begin{nosuch} a \end{nosuch}", "a^b^c"])
def test_what_cannot_be_shown_is_not_shown_wrongly(tex):
    with pytest.raises(ValueError, match="MathML"):
        mathml(tex)


def test_what_a_page_fetches_from_elsewhere_is_seen():
    fetched = (
        '<script async src="https://cdn.example/mathjax.js"></script>',
        "<script src=//cdn.example/x.js>",
        '<link href="https://fonts.example/a.css" rel="stylesheet">',
        '<img alt="a" src="http://example.org/a.png"/>',
        "@import url('https://fonts.example/b.css')",
        "src: url(https://fonts.example/c.woff2)",
    )
    for text in fetched:
        assert len(outside(text)) == 1, text
    followed = '<a href="https://doi.org/10.3390/app12147272">doi</a> <script src="_static/a.js"></script>'
    assert outside(followed + '<img src="data:image/png;base64,AAAA"> url(data:x) <link rel="next" href="a">') == []


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """The pages with most formulas, one with a number, and one that is wrong, as Sphinx builds them."""
    source, out = tmp_path_factory.mktemp("docs"), tmp_path_factory.mktemp("built")
    (source / "conf.py").write_text(CONFIGURATION.format(docs=str(DOCS)), encoding="utf-8")
    for name in ("theory", "harmonic_balance", "force_laws"):
        text = (DOCS / f"{name}.md").read_text(encoding="utf-8")
        (source / f"{name}.md").write_text(re.sub(r"```\{include\}.*?```", "", text, flags=re.DOTALL), "utf-8")
    (source / "index.md").write_text("# Numbered\n\n$$\na = b\n$$ (first)\n\nSee {eq}`first`.\n", "utf-8")
    (source / "wrong.md").write_text('# Wrong\n\n$\\nosuch x$\n\n<img src="https://example.org/a.png">\n', "utf-8")
    done = subprocess.run(
        [sys.executable, "-m", "sphinx", "-q", "-b", "html", str(source), str(out)],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return out, done.stderr


def test_the_build_warns_of_a_wrong_formula_and_of_other_hosts(built):
    _, said = built
    assert "nosuch" in said
    assert "wrong.html fetches from elsewhere" in said
    assert said.count("fetches from elsewhere") == 1


def test_numbered_equations_are_numbered(built):
    page = (built[0] / "index.html").read_text(encoding="utf-8")
    assert re.search(r'<div class="formula"[^>]*id="equation-first".*?</math><span class="eqno">\(1\)', page, re.DOTALL)
    assert re.search(r'href="#equation-first">\(1\)</a>', page)


@pytest.mark.parametrize("name", ["theory", "harmonic_balance", "force_laws"])
def test_no_formula_is_cut_off(browser, built, name):
    """On a screen of 1280 pixels, without a network."""
    page = browser.new_context(viewport={"width": 1280, "height": 900}, offline=True).new_page()
    asked = []
    page.on("request", lambda request: asked.append(request.url))
    page.goto((built[0] / f"{name}.html").as_uri())
    assert page.locator("math").count() > 25
    assert [url for url in asked if not url.startswith(("file:", "data:"))] == []
    wide = "(box) => box.scrollWidth > box.clientWidth + 1 || box.scrollHeight > box.clientHeight + 1"
    cut = page.evaluate(f"[...document.querySelectorAll('.formula')].filter({wide}).map((box) => box.innerText)")
    assert cut == []
    flat = "[...document.querySelectorAll('math')].filter((m) => m.getBoundingClientRect().height < 4).length"
    assert page.evaluate(flat) == 0
    page.context.close()
