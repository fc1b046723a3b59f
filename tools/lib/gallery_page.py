"""The gallery's page: one HTML file with its images in it, for light and dark, wide and narrow screens."""

import base64
import html
import itertools
import re

# Beyond this the difference of the means is marked, if its whole interval lies there.
MARKED_BIAS = 0.01

NO_BREAK = "\u00a0"

STYLE = """
:root { color-scheme: light dark; --back: #fbfbfa; --card: #ffffff; --text: #1c1d1f; --soft: #5d6167; --line: #dcdee1;
        --warn: #8a5a00; --bad: #b3261e; --tint: #f1f2f3; }
@media (prefers-color-scheme: dark) {
  :root { --back: #131416; --card: #1c1e21; --text: #e8e9eb; --soft: #a0a5ac; --line: #34373c; --warn: #e5b454;
          --bad: #ff8a80; --tint: #25282c; } }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 90rem; padding: 1.5rem 1rem 4rem; background: var(--back); color: var(--text);
       font: 15px/1.45 system-ui, sans-serif; }
h1 { font-size: 1.5rem; margin: 0; } h2 { font-size: 1.1rem; margin: 2.5rem 0 .75rem; }
p { margin: .25rem 0; color: var(--soft); }
.sheet { display: grid; gap: 1rem; grid-template-columns: repeat(auto-fill, minmax(min(100%, 16rem), 1fr)); margin-top: 1.5rem; }
.sheet.pairs { grid-template-columns: repeat(auto-fill, minmax(min(100%, 28rem), 1fr)); }
figure { margin: 0; background: var(--card); border: 1px solid var(--line); border-radius: 8px; overflow: hidden; }
.pair { display: flex; background: #000; aspect-ratio: 4 / 3; } .pairs .pair { aspect-ratio: 8 / 3; }
.pair > * { flex: 1 1 0; min-width: 0; position: relative; }
.pair img { display: block; width: 100%; height: 100%; object-fit: contain; }
.pair small { position: absolute; left: .4rem; bottom: .3rem; color: #fff; background: #0009; border-radius: 4px; padding: 0 .35rem; }
.none { position: absolute; inset: 0; display: grid; place-items: center; color: #b9bdc3; letter-spacing: .04em; }
figcaption { padding: .55rem .75rem .65rem; overflow-wrap: anywhere; }
figcaption span { display: block; color: var(--soft); font-size: .87rem; }
figcaption b { display: block; margin-bottom: .15rem; }
.tags { display: flex; flex-wrap: wrap; gap: .25rem; margin: .35rem 0 .1rem; }
figcaption .tags span { background: var(--tint); border-radius: 4px; padding: 0 .4rem; font-size: .8rem; }
figcaption details { font-size: .87rem; color: var(--warn); }
figcaption .bad, .bad { color: var(--bad); } figcaption .warn, .warn { color: var(--warn); }
.scroll { overflow-x: auto; border: 1px solid var(--line); border-radius: 8px; background: var(--card); }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; font-size: .9rem; }
th, td { padding: .45rem .75rem; border-bottom: 1px solid var(--line); text-align: right; white-space: nowrap; vertical-align: top; }
th { color: var(--soft); font-weight: 600; background: var(--tint); }
tr:last-child td { border-bottom: 0; }
th:first-child, td:first-child { text-align: left; position: sticky; left: 0; background: var(--card); }
th:first-child { background: var(--tint); }
td:last-child, th:last-child { text-align: left; white-space: normal; min-width: 14rem; }
summary { cursor: pointer; } ul { margin: .3rem 0 0; padding-left: 1.1rem; } li { overflow-wrap: anywhere; }
@media (max-width: 40rem) { td:first-child { max-width: 8.5rem; white-space: normal; overflow-wrap: anywhere; } }
"""


def text(value):
    return html.escape(str(value))


def number(value, layout, nothing="–"):
    return nothing if value is None else format(value, layout)


def percent(value):
    return number(value, ".2%").replace("%", NO_BREAK + "%")


def signed_percent(value):
    return format(value, "+.2%").replace("%", NO_BREAK + "%").replace("-", "−")


def bias_of(entry):
    """Relative bias of luminance with its interval: lower, value, upper; nothing without a finite one."""
    bias = ((entry["comparison"] or {}).get("relativeBias") or {}).get("luminance")
    return bias if bias and None not in bias else None


