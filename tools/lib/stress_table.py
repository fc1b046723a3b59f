"""What `isolux stress` found, as a table in Markdown: a line a sweep, a column a renderer."""

DEVICE, SINGLE = "device", "single precision"


def between(labels):
    return f"{labels[0]} … {labels[-1]}"


def range_cell(sweep, renderer):
    """Between which steps a renderer is right; empty if it tried none."""
    found = sweep["range"].get(renderer)
    if found is None:
        return ""
    if found["within"] == found["steps"]:
        return "all"
    return between([found["first"], found["last"]]) if found["within"] else "none"


def promised_cell(sweep):
    labels = [step["label"] for step in sweep["steps"] if step["promised"]]
    if len(labels) == len(sweep["steps"]):
        return "all"
    return between(labels) if labels else "none"


def others(report):
    """Renderers beside ours."""
    return sorted({name for family in report["families"] for sweep in family["sweeps"] for name in sweep["range"]}
                  - {DEVICE, SINGLE})


def stress_table(report):
    headings = ["family", "sweep", "steps", "promised", DEVICE, SINGLE,
                *(f"{name}, to 1 %" for name in others(report)), "what limits the device"]
    rows = []
    for family in report["families"]:
        name, limit = family["name"], None
        for sweep in family["sweeps"]:
            labels = [step["label"] for step in sweep["steps"]]
            said = "as above" if sweep["limit"] == limit else sweep["limit"]
            rows.append([name, f"{sweep['name']} ({sweep['axis']})", between(labels), promised_cell(sweep),
                         *(range_cell(sweep, renderer) for renderer in (DEVICE, SINGLE, *others(report))), said])
            name, limit = "", sweep["limit"]
    return "".join(f"| {' | '.join(cells)} |\n" for cells in [headings, ["---"] * len(headings), *rows])
