// The two references of `converge`: given as files, kept from an earlier run, or rendered.
#pragma once

#include "app/converge_variants.h"
#include "app/reference_cache.h"
#include "app/seed_renderer.h"
#include "report/error_meter.h"

#include <optional>
#include <string>
#include <vector>

namespace isolux {

struct References {
    std::vector<std::string> files; ///< that were read or kept
    std::string method;             ///< "two independent", or "variance subtracted" where there is one
    std::optional<ErrorMeter> meter;
};

/// One or two images from files. Throws Error (bad input).
[[nodiscard]] References readReferences(const std::vector<std::string>& files, const SceneRun& run);

struct ReferenceRequest {
    RenderSettings settings; ///< referenceSettings of the variants
    std::uint32_t samples = 0;
    const Device* device = nullptr; ///< null: the processor renders
    double dispatchSeconds = 0.0;
    ProgressDisplay display = ProgressDisplay::shown;
};

/// Two independent images from `cache`, or else rendered and put there. No meter if that was interrupted.
[[nodiscard]] References renderReferences(const SceneRun& run, const ReferenceRequest& request,
                                          const ReferenceCache& cache);

/// Seeds from here on are those of references.
inline constexpr std::uint64_t kFirstReferenceSeed = std::uint64_t{1} << 63;

} // namespace isolux
