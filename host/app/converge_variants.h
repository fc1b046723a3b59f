// The variants of `converge`: ways to render the same image, each with a name and options as of `render`.
#pragma once

#include "app/backends.h"
#include "app/stopping_options.h"

#include <string>
#include <vector>

namespace isolux {

struct Variant {
    std::string name;
    std::string options; ///< as given
    RenderSettings settings;
    StoppingRule stopping;
};

/// What holds for every variant: the options that stand beside `--variant`.
struct CommonMethods {
    MethodOptions methods;
    StoppingOptions stopping;
};

/// Reads "NAME:OPTIONS" or "NAME"; without any there is one variant, "default", of the common methods. Throws Error
/// (bad input) that names the variant: for options that `render` would not take either, a time limit, and options that
/// change what the image converges to.
[[nodiscard]] std::vector<Variant> parseVariants(const std::vector<std::string>& texts, const CommonMethods& common,
                                                 const SceneRun& run);

/// Settings that converge to the same image by the usual methods.
[[nodiscard]] RenderSettings referenceSettings(const RenderSettings& settings);

} // namespace isolux
