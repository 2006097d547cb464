"""How pictures look: one style sheet, a palette for tasks, hatch patterns for states."""

from __future__ import annotations

from amalthea_uros.report.pictures.jobs import State
from amalthea_uros.report.pictures.svg import Markup, element, joined

#: Pixels.
TITLE_SIZE, TEXT_SIZE, SMALL_SIZE = 16, 12, 11

#: Fill, outline, and text on the fill. The colours can be told apart with all kinds of colour vision: M. Okabe and K. Ito, "Color
#: universal design", 2008. Their vermilion is kept for missed deadlines and limits, their black is that of the text.
PALETTE = (
    ("#0072b2", "#0072b2", "#fff"),
    ("#e69f00", "#d18f00", "#111"),
    ("#009e73", "#009e73", "#111"),
    ("#56b4e9", "#3aa2de", "#111"),
    ("#cc79a7", "#cc79a7", "#111"),
    ("#f0e442", "#c9bc00", "#111"),
)
_ALERT = "#d55e00"

#: Outlines tell the process of a box that is too narrow for its filling.
_TASKS = "\n".join(
    f".amuros-picture .c{number}{{fill:{fill};stroke:{outline}}}\n.amuros-picture .t{number}{{stroke:{outline}}}\n"
    f".amuros-picture text.on{number}{{fill:{on_fill}}}"
    for number, (fill, outline, on_fill) in enumerate(PALETTE)
)
_FONTS = 'system-ui,-apple-system,"Segoe UI",Roboto,Arial,sans-serif'
_SHEET = f"""
.amuros-picture{{color:#1f2328;max-width:100%;height:auto;font:{TEXT_SIZE}px {_FONTS}}}
.amuros-picture text{{fill:currentColor;font-variant-numeric:tabular-nums}}
.amuros-picture .paper{{fill:#fff}}
.amuros-picture .title{{font-size:{TITLE_SIZE}px;font-weight:600}}
.amuros-picture .header{{font-weight:600}}
.amuros-picture .small{{font-size:{SMALL_SIZE}px}}
.amuros-picture text.muted{{fill-opacity:.72}}
.amuros-picture .gap{{stroke:#fff;stroke-width:1.5;fill:none}}
.amuros-picture .instant{{stroke:currentColor;stroke-opacity:.45;stroke-width:.7;fill:none}}
.amuros-picture .halo{{stroke:#fff;stroke-opacity:.8;stroke-width:3.5;stroke-linejoin:round;fill:none}}
.amuros-picture text.halo{{paint-order:stroke;fill:currentColor}}
.amuros-picture .label{{fill:#fff;fill-opacity:.86;stroke:none}}
.amuros-picture .band{{fill:currentColor;fill-opacity:.04}}
.amuros-picture .grid{{stroke:currentColor;stroke-opacity:.13;fill:none}}
.amuros-picture .rule{{stroke:currentColor;stroke-opacity:.55;fill:none}}
.amuros-picture .line{{stroke:currentColor;stroke-width:1.5;fill:none}}
.amuros-picture .mark{{stroke:currentColor;stroke-width:1.2;fill:none}}
.amuros-picture .head{{fill:currentColor}}
.amuros-picture .alert{{stroke:{_ALERT};stroke-width:2;fill:none}}
.amuros-picture .late{{fill:{_ALERT};fill-opacity:.3;stroke:{_ALERT}}}
.amuros-picture .bound{{stroke:#0072b2;stroke-width:2;fill:none}}
.amuros-picture .empty{{fill:none}}
.amuros-picture .good{{stroke:#009e73;stroke-width:2;fill:none}}
.amuros-picture .unsure{{stroke:currentColor;stroke-opacity:.6;stroke-width:2;fill:none}}
.amuros-picture .frame{{fill:currentColor;fill-opacity:.03;stroke:currentColor;stroke-opacity:.35}}
.amuros-picture .box{{fill:#fff;stroke:currentColor;stroke-width:1.2}}
.amuros-picture .flow{{stroke:currentColor;stroke-opacity:.7;stroke-width:1.2;stroke-linejoin:round;fill:none}}
.amuros-picture .way{{stroke-width:4;stroke-opacity:.75;stroke-linejoin:round;fill:none}}
{_TASKS}
.amuros-picture .bars{{stroke:#fff;stroke-width:.5}}
.amuros-picture .steps{{fill:none;stroke-width:2}}
@media screen and (prefers-color-scheme:dark){{
.amuros-picture{{color:#e6e8eb}}
.amuros-picture .paper,.amuros-picture .box{{fill:#15181d}}
.amuros-picture .halo,.amuros-picture .gap,.amuros-picture .bars{{stroke:#15181d}}
.amuros-picture .label{{fill:#15181d}}
.amuros-picture .bound{{stroke:#56b4e9}}
}}
"""

