r"""Formulas as MathML, written when the documentation is built: the pages need no script and no network.

`latex2mathml` turns LaTeX into MathML; what it does not know (aligned equations inside a display, primes behind an
index) is put in words it knows, and the spacing that TeX gives operators is added.
"""

from __future__ import annotations

import html
import re
from pathlib import Path
from xml.etree import ElementTree

from latex2mathml.converter import convert

NAMESPACE = "http://www.w3.org/1998/Math/MathML"
_INNER = r"align|aligned|alignedat|split|gathered|gather\*?|multline\*?"
_SIGNS = {"−", "+", "±", "∓"}
_OPENING, _CLOSING = set("([{⟨"), set(")]}⟩")
_KNOWN = {"align*", "array", "cases", "matrix", "pmatrix", "bmatrix", "Bmatrix", "vmatrix", "Vmatrix"}
_LENGTHS = re.compile(r"(?<![\\{\d.])(\d+[a-z])(?=[a-z](?![a-zA-Z]))")
_PRIMES = "′″‴"
_THIN = "0.167em"
_OUTSIDE = re.compile(
    r"""<(?:script|img|iframe|source|embed|video|audio)\b[^>]*?\bsrc\s*=\s*["']?(?:https?:)?//[^\s"'>]+"""
    r"""|<link\b(?=[^>]*\brel\s*=\s*["']?(?:stylesheet|preload|icon|preconnect|dns-prefetch))"""
    r"""[^>]*?\bhref\s*=\s*["']?(?:https?:)?//[^\s"'>]+"""
    r"""|(?:@import\s+(?:url\()?|\burl\()\s*["']?(?:https?:)?//[^\s"')]+""",
    re.IGNORECASE,
)


def mathml(tex: str, display: bool = False) -> str:
    r"""A formula as a MathML element.

    Parameters
    ----------
    tex : str
        LaTeX without the signs around it; environments of amsmath may be in it.
    display : bool
        Whether it stands on lines of its own.

    Raises
    ------
    ValueError
        If something in it cannot be turned into MathML.
    """
    try:
        element = ElementTree.fromstring(convert(_known(tex), display="block" if display else "inline"))
    except Exception as error:  # whatever the converter stumbles over, the page must not be built without it
        raise ValueError(f"cannot be turned into MathML ({error!r}): {tex}") from error
    _space(element)
    left = [text for text in element.itertext() if re.search(r"\\|&|''", text)]
    if left:
        raise ValueError(f"{left[0]!r} cannot be turned into MathML: {tex}")
    element.set("alttext", " ".join(tex.split()))
    ElementTree.register_namespace("", NAMESPACE)
    return ElementTree.tostring(element, encoding="unicode")


def outside(text: str) -> list[str]:
    """What a page or style sheet would fetch from elsewhere: scripts, styles, images, fonts; not links to follow."""
    return _OUTSIDE.findall(text)


def _known(tex: str) -> str:
    """The same formula in words that the converter knows."""
    tex = re.sub(r"\\(begin|end)\{equation\*?\}", "", tex)
    tex = re.sub(rf"\\(begin|end)\{{(?:{_INNER})\}}", r"\\\1{align*}", tex)
    unknown = set(re.findall(r"\\begin\{([^}]*)\}", tex)) - _KNOWN
    if unknown:
        raise ValueError(f"environment {', '.join(unknown)}")
    tex = _LENGTHS.sub(r"\1 ", tex)  # 2cm is no length here
    return re.sub(r"(?<![\\'])('+)", lambda primes: "^{" + _PRIMES[len(primes[1]) - 1] + "}", tex)


def _name(element: ElementTree.Element) -> str:
    return element.tag.rpartition("}")[2]


