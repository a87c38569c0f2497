# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""SVG of the picture."""

from __future__ import annotations

import re
from collections.abc import Iterator
from html import escape
from importlib.resources import files

from rmw_manycore_py.errors import shorten
from rmw_manycore_py.picture.arcs import Arc
from rmw_manycore_py.picture.geometry import Rect, head_of, path_of
from rmw_manycore_py.picture.layout import Cell, ClusterBox, Layout, NodeBox
from rmw_manycore_py.picture.marks import Mark, Marks
from rmw_manycore_py.picture.plan import CELL_HEAD, GAP, NODE_HEIGHT, WORKER_SIDE
from rmw_manycore_py.picture.texts import BOLD, fitted

_NO_MARK: Mark = {}
_VARIABLE = re.compile(r"(--[\w-]+): ([^;]+);")
_WITH_VARIABLES = re.compile(r"[\w-]+: [^;{}]*var\(--[^;{}]*;")


def stylesheet() -> str:
    """Return the style sheet, for light and dark backgrounds.

    Programs that know no variables read the colours of the light one.
    """
    text = files(__package__).joinpath("chip.css").read_text()
    light = dict(_VARIABLE.findall(text[: text.index("}")]))

    def with_light_before(found: re.Match[str]) -> str:
        plain = re.sub(r"var\((--[\w-]+)\)", lambda name: light[name[1]], found[0])
        return f"{plain} {found[0]}"

    return _WITH_VARIABLES.sub(with_light_before, text)


def draw(title: str, layout: Layout, marks: Marks, *, standalone: bool = True) -> str:
    """Return the SVG; with `standalone`, including its style sheet."""
    width, height = layout.size
    return "\n".join(
        (
            f'<svg xmlns="http://www.w3.org/2000/svg" class="chip" role="group" '
            f'aria-label="{_text(title)}" viewBox="0 0 {width:.0f} {height:.0f}">',
            f"<style>{stylesheet()}</style>" if standalone else "",
            f'<rect class="paper" width="{width:.0f}" height="{height:.0f}"/>'
            if standalone
            else "",
            *(line for box in layout.clusters for line in _cluster(box, marks)),
            *(line for arc in layout.arcs for line in _arc(arc, marks)),
            *(line for node in layout.nodes for line in _node(node)),
            *(line for arc in layout.arcs for line in _label(arc, marks)),
            "</svg>",
        )
    )


def _cluster(box: ClusterBox, marks: Marks) -> Iterator[str]:
    state = "" if box.is_used else " unused"
    x, y = box.rect.x + 12, box.rect.y + 19
    name = f"cluster {box.id}" + ("" if box.is_used else ": not in use")
    yield f'<g class="cluster{state}">{_rect("outline", box.rect, 6)}'
    yield f'<text class="name" x="{x}" y="{y}">{name}</text>'
    if box.is_used:
        fill = marks.get(f"k{box.id}-fill", _NO_MARK)
        bar = Rect(box.smem.x, box.smem.y, float(fill.get("width", 0)), box.smem.height)
        receive = _class(marks, f"k{box.id}-rt", "receive")
        yield _rect("bar", box.smem, 2)
        yield _rect(_class(marks, f"k{box.id}-fill", "fill"), bar, 2, f"k{box.id}-fill")
        yield _right_text(f"k{box.id}-smem", box.rect.x + box.rect.width - 12, y, marks)
        yield _rect(receive, box.receive_thread, 3, f"k{box.id}-rt")
        yield (
            f'<text id="k{box.id}-rt-text" class="small on-cell" x="{x + 6}" y="{box.rect.y + 54}">'
            f"{_content(marks, f'k{box.id}-rt-text')}</text>"
        )
    for cell in box.cells:
        yield from _cell(cell, marks)
    for core, tile in box.free.items():
        yield _rect("tile", tile, 2, title=f"core {core}: free")
        yield f'<text class="number" x="{tile.centre[0]:.1f}" y="{tile.y + 10.5:.1f}">{core}</text>'
    yield "</g>"


