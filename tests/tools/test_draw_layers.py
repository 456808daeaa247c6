"""The figure of the layers: it matches CMakeLists.txt, and shows each stage and each essential link once."""

import sys
import xml.etree.ElementTree as ET
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
import draw_layers  # noqa: E402
from check_layers import read_layers, reachable  # noqa: E402

SVG = "{http://www.w3.org/2000/svg}"


def test_the_figure_in_docs_is_up_to_date():
    assert draw_layers.PICTURE.read_text(encoding="utf-8") == draw_layers.draw(), "run tools/draw_layers.py"


def test_it_shows_every_stage_and_every_essential_link():
    picture = ET.fromstring(draw_layers.draw())
    texts = [text.text for text in picture.iter(SVG + "text")]
    layers = read_layers(ROOT)
    assert set(layers) <= set(texts)
    arrows = [path for path in picture.iter(SVG + "path") if path.get("marker-end")]
    assert len(arrows) == sum(map(len, draw_layers.essential(layers).values()))


def test_implied_links_are_omitted():
    layers = {"core": [], "plan": ["core"], "emit": ["plan", "core"], "score": ["plan", "emit"]}
    links = draw_layers.essential(layers)
    assert links == {"core": [], "plan": ["core"], "emit": ["plan"], "score": ["emit"]}
    assert all(reachable(links, [stage]) == reachable(layers, [stage]) for stage in layers)


def test_boxes_neither_overlap_nor_leave_the_figure():
    picture = ET.fromstring(draw_layers.draw())
    width, height = map(float, picture.get("viewBox").split()[2:])
    boxes = [[float(rect.get(key)) for key in ("x", "y", "width", "height")] for rect in picture.iter(SVG + "rect")]
    for i, (x, y, w, h) in enumerate(boxes):
        assert x >= 0 and y >= 0 and x + w <= width and y + h <= height
        assert all(x + w <= a or a + c <= x or y + h <= b or b + d <= y for a, b, c, d in boxes[:i])
