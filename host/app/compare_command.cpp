// `isolux compare`: an image against a reference, with limits that a test can rely on and a map of where they differ.
#include "app/commands.h"
#include "app/validators.h"
#include "film/image.h"
#include "report/comparison.h"
#include "report/format.h"
#include "report/heatmap.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <map>
#include <memory>

namespace isolux {
namespace {

namespace fs = std::filesystem;

enum class FlipMode { automatic, low, high, none };

const std::map<std::string, FlipMode> kFlipModes{
    {"auto", FlipMode::automatic}, {"ldr", FlipMode::low}, {"hdr", FlipMode::high}, {"none", FlipMode::none}};

const std::map<std::string, HeatmapQuantity> kHeatmapQuantities{{"flip", HeatmapQuantity::flip},
                                                                {"relmse", HeatmapQuantity::relMse},
                                                                {"bias", HeatmapQuantity::bias},
                                                                {"blocks", HeatmapQuantity::blocks}};

struct CompareCommand {
    std::string image;
    std::string reference;
    ComparisonLimits limits;
    std::string flip = "auto";
    double pixelsPerDegree = kPixelsPerDegree;
    std::string heatmap;
    std::string heatmapOf = "flip";
    bool checkBlocks = false;
    bool json = false;
};

/// Whether files of this name hold integers, which are display colours and not radiance. TIFF may hold either.
bool holdsIntegers(const fs::path& path) {
    constexpr std::array<std::string_view, 9> kExtensions{".png", ".jpg", ".jpeg", ".bmp", ".tga",
                                                          ".gif", ".ppm", ".webp", ".jp2"};
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end();
}

std::optional<FlipOptions> flipOptions(const CompareCommand& command) {
    const FlipMode mode = kFlipModes.at(command.flip);
    if (mode == FlipMode::none) return std::nullopt;
    const bool low = mode == FlipMode::low ||
                     (mode == FlipMode::automatic && holdsIntegers(command.image) && holdsIntegers(command.reference));
    return FlipOptions{low ? DynamicRange::low : DynamicRange::high, command.pixelsPerDegree};
}

/// Throws Error (bad input) if the heatmap cannot be written, before anything is read.
void checkHeatmap(const CompareCommand& command) {
    checkImagePath(command.heatmap);
    for (const std::string& input : {command.image, command.reference}) {
        std::error_code ignored;
        if (fs::equivalent(command.heatmap, input, ignored))
            throwBadInput(command.heatmap, "the heatmap would replace an image that is compared");
    }
    if (kHeatmapQuantities.at(command.heatmapOf) == HeatmapQuantity::flip && command.flip == "none")
        throwBadInput("--heatmap-of flip", "needs FLIP: leave out --flip none, or choose another quantity");
}

ExitCode run(const CompareCommand& command) {
    if (!command.heatmap.empty()) checkHeatmap(command);
    const Image image = readImage(command.image);
    const Image reference = readImage(command.reference);
    ComparisonLimits limits = command.limits;
    limits.blocks = command.checkBlocks ? BlockCheck::enforced : BlockCheck::reported;
    ComparisonReport report = compareImages(image, reference, limits, flipOptions(command));
    if (!command.heatmap.empty()) {
        const Heatmap heatmap = makeHeatmap(kHeatmapQuantities.at(command.heatmapOf), image, reference, report);
        writeImage(command.heatmap, heatmap.image);
        report.heatmap = heatmap.range;
        report.heatmap->file = command.heatmap;
    }
    fmt::print("{}", command.json ? jsonText(toJson(report)) : toText(report));
    return report.verdict() == Verdict::within ? ExitCode::success : ExitCode::failure;
}

void addLimits(CLI::App& sub, CompareCommand& command) {
    sub.add_option("--max-relative-bias", command.limits.maxRelativeBias,
                   "Largest relative difference of the means, as a fraction")
        ->check(nonNegativeNumber());
    sub.add_option("--max-rel-mse", command.limits.maxRelMse, "Largest relative mean squared error")
        ->check(nonNegativeNumber());
    sub.add_option("--max-flip", command.limits.maxFlip, "Largest mean FLIP, from 0 to 1")->check(nonNegativeNumber());
    sub.add_flag("--check-blocks", command.checkBlocks,
                 "Fail if a block of 16 x 16 pixels or the mean differs by more than noise explains (1 % over all)");
}

void addFlip(CLI::App& sub, CompareCommand& command) {
    sub.add_option("--flip", command.flip,
                   "FLIP of display colours (ldr) or of radiance (hdr); auto: ldr if both files hold integers; none is "
                   "faster on large images")
        ->check(CLI::IsMember(&kFlipModes))
        ->capture_default_str();
    sub.add_option("--pixels-per-degree", command.pixelsPerDegree,
                   "For FLIP: of visual angle; by default a display of 3840 pixels and 0.7 m, seen from 0.7 m")
        ->check(finiteNumber())
        ->check(CLI::Range(1.0, 1000.0))
        ->capture_default_str();
}

} // namespace

void addCompareCommand(CLI::App& app, ExitCode& result) {
    CLI::App* sub = app.add_subcommand("compare", "Measure how an image differs from a reference");
    auto command = std::make_shared<CompareCommand>();
    sub->add_option("IMAGE", command->image, "The image to judge")->required();
    sub->add_option("REFERENCE", command->reference, "What it is held against")->required();
    sub->add_flag("--json", command->json, "Print JSON");
    addLimits(*sub, *command);
    addFlip(*sub, *command);
    sub->add_option("--heatmap", command->heatmap, "Write where they differ in false colour: .png, .exr or .hdr");
    sub->add_option("--heatmap-of", command->heatmapOf,
                    "What it shows: FLIP, relMSE (both dark to bright), the signed relative difference of luminance "
                    "or the z values of blocks (both blue, white, red)")
        ->check(CLI::IsMember(&kHeatmapQuantities))
        ->capture_default_str();
    sub->footer(
        "A limit is exceeded only if the whole 95 % interval lies beyond it. FLIP has no interval: the noise of\n"
        "both images counts, so compare with a clean reference.\n"
        "Exit codes: 0 within the limits, 1 beyond one, 2 unreadable or of different size.\n"
        "Examples:\n"
        "  isolux compare image.exr reference.exr\n"
        "  isolux compare image.exr reference.exr --max-relative-bias 0.005 --max-rel-mse 0.01\n"
        "  isolux compare image.exr reference.exr --check-blocks --heatmap z.png --heatmap-of blocks\n"
        "  isolux compare image.exr reference.exr --heatmap bias.png --heatmap-of bias\n"
        "  isolux compare image.png reference.png --max-flip 0.05 --heatmap flip.png\n"
        "  isolux compare image.exr reference.exr --flip hdr --pixels-per-degree 40 --json");
    sub->callback([command, &result] { result = run(*command); });
}

} // namespace isolux