def _space(element: ElementTree.Element) -> None:
    """Space the operators of every row as TeX does; place columns and primes where browsers would not."""
    for child in element:
        _space(child)
    if _name(element) == "mtd":  # browsers read the style, not the attribute
        side = element.attrib.pop("columnalign", "center")
        element.set("style", f"text-align: {side}; text-align: -webkit-{side}; padding: 0.25em 0")
    if _name(element) in ("msup", "msubsup") and _text(element[-1]) in _PRIMES:
        _beside(element)
    if _name(element) not in ("math", "mrow", "mtd", "mstyle", "msqrt"):
        return
    row: list[ElementTree.Element] = []
    for child in element:
        core = _core(child)
        text = (core.text or "").strip()
        before = _core(row[-1]) if row else None
        if _is_function(core):
            core.tag = f"{{{NAMESPACE}}}mi"
            core.attrib.clear()
            if row and not _binds(row[-1]):
                row.append(_thin())
        elif before is not None and _is_function(before) and text not in _OPENING:
            row.append(_thin())
        if text in ("/", "|", "‖") and "form" not in core.attrib:  # a bar with a power would stretch alone
            core.attrib = {"lspace": "0", "rspace": "0", "stretchy": "false"}
        elif core is child and text in _SIGNS and _name(core) == "mo" and (not row or _binds(row[-1])):
            core.set("form", "prefix")
        row.append(child)
    element[:] = row


def _text(element: ElementTree.Element) -> str:
    return "".join(element.itertext()).strip()


def _beside(element: ElementTree.Element) -> None:
    """Set a prime beside what it belongs to, index included: its glyph is a raised one already."""
    prime = ElementTree.Element(f"{{{NAMESPACE}}}mo", lspace="0", rspace="0")
    prime.text = _text(element[-1])
    base = ElementTree.Element(f"{{{NAMESPACE}}}msub") if len(element) == 3 else element[0]
    if len(element) == 3:
        base.extend(list(element)[:2])
    element.tag = f"{{{NAMESPACE}}}mrow"
    element[:] = [base, prime]


def _core(element: ElementTree.Element) -> ElementTree.Element:
    """What an index or a power is attached to."""
    while _name(element) in ("msub", "msup", "msubsup", "munder", "mover", "munderover") and len(element):
        element = element[0]
    return element


def _is_function(core: ElementTree.Element) -> bool:
    text = (core.text or "").strip()
    return _name(core) in ("mo", "mi") and len(text) > 1 and text.isalpha() and text.isascii() \
        and core.get("mathvariant") is None  # fmt: skip


def _binds(element: ElementTree.Element) -> bool:
    """Whether a sign after this element belongs to what follows."""
    text = (element.text or "").strip()
    if _name(element) == "mspace" or (_name(element) == "mi" and not text):
        return True
    return _name(element) == "mo" and text not in _CLOSING and text not in ("|", "‖")


def _thin() -> ElementTree.Element:
    return ElementTree.Element(f"{{{NAMESPACE}}}mspace", width=_THIN)


# --- what Sphinx calls ----------------------------------------------------------------------------------------------


def setup(app) -> dict[str, bool]:
    """Register the renderer and the look through the finished pages."""
    app.add_html_math_renderer("mathml", (_visit_math, None), (_visit_block, None))
    app.connect("build-finished", _nothing_from_outside)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def _visit_math(translator, node) -> None:
    from docutils import nodes

    translator.body.append(_or_warned(node.astext(), False, node))
    raise nodes.SkipNode


def _visit_block(translator, node) -> None:
    from docutils import nodes
    from sphinx.util.math import get_node_equation_number

    number = get_node_equation_number(translator, node) if node.get("number") else ""
    translator.body.append(translator.starttag(node, "div", CLASS="formula"))
    translator.body.append(_or_warned(node.astext(), True, node))
    if number:
        translator.body.append(f'<span class="eqno">({number})')
        translator.add_permalink_ref(node, "Link to this equation")
        translator.body.append("</span>")
    translator.body.append("</div>\n")
    raise nodes.SkipNode


def _or_warned(tex: str, display: bool, node) -> str:
    """The formula; one that cannot be shown is shown as it was written, and the build says so."""
    from sphinx.util.logging import getLogger

    try:
        return mathml(tex, display)
    except ValueError as error:
        getLogger(__name__).warning(str(error), location=node, type="mathml")
        return f"<code>{html.escape(tex)}</code>"


def _nothing_from_outside(app, exception) -> None:
    """Warn of every page that would fetch something from another host."""
    from sphinx.util.logging import getLogger

    if exception is not None or app.builder.format != "html":
        return
    for path in sorted(Path(app.outdir).rglob("*")):
        if path.suffix in (".html", ".css"):
            for found in outside(path.read_text(encoding="utf-8")):
                getLogger(__name__).warning("%s fetches from elsewhere: %s", path.name, found, type="mathml")
