// Cameras: their field of view or magnification; near and far planes do not clip.
#include "load/verify_parts.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace isolux {
namespace {

using nlohmann::json;

enum class Near { positive, nonNegative };

/// glTF 2.0, 5.12 and 5.13: a perspective camera's znear is positive, an orthographic one's may be 0.
void warnOfPlanes(const JsonReader& projection, Near allowed) {
    constexpr double kHuge = std::numeric_limits<double>::max();
    const double znear = projection.find("znear") ? projection.at("znear").number() : -1.0;
    const double zfar = projection.find("zfar") ? projection.at("zfar").number() : kHuge;
    const bool isValid = (allowed == Near::positive ? znear > 0.0 : znear >= 0.0) && zfar > znear;
    if (!isValid) projection.warn("znear or zfar is missing or invalid; neither clips, so both are ignored");
}

json verifyPerspective(const JsonReader& perspective) {
    const JsonReader yfov = perspective.at("yfov");
    if (!(yfov.number() > 0.0 && yfov.number() < std::numbers::pi))
        yfov.fail(fmt::format("is {} but must be an angle in radians between 0 and pi", yfov.number()));
    json result{{"yfov", yfov.number()}, {"znear", 1.0}};
    warnOfPlanes(perspective, Near::positive);
    if (const std::optional<JsonReader> aspect = perspective.find("aspectRatio")) {
        if (aspect->number() > 0.0)
            result["aspectRatio"] = aspect->number();
        else
            aspect->warn("is not positive; ignored");
    }
    return result;
}

/// Half the width or height of what an orthographic camera sees. glTF forbids zero and discourages negative values.
double verifyMagnification(const JsonReader& magnification) {
    constexpr double kLargest = 1e18; // as far as scenes may reach
    const double value = magnification.number();
    if (!(std::abs(value) >= 1.0 / kLargest && std::abs(value) <= kLargest))
        magnification.fail(fmt::format("is {} but must lie between {:g} and {:g}", value, 1.0 / kLargest, kLargest));
    if (value < 0.0) magnification.warn("is negative, which would mirror the image; rendered unmirrored");
    return std::abs(value);
}

json verifyOrthographic(const JsonReader& orthographic) {
    json result{{"xmag", verifyMagnification(orthographic.at("xmag"))},
                {"ymag", verifyMagnification(orthographic.at("ymag"))},
                {"znear", 0.0},
                {"zfar", 1.0}};
    warnOfPlanes(orthographic, Near::nonNegative);
    return result;
}

} // namespace

json verifyCamera(const JsonReader& camera, const JsonReader&) {
    json result{{"type", camera.at("type").string()}};
    copyName(camera, result);
    if (result["type"] == "perspective")
        result["perspective"] = verifyPerspective(camera.at("perspective"));
    else if (result["type"] == "orthographic")
        result["orthographic"] = verifyOrthographic(camera.at("orthographic"));
    else
        camera.at("type").fail("must be perspective or orthographic");
    return result;
}

} // namespace isolux
