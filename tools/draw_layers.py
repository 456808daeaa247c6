#!/usr/bin/env python3
"""Draws the layers of the design, docs/pictures/layers.svg: the stages, and which includes which.

usage: draw_layers.py [FILE]     FILE is the picture (default: docs/pictures/layers.svg); - for standard output

The stages and links are those of CMakeLists.txt, as check_layers.py reads them. A link that follows from others is
omitted. A stage is drawn one row above the highest that it includes.
"""

import re
import sys
from pathlib import Path
from statistics import fmean

from check_layers import read_layers, reachable

ROOT = Path(__file__).resolve().parents[1]
PICTURE = ROOT / "docs" / "pictures" / "layers.svg"
BOX = (116, 38)          # width and height of a stage
GAP = (28, 46)           # between boxes beside and above each other
LANE = 12                # width of a line that passes a row
PORT = 16                # between lines at the same edge of a box
SWEEPS = 24
# boxes and lines are readable on white and on black
LIBRARY, PROGRAM, LINE, TEXT = "#cfe3f7", "#f7dfb8", "#7d8696", "#1c2430"
LIBRARY_STAGE = re.compile(r"^prostm_stage\((\w+)", re.M)  # the program's are indented, in an if()


def essential(layers):
    """Returns stage -> the stages that it links, without those that follow from its other links."""
    def is_brought(name, links):
        return any(name in reachable(layers, layers[other]) for other in links if other != name)
    return {stage: [name for name in dict.fromkeys(links) if not is_brought(name, links)]
            for stage, links in layers.items()}


def rows_of(links):
    """Returns stage -> its row, 0 for the lowest. Stages come after those that they link."""
    row = {}
    for stage, names in links.items():
        row[stage] = 1 + max((row[name] for name in names), default=-1)
    return row


def with_lanes(links, row):
    """Returns the rows as lists of nodes, the lowest first, and the lines between neighbouring rows, (upper, lower). A
    line over several rows crosses each through a lane, the node (stage, name, row)."""
    rows = [[] for _ in range(max(row.values()) + 1)]
    for stage in links:
        rows[row[stage]].append(stage)
    lines = []
    for stage, names in links.items():
        for name in names:
            upper = stage
            for between in range(row[stage] - 1, row[name], -1):
                lane = (stage, name, between)
                rows[between].append(lane)
                lines.append((upper, lane))
                upper = lane
            lines.append((upper, name))
    return rows, lines


def crossings(rows, lines):
    place = {node: i for nodes in rows for i, node in enumerate(nodes)}
    height = {node: y for y, nodes in enumerate(rows) for node in nodes}
    return sum((place[a] - place[c]) * (place[b] - place[d]) < 0
               for i, (a, b) in enumerate(lines) for c, d in lines[:i] if height[a] == height[c])


def neighbours_of(lines):
    found = {}
    for upper, lower in lines:
        found.setdefault(upper, ([], []))[1].append(lower)
        found.setdefault(lower, ([], []))[0].append(upper)
    return found


def order(rows, lines):
    """Orders each row by the mean place of its neighbours, up and down in turn, and returns the order with the fewest
    crossings."""
    neighbours = neighbours_of(lines)
    best = [list(nodes) for nodes in rows]
    rows = [list(nodes) for nodes in rows]
    for sweep in range(SWEEPS):
        side = sweep % 2  # 0: by the row above
        for nodes in (rows[-2::-1] if side == 0 else rows[1:]):
            place = {node: (i + 0.5) / len(others) for others in rows for i, node in enumerate(others)}

            def mean(node):
                near = neighbours.get(node, ([], []))[side]
                return fmean(place[other] for other in near) if near else place[node]
            nodes.sort(key=mean)
        if crossings(rows, lines) < crossings(best, lines):
            best = [list(nodes) for nodes in rows]
    return best


def width_of(node):
    return BOX[0] if isinstance(node, str) else LANE


def least_gap(left, right):
    return (width_of(left) + width_of(right)) / 2 + GAP[0]


def places_of(rows, lines):
    """Returns node -> x of its middle: near the mean of its neighbours, in the order of its row."""
    neighbours, x = neighbours_of(lines), {}
    for nodes in rows:
        at = 0.0
        for left, node in zip([None, *nodes], nodes):
            at += least_gap(left, node) if left is not None else 0.0
            x[node] = at
    for sweep in range(4 * SWEEPS):
        for nodes in rows if sweep % 2 else rows[::-1]:
            for node in nodes:
                above, below = neighbours.get(node, ([], []))
                near = above + below
                if near:
                    x[node] = fmean(x[other] for other in near)
            spread(nodes, x)
    left = min(x[node] - width_of(node) / 2 for nodes in rows for node in nodes)
    return {node: at - left for node, at in x.items()}