def bias_text(entry):
    bias = bias_of(entry)
    if bias:
        lower, value, upper = map(signed_percent, bias)
        return f"{value} [{lower},{NO_BREAK}{upper}]"
    return (entry["comparison"] or {}).get("error", "–")


def is_marked(entry):
    bias = bias_of(entry)
    return bool(bias) and (bias[0] > MARKED_BIAS or bias[2] < -MARKED_BIAS)


def embedded(path):
    return "data:image/png;base64," + base64.b64encode(path.read_bytes()).decode()


def picture(path, label, note, instead):
    """An image with a note in its corner; over it, or for lack of it, the word `instead`."""
    image = f'<img alt="{text(label)}" loading="lazy" src="{embedded(path)}">' if path and path.exists() else ""
    word = f"<div class=none>{instead}</div>" if instead else ""
    return f"<div>{image}{word}{note and f'<small>{note}</small>'}</div>"


def plural(count, what):
    return f"{count} {what}{'' if count == 1 else 's'}"


def reference_text(entry):
    """Error and bias against another renderer's image, or the same one's."""
    if "error" in entry["comparison"]:
        return entry["comparison"]["error"]
    return f"against its reference: relative RMSE {percent(entry['comparison']['relativeRmse'])}, bias {bias_text(entry)}"


def has_failed_verification(entry):
    """Whether pixels differ from the CPU reference's by more than rounding and what it sets off."""
    return bool(entry["verification"]) and entry["verification"].get("unexplained") != 0


def verification_text(entry):
    """Pixels on the same random numbers as the CPU reference."""
    found = entry["verification"]
    if "error" in found:
        return found["error"]
    bias = found["relativeBias"] and found["relativeBias"][1]
    mean = "" if bias is None else f", mean {bias:+.1e}".replace("-", "−")
    apart = [f"{found[key]:,} {word}" for key, word in
             (("otherBranch", "on another branch"), ("rounding", "by rounding"), ("unexplained", "unexplained")) if found[key]]
    inside = f"{found['withinTolerance']:,} of {plural(found['litPixels'], 'pixel')} alike"
    return f"against the CPU: {', '.join([inside, *apart])}{mean}"


def unsupported(entry):
    """Names of what the file asks for and does not get."""
    found = [re.search(r"(\w+) is not supported", line) for line in entry["warnings"] + entry["errors"]]
    return sorted({match[1] for match in found if match})


def fault_text(entry):
    faults = {name: count for name, count in (entry["diagnostics"] or {}).items() if count}
    return ", ".join(f"{name} {count}" for name, count in faults.items())


def caption_lines(entry):
    if entry["renderSeconds"] is None:
        yield "warn" if entry["refused"] else "bad", (entry["errors"] or ["no image"])[0]
        return
    if entry["black"]:
        yield "bad", "black: no light reaches the camera"
    error = "" if entry["relativeRmse"] is None else f", estimated relative RMSE {percent(entry['relativeRmse'])}"
    yield "", f"{entry['samplesPerPixel']} samples a pixel, {entry['renderSeconds']:.2f}{NO_BREAK}s{error}"
    if entry["comparison"]:
        yield "bad" if is_marked(entry) else "", reference_text(entry)
    if entry["verification"]:
        yield "bad" if has_failed_verification(entry) else "", verification_text(entry)
    if fault_text(entry):
        yield "bad", "faults: " + fault_text(entry)
    if unsupported(entry):
        yield "warn", "not supported: " + ", ".join(unsupported(entry))


def tags(entry):
    """What the kernels needed for the scene; why, on hovering."""
    used = [(name, use["reason"]) for name, use in (entry["features"] or {}).items() if use["used"]]
    return "".join(f'<span title="{text(reason)}">{text(name)}</span>' for name, reason in used)


def warning_list(entry):
    if not entry["warnings"]:
        return ""
    lines = "".join(f"<li>{text(line)}</li>" for line in entry["warnings"])
    return f"<details><summary>{plural(len(entry['warnings']), 'warning')}</summary><ul>{lines}</ul></details>"


