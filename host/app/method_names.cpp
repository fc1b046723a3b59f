#include "app/method_names.h"

#include "core/error.h"
#include "scene/pixel_filter.h"

#include <fmt/format.h>

#include <charconv>
#include <string_view>
#include <type_traits>

namespace isolux {
namespace {

constexpr double kLeastTermination = 0.001;
constexpr double kMostTermination = 0.999;

template <typename Value> std::string valueText(const Value& value) {
    if constexpr (std::is_enum_v<Value>)
        return choiceName(value);
    else
        return fmt::format("{}", value);
}

/// Collects values that are not the usual ones.
class MethodList {
public:
    template <typename Value> void note(const char* option, const Value& value, const Value& usual) {
        if (value != usual) methods_.push_back({option, valueText(value)});
    }
    [[nodiscard]] std::vector<MethodChoice> take() { return std::move(methods_); }

private:
    std::vector<MethodChoice> methods_;
};

void noteLightTransport(MethodList& list, const RenderSettings& settings, const RenderSettings& usual) {
    list.note("integrator", settings.integrator, usual.integrator);
    list.note("ao-distance", settings.ambientDistance, usual.ambientDistance);
    list.note("light-sampling", settings.lightSampling, usual.lightSampling);
    list.note("mis-heuristic", settings.misHeuristic, usual.misHeuristic);
    list.note("light-samples", settings.lightSamples, usual.lightSamples);
    list.note("light-choice", settings.lightChoice, usual.lightChoice);
    list.note("bounces", settings.bounces, usual.bounces);
    list.note("light", settings.light, usual.light);
    list.note("roulette", rouletteName(settings.roulette), rouletteName(usual.roulette));
    list.note("roulette-start", settings.roulette.start, usual.roulette.start);
}

void noteCamera(MethodList& list, const RenderSettings& settings) {
    if (settings.lens.isPinhole()) return;
    list.note("aperture", settings.lens.aperture, 0.0);
    list.note("focus", settings.lens.focus, 0.0);
}

} // namespace

std::string rouletteName(const RouletteSettings& roulette) {
    if (roulette.kind == Roulette::off) return "off";
    return roulette.kind == Roulette::constant ? fmt::format("constant:{}", roulette.termination) : "throughput";
}

RouletteSettings parseRoulette(const std::string& text) {
    constexpr std::string_view kConstant = "constant:";
    RouletteSettings roulette;
    if (text == "throughput") return roulette;
    roulette.kind = text == "off" ? Roulette::off : Roulette::constant;
    if (text == "off") return roulette;
    const char* const end = text.data() + text.size();
    const bool constant = text.starts_with(kConstant);
    const auto [stop, error] =
        std::from_chars(constant ? text.data() + kConstant.size() : end, end, roulette.termination);
    const double p = roulette.termination;
    // Not by comparing with what lies outside: NaN must be refused as well.
    const bool inRange = p >= kLeastTermination && p <= kMostTermination;
    if (constant && error == std::errc{} && stop == end && inRange) return roulette;
    throwBadInput("--roulette", fmt::format("'{}' is not off, throughput or constant:P with P, the probability of "
                                            "ending, from {} to {}",
                                            text, kLeastTermination, kMostTermination));
}

std::vector<MethodChoice> methodsOf(const RenderSettings& settings) {
    const RenderSettings usual;
    MethodList list;
    noteLightTransport(list, settings, usual);
    list.note("pixel-sampler", settings.sampler, usual.sampler);
    list.note("pixel-filter", settings.filter.kind, usual.filter.kind);
    list.note("filter-radius", settings.filter.radius, defaultRadius(settings.filter.kind));
    noteCamera(list, settings);
    list.note("back-faces", settings.backFaces, usual.backFaces);
    list.note("accel", settings.intersection.acceleration, usual.intersection.acceleration);
    list.note("leaf-size", settings.intersection.maxLeafSize, usual.intersection.maxLeafSize);
    list.note("triangle-test", settings.intersection.triangleTest, usual.intersection.triangleTest);
    return list.take();
}

} // namespace isolux
