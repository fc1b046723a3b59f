// Folding a kernel's specialisation constants before a driver sees it, once for each set of values.
#pragma once

#include "gpu/pipeline_cache.h"

#include <cstdint>
#include <span>
#include <vector>

namespace isolux {

/// The module with these values for its specialisation constants (those it has not are ignored), and without the code
/// that they make unreachable. Drivers could do this themselves, but some optimise the whole module first, dead code
/// included: SwiftShader takes minutes and gigabytes for a kernel of 20,000 instructions of which 3,000 remain.
/// Throws Error if SPIRV-Tools refuses the module.
[[nodiscard]] std::vector<std::uint32_t> specialize(std::span<const std::uint32_t> spirv,
                                                    const Specialization& constants);

/// Which file keeps what `specialize` makes of a module. It belongs to no driver; other passes or another SPIRV-Tools
/// make another key.
[[nodiscard]] PipelineKey specializedKey(std::span<const std::uint32_t> spirv, const Specialization& constants);

/// The same, kept in a folder from one run to the next.
[[nodiscard]] std::vector<std::uint32_t> specialize(std::span<const std::uint32_t> spirv,
                                                    const Specialization& constants, const PipelineFolder& folder);

} // namespace isolux
