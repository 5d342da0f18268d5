"""An outline as SVG, and as DXF of AutoCAD release 12, which all programs read. One unit of a drawing is the deck's unit of length."""

from xml.sax.saxutils import escape, quoteattr

SCALES = {"m": 1000.0, "mm": 1.0, "cm": 10.0, "in": 25.4, "ft": 304.8}  # mm
LAYERS = {"LINKS": 5, "GUIDES": 8, "SPRINGS": 6, "PINS": 7, "GROUND": 3, "BLOCKS": 1, "NAMES": 7}  # colours of DXF
STROKES = {"LINKS": "#1f4e8c", "GUIDES": "#888888", "SPRINGS": "#8c1f7a", "PINS": "#000000", "GROUND": "#1a7a1a", "BLOCKS": "#b00000"}


def _lines(outline):
    """layer, name, ends"""
    for layer, ways in (("LINKS", outline.links), ("SPRINGS", outline.springs)):
        for name, way in ways.items():
            yield from ((layer, name, start, end) for start, end in zip(way, way[1:]))
    yield from (("GUIDES", "", start, end) for start, end in outline.guides)


def _circles(outline):
    """layer, name, centre, radius"""
    for name, place in outline.pins.items():
        layer = "GROUND" if name in outline.ground else "BLOCKS" if name in outline.blocks else "PINS"
        yield layer, name, place, outline.size()/(80 if layer == "GROUND" else 120)


def _number(value):
    return f"{value + 0.0:.9g}"


def svg(outline, title):
    x1, y1, x2, y2 = outline.corners()
    edge = outline.size()/10
    x1, y1, width, height = x1 - edge, y1 - edge, x2 - x1 + 2*edge, y2 - y1 + 2*edge
    scale = SCALES[outline.unit]
    # y is upwards in a linkage, downwards in a picture.
    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{_number(width*scale)}mm" height="{_number(height*scale)}mm" '
             f'viewBox="{_number(x1)} {_number(-y1 - height)} {_number(width)} {_number(height)}">',
             f"<title>{escape(title)}</title>",
             f'<g fill="none" stroke-width="{_number(outline.size()/300)}" stroke-linecap="round" '
             f'font-family="sans-serif" font-size="{_number(outline.size()/40)}">']
    for layer, name, start, end in _lines(outline):
        dashes = f' stroke-dasharray="{_number(outline.size()/60)}"' if layer != "LINKS" else ""
        lines.append(f'<line x1="{_number(start[0])}" y1="{_number(-start[1])}" x2="{_number(end[0])}" y2="{_number(-end[1])}" '
                     f'stroke="{STROKES[layer]}"{dashes} data-name={quoteattr(name)}/>')
    for layer, name, place, radius in _circles(outline):
        lines.append(f'<circle cx="{_number(place[0])}" cy="{_number(-place[1])}" r="{_number(radius)}" stroke="{STROKES[layer]}" '
                     f'fill="white"/>')
        lines.append(f'<text x="{_number(place[0] + 2*radius)}" y="{_number(-place[1] - 2*radius)}" fill="black">{escape(name)}</text>')
    return "\n".join(lines + ["</g>", "</svg>"]) + "\n"


def dxf(outline, title):
    pairs = [(999, title.replace("\n", " ")), (0, "SECTION"), (2, "HEADER"), (9, "$ACADVER"), (1, "AC1009")]
    x1, y1, x2, y2 = outline.corners()
    pairs += [(9, "$EXTMIN"), (10, x1), (20, y1), (9, "$EXTMAX"), (10, x2), (20, y2), (0, "ENDSEC")]
    pairs += [(0, "SECTION"), (2, "TABLES"), (0, "TABLE"), (2, "LAYER"), (70, len(LAYERS))]
    for layer, colour in LAYERS.items():
        pairs += [(0, "LAYER"), (2, layer), (70, 0), (62, colour), (6, "CONTINUOUS")]
    pairs += [(0, "ENDTAB"), (0, "ENDSEC"), (0, "SECTION"), (2, "ENTITIES")]
    for layer, _, start, end in _lines(outline):
        pairs += [(0, "LINE"), (8, layer), (10, start[0]), (20, start[1]), (11, end[0]), (21, end[1])]
    for layer, name, place, radius in _circles(outline):
        pairs += [(0, "CIRCLE"), (8, layer), (10, place[0]), (20, place[1]), (40, radius)]
        pairs += [(0, "TEXT"), (8, "NAMES"), (10, place[0] + 2*radius), (20, place[1] + 2*radius), (40, outline.size()/40), (1, name)]
    pairs += [(0, "ENDSEC"), (0, "EOF")]
    return "".join(f"{code:3}\n{f'{value:.12g}' if isinstance(value, float) else value}\n" for code, value in pairs)
