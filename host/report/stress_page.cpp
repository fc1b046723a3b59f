// What stress.h holds as a page that needs no other file: charts of deviation against stiffness, and tables.
#include "report/format.h"
#include "report/stress.h"
#include "report/stress_chart.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace isolux {
namespace {

constexpr const char* kStyle = R"(
:root{color-scheme:light dark;--ink:#1c2430;--soft:#5d6b7c;--line:#d6dde5;--page:#fbfcfd;--card:#fff;
 --s0:#0b62c4;--s1:#c2570c;--s2:#6a7787;--s3:#8a3ab9;--s4:#0d8a5f;--bad:#c01f2e;--good:#0d7a4a}
@media (prefers-color-scheme:dark){:root{--ink:#e6ebf1;--soft:#9aa7b6;--line:#303a46;--page:#11161c;--card:#181f27;
 --s0:#6bb1ff;--s1:#ffa45c;--s2:#9aa7b6;--s3:#cf9bf0;--s4:#56d6a6;--bad:#ff7b86;--good:#5fd79e}}
*{box-sizing:border-box}body{margin:0;background:var(--page);color:var(--ink);font:16px/1.5 system-ui,sans-serif}
main{max-width:80rem;margin:0 auto;padding:1rem}p,section.sweep{max-width:60rem}h1{font-size:1.6rem}h2{margin:2.5rem 0 .5rem;font-size:1.25rem}
h3{margin:0;font-size:1rem}p{margin:.4rem 0}.soft{color:var(--soft);font-size:.9rem}
section.sweep{background:var(--card);border:1px solid var(--line);border-radius:.6rem;padding:1rem;margin:1rem 0}
.scroll{overflow-x:auto}table{border-collapse:collapse;font-size:.85rem;width:100%}
th,td{text-align:left;padding:.25rem .6rem;border-bottom:1px solid var(--line);white-space:nowrap}
td.wrap{white-space:normal;min-width:12rem}svg{width:100%;height:auto;display:block}svg text{fill:var(--soft);font-size:12px}
.bad{color:var(--bad);font-weight:600}.good{color:var(--good)}summary{cursor:pointer;color:var(--soft);font-size:.9rem}
.key{display:inline-block;width:.8em;height:.8em;border-radius:50%;margin:0 .35em 0 .9em}
.s0{color:var(--s0)}.s1{color:var(--s1)}.s2{color:var(--s2)}.s3{color:var(--s3)}.s4{color:var(--s4)}
)";

/// All renderers of a run, the usual ones first.
std::vector<std::string> renderersOf(const StressRun& run) {
    std::vector<std::string> found{kStressDevice, kStressSingle, kStressDouble};
    for (const StressFamily& family : run.families)
        for (const StressSweep& sweep : family.sweeps)
            for (const StressStep& step : sweep.steps)
                for (const StressFigures& figures : step.figures)
                    if (std::ranges::find(found, figures.renderer) == found.end()) found.push_back(figures.renderer);
    return found;
}

std::string rangeCell(const StressSweep& sweep, const std::string& renderer) {
    const StressRange range = rangeOf(sweep, renderer, criterionFor(renderer));
    if (range.steps == 0) return "<td></td>";
    const bool whole = range.within == range.steps;
    std::string text = range.within == 0 ? "nowhere"
                       : whole           ? "everywhere"
                                         : fmt::format("{} … {}", range.first, range.last);
    if (criterionFor(renderer) == StressCriterion::notBrokenDown) text += ", to 1 %";
    if (!range.broken.empty()) text += fmt::format(" (beyond 1 %: {})", fmt::join(range.broken, ", "));
    return fmt::format("<td class=\"{}\">{}</td>", whole ? "good" : "bad", escapedHtml(text));
}

std::string summaryTable(const StressRun& run, const std::vector<std::string>& renderers) {
    std::string text = "<div class=scroll><table><thead><tr><th>family</th><th>sweep</th><th>steps</th>";
    for (const std::string& renderer : renderers)
        if (renderer != kStressDouble) text += fmt::format("<th>{}</th>", escapedHtml(renderer));
    text += "<th>faults on the device</th></tr></thead><tbody>";
    for (const StressFamily& family : run.families)
        for (const StressSweep& sweep : family.sweeps) {
            const bool first = &sweep == &family.sweeps.front();
            const StressFaults faults = totalFaults({"", "", {sweep}}, kStressDevice);
            text +=
                fmt::format("<tr><td>{}</td><td>{}</td><td>{} … {}</td>",
                            first ? fmt::format("<a href=\"#{0}\">{0}</a>", family.name) : "", escapedHtml(sweep.name),
                            escapedHtml(sweep.steps.front().label), escapedHtml(sweep.steps.back().label));
            for (const std::string& renderer : renderers)
                if (renderer != kStressDouble) text += rangeCell(sweep, renderer);
            text += fmt::format("<td class=\"{}\">{}</td></tr>", faults.clean() ? "good" : "bad",
                                escapedHtml(formatFaults(faults)));
        }
    return text + "</tbody></table></div>";
}

std::string figureCell(const StressFigures& figures) {
    if (!figures.failure.empty()) return fmt::format("<td class=\"bad wrap\">{}</td>", escapedHtml(figures.failure));
    if (std::isnan(figures.deviation().estimate)) return "<td></td>";
    const bool beyond = verdictOf(figures.deviation(), kStressTolerance) == StressVerdict::beyond;
    return fmt::format("<td{}>{}</td>", beyond ? " class=bad" : "", formatPercentInterval(figures.deviation()));
}

std::string stepTable(const StressSweep& sweep, const std::vector<std::string>& renderers) {
    std::string text =
        fmt::format("<details><summary>figures of every step</summary><div class=scroll><table><tr><th>{}</th>",
                    escapedHtml(sweep.axisTitle));
    for (const std::string& renderer : renderers) text += fmt::format("<th>{}</th>", escapedHtml(renderer));
    text += "<th>faults on the device</th><th>promised</th><th>seconds</th></tr>";
    for (const StressStep& step : sweep.steps) {
        text += fmt::format("<tr><td>{}</td>", escapedHtml(step.label));
        double seconds = 0.0;
        for (const std::string& renderer : renderers) {
            const StressFigures* figures = step.of(renderer);
            text += figures == nullptr ? "<td></td>" : figureCell(*figures);
            if (figures != nullptr) seconds += figures->seconds;
        }
        const StressFigures* device = step.of(kStressDevice);
        text += fmt::format("<td>{}</td><td>{}</td><td>{:.2f}</td></tr>",
                            device == nullptr ? "" : escapedHtml(formatFaults(device->faults)),
                            isPromised(sweep, step) ? "yes" : "", seconds);
    }
    return text + "</table></div></details>";
}

/// Those that have figures in this sweep.
std::vector<std::string> presentIn(const StressSweep& sweep, const std::vector<std::string>& renderers) {
    std::vector<std::string> present;
    for (const std::string& renderer : renderers)
        if (std::ranges::any_of(sweep.steps, [&](const StressStep& step) { return step.of(renderer) != nullptr; }))
            present.push_back(renderer);
    return present;
}

std::string sweepSection(const StressSweep& sweep, const std::vector<std::string>& renderers) {
    return fmt::format("<section class=sweep><h3>{}: {}</h3>{}<p class=soft>{}</p>{}</section>",
                       escapedHtml(sweep.name), escapedHtml(sweep.title), stressChart(sweep, renderers),
                       escapedHtml(sweep.limit), stepTable(sweep, presentIn(sweep, renderers)));
}

std::string legend(const std::vector<std::string>& renderers) {
    std::string text = "<p>";
    for (std::size_t i = 0; i < renderers.size(); ++i)
        text += fmt::format("<span class=key style=\"background:var(--s{})\"></span>{}", std::min<std::size_t>(i, 4),
                            escapedHtml(renderers[i]));
    return text + "</p>";
}

std::string verdictParagraph(const StressRun& run) {
    const std::vector<std::string> broken = brokenPromises(run.families);
    std::string text = fmt::format("<p class={}>{}.</p><ul>", broken.empty() ? "good" : "bad",
                                   escapedHtml(toText(summarize(run.families))));
    for (const std::string& line : broken) text += fmt::format("<li>{}</li>", escapedHtml(line));
    return text + "</ul>";
}

constexpr const char* kExplanation =
    "Every step is rendered with the same random numbers on the device, by the CPU reference in single precision and "
    "by it in double, so "
    "that a bias of 0.1 % is seen with few samples. Charts show the deviation of the image's mean: from the double "
    "reference or, of double "
    "itself and of others, from the answer in closed form. It holds at a step if its 95 % interval lies within ± 0.1 % "
    "(dashed; dotted: 1 %). "
    "Single precision is what a renderer gets that works in the scene's own coordinates. Every sweep promises the "
    "device "
    "to be right over a "
    "range, derived from the rounding errors it names; steps beyond show what happens there.";

} // namespace

std::string toHtml(const StressRun& run) {
    const std::vector<std::string> renderers = renderersOf(run);
    std::string page = fmt::format(
        "<!doctype html>\n<html lang=en><head><meta charset=utf-8><meta name=viewport content=\"width=device-width,"
        "initial-scale=1\"><title>Isolux under stress</title><style>{}</style></head><body><main><h1>Isolux under "
        "stress</h1><p class=soft>{} · {} · {}{} · {:.0f} s</p>",
        kStyle, escapedHtml(run.version), escapedHtml(run.device), escapedHtml(run.driver),
        run.quick ? " · short version" : "", run.seconds);
    page += verdictParagraph(run) + fmt::format("<p>{}</p>", kExplanation) + legend(renderers);
    page += "<h2>How far within 0.1 %</h2>" + summaryTable(run, renderers);
    for (const StressFamily& family : run.families) {
        page += fmt::format("<h2 id=\"{}\">{}</h2>", family.name, escapedHtml(family.title));
        for (const StressSweep& sweep : family.sweeps) page += sweepSection(sweep, renderers);
    }
    return page + "</main></body></html>\n";
}

} // namespace isolux