def figure(entry, pictures):
    image, reference = pictures
    missing = "not supported" if entry["refused"] else "failed"
    instead = missing if entry["renderSeconds"] is None else "black" if entry["black"] else ""
    shown = picture(image, entry["name"], "isolux" if reference else "", instead)
    if reference:
        shown += picture(reference, entry["name"] + ", reference", "reference", "")
    lines = "".join(f'<span class="{kind}">{text(line)}</span>' for kind, line in caption_lines(entry))
    features = tags(entry)
    features = features and f"<div class=tags>{features}</div>"
    return (f"<figure><div class=pair>{shown}</div><figcaption><b>{text(entry['name'])}</b>{lines}{features}"
            f"{warning_list(entry)}</figcaption></figure>")


def size_text(entry):
    spheres = f" + {entry['spheres']} sphere{'s' if entry['spheres'] > 1 else ''}" if entry["spheres"] else ""
    return number(entry["triangles"], ",") + spheres


def marked(words, is_bad):
    return f'<span class="bad">{text(words)}</span>' if is_bad else text(words)


def verified_share(entry):
    found = entry["verification"]
    if not found or not found.get("litPixels"):
        return "–"
    return percent(found["withinTolerance"] / found["litPixels"])


def row(entry):
    black = "<br><span class=bad>black</span>" if entry["black"] else ""
    compared = entry["comparison"] or {}
    cells = [text(entry["name"]) + black, size_text(entry), number(entry["startUpSeconds"], ".3f"),
             number(entry["renderSeconds"], ".2f"), number(entry["samplesPerPixel"], "d"), percent(entry["relativeRmse"]),
             percent(compared.get("relativeRmse")), marked(bias_text(entry), is_marked(entry)),
             marked(verified_share(entry), has_failed_verification(entry)), text(", ".join(unsupported(entry)) or "–")]
    return "<tr>" + "".join(f"<td>{cell}</td>" for cell in cells) + "</tr>"


HEADINGS = ["scene", "triangles", "start-up, s", "render, s", "samples", "est. rel. RMSE", "rel. RMSE to reference",
            "relative bias [95 %]", "pixels as on the CPU", "not supported"]


def summary(entries):
    refused = sum(entry["refused"] for entry in entries)
    failed = sum(1 for entry in entries if entry["renderSeconds"] is None) - refused
    counts = [(len(entries), "scenes"), (sum(1 for e in entries if e["comparison"]), "with a reference"),
              (sum(map(is_marked, entries)), "more than 1 % from it"),
              (sum(map(has_failed_verification, entries)), "with pixels that differ from the CPU's, unexplained"),
              (sum(e["black"] for e in entries), "black"), (refused, "that require what is not supported"), (failed, "failed")]
    return ", ".join(f"{count} {what}" for count, what in counts if count or what == "scenes")


def device_line(entries):
    devices = {f"{e['device']['name']}, {e['device']['driver']} {e['device']['driverVersion']}" for e in entries if e["device"]}
    return "; ".join(sorted(devices))


def sheets(entries, pictures):
    """A sheet of figures for each folder."""
    parts = []
    for folder, group in itertools.groupby(entries, lambda entry: entry["folder"]):
        group = list(group)
        pairs = " pairs" if any(pictures[entry["name"]][1] for entry in group) else ""
        figures = "".join(figure(entry, pictures[entry["name"]]) for entry in group)
        parts.append(f'<h2>{text(folder)}</h2><div class="sheet{pairs}">{figures}</div>')
    return "".join(parts)


def page(title, entries, pictures):
    """The whole page. `pictures`: name -> the image's and the reference's PNG, or None."""
    table = "".join(map(row, entries))
    heads = "".join(f"<th>{heading}</th>" for heading in HEADINGS)
    return f"""<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<title>Isolux: {text(title)}</title><style>{STYLE}</style></head><body>
<h1>Isolux: {text(title)}</h1>
<p>{text(summary(entries))}</p><p>{text(device_line(entries))}</p>
{sheets(entries, pictures)}
<h2>Figures</h2>
<p>The bias is that of the mean luminance against the reference, marked where its whole 95 % interval lies beyond 1 %. Pixels
as on the CPU: of those lit, on the same random numbers, within the tolerance of rounding.</p>
<div class=scroll><table><thead><tr>{heads}</tr></thead><tbody>{table}</tbody></table></div>
</body></html>
"""
