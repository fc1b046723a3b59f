// Triangles from the vertices of a primitive: lists, strips and fans.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace isolux {

/// Whether a mode of glTF describes triangles, rather than points or lines.
[[nodiscard]] bool isTriangleMode(int mode);

/// How many of `indexCount` indices make triangles in this mode, and how many triangles these are at most.
[[nodiscard]] std::size_t usedIndices(int mode, std::size_t indexCount);
[[nodiscard]] std::size_t mostTriangles(int mode, std::size_t indexCount);

/// The triangles of a primitive, wound as glTF 2.0, 3.7.2.1 has it. Those of a strip or fan that repeat an index are
/// left out: they have no area in any shape, and stand there to join strips. Lists stay as they are.
[[nodiscard]] std::vector<std::array<std::uint32_t, 3>> assembleTriangles(int mode,
                                                                          std::span<const std::uint32_t> indices);

} // namespace isolux
