"""Keys of the figures, as text beside samples of the lines: readable by everybody, and drawn only once."""

from __future__ import annotations

from typing import Any

from dash import html

from frahm.plotting.style import BARE, GREEN, INK, PAIR, PIPE, SINK
from frahm.web.looks import BARE_LINE, MAP_CLASSES, MAP_COLOURS, TUNED_LINE

_SILENT: dict[str, Any] = {"aria-hidden": "true"}


def _line(text: str, colour: str, width: float, style: str = "solid", look: str = "") -> html.Li:
    sample = html.Span(className="line", style={"borderTop": f"{width}px {style} {colour}"}, **_SILENT)
    return html.Li([sample, text], className=look)


def _mark(text: str, sign: str, colour: str, look: str = "") -> html.Li:
    return html.Li([html.Span(sign, className="sign", style={"color": colour}, **_SILENT), text], className=look)


def _patch(text: str, colour: str) -> html.Li:
    return html.Li([html.Span(className="square", style={"background": colour}, **_SILENT), text])


def _key(*entries: html.Li) -> html.Ul:
    return html.Ul(list(entries), className="key")


def response_key() -> html.Ul:
    """Key of the response."""
    return _key(
        _line("exact, stable", PIPE, 3),
        _line("exact, unstable", PIPE, 3, "dashed"),
        _line("detached", SINK, 3),
        _line("asymmetric", PAIR, 3),
        _line("slow flow, stable", INK, 1.5, look="slow-only"),
        _line("slow flow, unstable", INK, 1.5, "dashed", look="slow-only"),
        _line(BARE_LINE, BARE, 1.5, "dotted"),
        _line(TUNED_LINE, GREEN, 2, "dashed"),
        _mark("at the detuning set", "○", SINK, look="slow-only"),
        _mark("attractor found", "★", GREEN),
        _mark("SN saddle-node", "▲", INK),
        _mark("H Hopf", "■", INK, look="slow-only"),
        _mark("NS Neimark-Sacker", "◆", INK),
        _mark("PD period doubling", "▼", INK),
        _mark("BP branch point", "✚", INK),
    )


def manifold_key() -> html.Ul:
    """Key of the slow manifold."""
    return _key(
        _line("attracting", INK, 2),
        _line("repelling", INK, 2, "dashed"),
        _mark("fold", "▲", INK),
        _mark("response", "○", SINK),
        _line("motion computed below", GREEN, 1.5),
    )


def map_key() -> html.Ul:
    """Key of the stability map."""
    squares = [_patch(name, colour) for name, colour in zip(MAP_CLASSES, MAP_COLOURS, strict=True)]
    return _key(*squares, _mark("set now (click to set)", "✚", INK))
