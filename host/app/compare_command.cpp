// `isolux compare`: an image against a reference, with limits that a test can rely on.
#include "app/commands.h"
#include "film/image.h"
#include "report/comparison.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>

namespace isolux {
namespace {

struct CompareCommand {
    std::string image;
    std::string reference;
    ComparisonLimits limits;
    bool json = false;
};

ExitCode run(const CompareCommand& command) {
    const ComparisonReport report =
        compareImages(readImage(command.image), readImage(command.reference), command.limits);
    fmt::print("{}", command.json ? toJson(report).dump(2) + "\n" : toText(report));
    return report.verdict() == Verdict::within ? ExitCode::success : ExitCode::failure;
}

} // namespace

void addCompareCommand(CLI::App& app, ExitCode& result) {
    CLI::App* sub = app.add_subcommand("compare", "Measure how an image differs from a reference");
    auto command = std::make_shared<CompareCommand>();
    sub->add_option("IMAGE", command->image, "The image to judge")->required();
    sub->add_option("REFERENCE", command->reference, "What it is held against")->required();
    sub->add_flag("--json", command->json, "Print JSON");
    sub->add_option("--max-relative-bias", command->limits.maxRelativeBias,
                    "Largest relative difference of the means, as a fraction")
        ->check(CLI::NonNegativeNumber);
    sub->add_option("--max-rel-mse", command->limits.maxRelMse, "Largest relative mean squared error")
        ->check(CLI::NonNegativeNumber);
    sub->footer("A limit is exceeded only if the whole 95 % interval lies beyond it.\n"
                "Exit codes: 0 within the limits, 1 beyond one, 2 unreadable or of different size.\n"
                "Examples:\n"
                "  isolux compare image.exr reference.exr\n"
                "  isolux compare image.exr reference.exr --max-relative-bias 0.005 --max-rel-mse 0.01");
    sub->callback([command, &result] { result = run(*command); });
}

} // namespace isolux