def _cell(cell: Cell, marks: Marks) -> Iterator[str]:
    x, y = cell.rect.x, cell.rect.y
    name = "no core" if cell.plan.core is None else f"core {cell.plan.core}"
    yield _rect(_class(marks, cell.id, "cell"), cell.rect, 4, cell.id)
    yield f'<text class="small on-cell" x="{x + 6:.1f}" y="{y + 13:.1f}">{name}</text>'
    if cell.plan.living:
        yield _right_text(cell.cpu_id, x + cell.rect.width - 6, y + 13, marks, "on-cell")
    if cell.hidden:
        below = y + CELL_HEAD + len(cell.nodes) * NODE_HEIGHT + 12
        at = f'x="{x + 6:.1f}" y="{below:.1f}"'
        yield f'<text class="small on-cell" {at}>+{cell.hidden} more</text>'
    bottom = y + cell.rect.height - WORKER_SIDE - 4
    for place, pid in enumerate(cell.plan.workers):
        rect = Rect(x + GAP + place * (WORKER_SIDE + 2), bottom, WORKER_SIDE, WORKER_SIDE)
        style = _class(marks, f"w{pid}", "worker")
        yield _rect(style, rect, 1, f"w{pid}", f"NDT worker, pid {pid}")


def _node(node: NodeBox) -> Iterator[str]:
    state = " dead" if node.is_dead else ""
    spoken = f"{node.name}, {'died' if node.is_dead else node.kind}, cluster {node.member.cluster}"
    shown = fitted(node.shown_name, node.rect.width - 10)
    yield (
        f'<g id="{_text(node.id)}" class="{node.kind}{state}" data-node="{_text(node.name)}" '
        f'tabindex="0" role="button" aria-label="{_text(spoken)}"><title>{_text(node.name)} '
        f"(pid {node.member.pid}){' died' if node.is_dead else ''}</title>"
    )
    yield _rect("body", node.rect, 3)
    yield (
        f'<text x="{node.rect.x + 5:.1f}" y="{node.rect.y + 12.5:.1f}">{_text(shown)}</text></g>'
    )


def _arc(arc: Arc, marks: Marks) -> Iterator[str]:
    path = "".join(map(path_of, arc.lines))
    name, names = _text(arc.wire.topics[0]), _text(", ".join(arc.wire.topics))
    yield (
        f'<g id="{_text(arc.id)}" class="{_class(marks, arc.id, "topic")}" data-topic="{name}" '
        f'tabindex="0" role="button" aria-label="topic {names}"><title>{names}</title>'
        f'<path class="touch" d="{path}"/><path class="line" d="{path}"/>'
        f'<path class="head" d="{"".join(map(head_of, arc.lines))}"/></g>'
    )


def _label(arc: Arc, marks: Marks) -> Iterator[str]:
    """Yield the name above the line, and the load below."""
    if arc.label is not None:
        x, y = arc.label.centre
        name = fitted(arc.name, arc.label.width, BOLD)
        yield (
            f'<g class="label" data-of="{_text(arc.id)}">'
            f'<text class="topic-name" x="{x:.1f}" y="{y - 4:.1f}">{_text(name)}</text>'
            f'<text id="{_text(arc.label_id)}" class="topic-load" x="{x:.1f}" y="{y + 11:.1f}">'
            f"{_content(marks, arc.label_id)}</text></g>"
        )


def _rect(style: str, rect: Rect, radius: int, own_id: str = "", title: str = "") -> str:
    named = f' id="{_text(own_id)}"' if own_id else ""
    end = f"><title>{_text(title)}</title></rect>" if title else "/>"
    return (
        f'<rect{named} class="{style}" x="{rect.x:.1f}" y="{rect.y:.1f}" width="{rect.width:.1f}" '
        f'height="{rect.height:.1f}" rx="{radius}"{end}'
    )


def _right_text(own_id: str, x: float, y: float, marks: Marks, style: str = "") -> str:
    place = f'class="small right {style}" x="{x:.1f}" y="{y:.1f}"'
    return f'<text id="{own_id}" {place}>{_content(marks, own_id)}</text>'


def _class(marks: Marks, own_id: str, otherwise: str) -> str:
    return str(marks.get(own_id, _NO_MARK).get("class", otherwise))


def _content(marks: Marks, own_id: str) -> str:
    return _text(str(marks.get(own_id, _NO_MARK).get("text", "")))


def _text(text: str) -> str:
    """Escape a name chosen by another process: neither markup nor control characters."""
    return escape(shorten(text))