def spread(nodes, x):
    """Moves nodes apart that are too close to each other, equally to the left and to the right."""
    pushed_right, pushed_left = [x[nodes[0]]], [x[nodes[-1]]]
    for left, node in zip(nodes, nodes[1:]):
        pushed_right.append(max(x[node], pushed_right[-1] + least_gap(left, node)))
    for right, node in zip(nodes[::-1], nodes[-2::-1]):
        pushed_left.append(min(x[node], pushed_left[-1] - least_gap(node, right)))
    for node, a, b in zip(nodes, pushed_right, pushed_left[::-1]):
        x[node] = (a + b) / 2


def ports_of(lines, x, end):
    """Returns line -> x where it touches its upper (end 0) or lower (end 1) node, in the order of its other ends."""
    ports = {}
    for node in x:
        own = sorted((line for line in lines if line[end] == node), key=lambda line: x[line[1 - end]])
        ports |= {line: x[node] + PORT * (i - (len(own) - 1) / 2) for i, line in enumerate(own)}
    return ports


def curve(ports, top, line):
    """Returns the path of a line from the lower edge of its upper node to the upper edge of its lower one."""
    upper, lower = line
    (x0, y0), (x1, y1) = (ports[0][line], top[upper] + BOX[1]), (ports[1][line], top[lower])
    tip = 0 if isinstance(lower, tuple) else 4
    middle = (y0 + y1) / 2
    path = f"M{x0:.0f} {y0}C{x0:.0f} {middle:.0f} {x1:.0f} {middle:.0f} {x1:.0f} {y1 - tip}"
    return path + (f"V{y1 + BOX[1]}" if isinstance(lower, tuple) else "")


def box(stage, x, y, colour):
    return (f'  <rect x="{x - BOX[0] / 2:.0f}" y="{y}" width="{BOX[0]}" height="{BOX[1]}" rx="6" fill="{colour}"/>\n'
            f'  <text x="{x:.0f}" y="{y + BOX[1] // 2 + 5}">{stage}</text>\n')


def draw(root=ROOT):
    """Returns the picture of the layers of a checkout."""
    links = essential(read_layers(root))
    library = set(LIBRARY_STAGE.findall((root / "CMakeLists.txt").read_text(encoding="utf-8")))
    rows, lines = with_lanes(links, rows_of(links))
    rows = order(rows, lines)
    x = {node: at + 20 for node, at in places_of(rows, lines).items()}
    top = {node: 20 + (len(rows) - 1 - y) * (BOX[1] + GAP[1]) for y, nodes in enumerate(rows) for node in nodes}
    width = max(x[node] + width_of(node) / 2 for node in x) + 20
    height = len(rows) * (BOX[1] + GAP[1]) + 30
    ports = [ports_of(lines, x, end) for end in (0, 1)]
    ends = [line for line in lines if isinstance(line[1], str)]
    passing = [line for line in lines if line not in ends]
    paths = "".join(f'  <path d="{curve(ports, top, line)}"{tip}/>\n'
                    for tip, some in (("", passing), (' marker-end="url(#tip)"', ends)) for line in some)
    boxes = "".join(box(stage, x[stage], top[stage], LIBRARY if stage in library else PROGRAM) for stage in links)
    return f"""\
<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height}" width="{width:.0f}" height="{height}"
     font-family="DejaVu Sans, Helvetica, Arial, sans-serif" font-size="15" role="img"
     aria-label="The stages of prostm in layers; an arrow leads to a stage that may be included">
<!-- written by tools/draw_layers.py from CMakeLists.txt -->
<marker id="tip" viewBox="0 0 8 8" refX="4" refY="4" markerWidth="8" markerHeight="8" markerUnits="userSpaceOnUse"
        orient="auto"><path d="M0 0 8 4 0 8z" fill="{LINE}"/></marker>
<g fill="none" stroke="{LINE}" stroke-width="1.6">
{paths}</g>
<g fill="{TEXT}" text-anchor="middle">
{boxes}</g>
<g fill="{LINE}" font-size="13">
  <rect x="20" y="{height - 26}" width="14" height="14" rx="3" fill="{LIBRARY}"/>
  <text x="40" y="{height - 14}">library</text>
  <rect x="110" y="{height - 26}" width="14" height="14" rx="3" fill="{PROGRAM}"/>
  <text x="130" y="{height - 14}">program alone</text>
  <text x="250" y="{height - 14}">A → B: A may include B; links that follow from others are left out</text>
</g>
</svg>
"""


def main():
    if len(sys.argv) > 2 or sys.argv[1:] in (["-h"], ["--help"]):
        print(__doc__.strip())
        return 0 if len(sys.argv) == 2 else 2
    if sys.argv[1:] == ["-"]:
        sys.stdout.write(draw())
    else:
        Path(sys.argv[1] if len(sys.argv) == 2 else PICTURE).write_text(draw(), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
