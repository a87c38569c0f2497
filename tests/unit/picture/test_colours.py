# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Colours of the picture: contrast in light and dark, and for programs without variables."""

from __future__ import annotations

import colorsys
import re
from importlib.resources import files

import pytest

from rmw_manycore_py.picture.drawing import stylesheet
from rmw_manycore_py.picture.marks import CPU_LEVELS

pytestmark = pytest.mark.unit

STYLE = stylesheet()
LIGHT, DARK = (
    dict(re.findall(r"--([\w-]+): #(\w{6})", re.search(f"{theme}[^{{]*{{([^}}]*)}}", STYLE)[1]))  # type: ignore[index]
    for theme in (r'theme="light"', r'theme="dark"')
)
Colour = tuple[float, ...]


def colour(text: str) -> Colour:
    return tuple(int(text[n : n + 2], 16) / 255 for n in (0, 2, 4))


def contrast(one: Colour, other: Colour) -> float:
    """Return the contrast as WCAG 2 defines it."""

    def luminance(rgb: Colour) -> float:
        parts = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in rgb]
        return sum(
            share * part for share, part in zip((0.2126, 0.7152, 0.0722), parts, strict=True)
        )

    high, low = sorted((luminance(one), luminance(other)), reverse=True)
    return (high + 0.05) / (low + 0.05)


def cpu_colour(level: int, behind: Colour) -> Colour:
    found = re.search(rf"\.cpu{level} {{ fill: hsl\((\d+) (\d+)% (\d+)% / ([\d.]+)\)", STYLE)
    assert found
    hue, saturation, lightness, share = map(float, found.groups())
    rgb = colorsys.hls_to_rgb(hue / 360, lightness / 100, saturation / 100)
    return tuple(share * c + (1 - share) * b for c, b in zip(rgb, behind, strict=True))


@pytest.mark.parametrize("theme", [LIGHT, DARK], ids=["light", "dark"])
def test_lines_stand_out_and_texts_are_readable(theme: dict[str, str]) -> None:
    for what, behind in (
        *(("line", behind) for behind in ("paper", "cluster", "receive", "node")),
        *((what, behind) for what in ("topic", "bad", "warn") for behind in ("paper", "cluster")),
        ("fill", "free"),
    ):
        assert contrast(colour(theme[what]), colour(theme[behind])) >= 3, (what, behind)
    for what, behind in (
        ("ink", "node"),
        ("faint", "cluster"),
        ("faint", "free"),
        ("topic", "paper"),
    ):
        assert contrast(colour(theme[what]), colour(theme[behind])) >= 4.5, (what, behind)
    for level in range(1, CPU_LEVELS + 1):
        cell = cpu_colour(level, colour(theme["cluster"]))
        assert contrast(colour(theme["ink"]), cell) >= 4.5, level


def test_curves_of_the_page_stand_out_on_both_panels() -> None:
    page = files("rmw_manycore_py.view") / "page"
    curves = re.search(r"COLOURS = \[([^]]*)\]", (page / "charts.js").read_text())
    assert curves
    panels = set(re.findall(r"--panel: #(\w{6})", (page / "page.css").read_text()))
    assert len(panels) == 2
    for panel in panels:
        for curve in re.findall(r"#(\w{6})", curves[1]):
            assert contrast(colour(curve), colour(panel)) >= 3, curve


def test_each_colour_is_also_there_without_variables() -> None:
    for name in re.findall(r"([\w-]+): [^;{}]*var\(--", STYLE):
        assert re.search(rf"{name}: [^;{{}}v]+; {name}: [^;{{}}]*var", STYLE), name
    without = re.sub(r" [\w-]+: [^;{}]*var\([^;]*;", "", STYLE)
    assert "var(" not in without
    assert without.count("fill: #") > 10