_UNKNOWN_ID = "amuros-unknown"
#: The fill of what is unknown.
UNKNOWN = f"url(#{_UNKNOWN_ID})"

_ARROW = "amuros-arrow"
#: The value of `marker_end` for an arrow.
ARROW_END = f"url(#{_ARROW})"
#: Lines within a tile of so many pixels; what is drawn behind them is as opaque as the second number says.
_HATCHES = {
    State.READY: ("M-1 7L7 -1M-1 1L1 -1M5 7L7 5", 6, 0.16, 1.3),
    State.POLLING: ("M2 0V4", 4, 0.3, 2),
    State.PARKING: ("M0 0L6 6M0 6L6 0", 6, 0.12, 0.9),
    State.WAITING: ("M1 1.5h1.4M4 4.5h1.4", 6, 0.08, 1.4),
}


def style_sheet() -> Markup:
    """The style of all pictures; several in a page may repeat it."""
    return element("style", Markup(_SHEET))


def hatches(body: str) -> Markup:
    """The patterns that a body uses: of all states but those that have none, in all colours, and of what is unknown."""
    patterns = {_hatch_id(state, colour): _hatch(state, colour) for state in _HATCHES for colour in range(len(PALETTE))}
    patterns[_UNKNOWN_ID] = _unknown()
    return joined(pattern for name, pattern in patterns.items() if f"url(#{name})" in body)


def _unknown() -> Markup:
    lines = element("path", d="M-1 9L9 -1M-1 1L1 -1M7 9L9 7", class_="unsure", stroke_width=1)
    return element("pattern", lines, id=_UNKNOWN_ID, width=8, height=8, patternUnits="userSpaceOnUse")


def arrow_tip() -> Markup:
    """The end of an arrow, as a marker."""
    tip = element("path", d="M0 0L7 3.5L0 7Z", class_="head")
    return element(
        "marker", tip, id=_ARROW, refX=7, refY=3.5, markerWidth=7, markerHeight=7, markerUnits="userSpaceOnUse", orient="auto"
    )


def _hatch(state: State, colour: int) -> Markup:
    lines, size, opacity, width = _HATCHES[state]
    ground = element("rect", width=size, height=size, fill=PALETTE[colour][0], fill_opacity=opacity)
    drawn = element("path", d=lines, stroke=PALETTE[colour][1], stroke_width=width, fill="none")
    return element(
        "pattern", ground, drawn, id=_hatch_id(state, colour), width=size, height=size, patternUnits="userSpaceOnUse"
    )


def _hatch_id(state: State, colour: int) -> str:
    return f"amuros-{state}-{colour}"


def state_look(state: State, colour: int) -> dict[str, str]:
    """The attributes of boxes in a state: filled, hatched, or empty, in the colour of the process."""
    number = colour % len(PALETTE)
    if state in _HATCHES:
        return {"class_": f"t{number}", "fill": f"url(#{_hatch_id(state, number)})"}
    return {"class_": f"c{number}"} if state is State.RUNNING else {"class_": f"t{number} empty"}
