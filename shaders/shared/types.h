// Lets one header serve both languages: GLSL's type names in C++, with GLM's types of the same size.
#ifndef ISOLUX_SHARED_TYPES_H
#define ISOLUX_SHARED_TYPES_H

#ifdef __cplusplus
#include <cstdint>
#include <glm/vec4.hpp>
namespace isolux::shared {
using uint = std::uint32_t;
using vec4 = glm::vec4;
using uvec4 = glm::uvec4;
} // namespace isolux::shared
#define ISOLUX_SHARED_BEGIN namespace isolux::shared {
#define ISOLUX_SHARED_END }
#define ISOLUX_CONSTANT inline constexpr
#define ISOLUX_CHECK_SIZE(type, bytes) static_assert(sizeof(type) == (bytes) && (bytes) % 16 == 0)
#else
#define ISOLUX_SHARED_BEGIN
#define ISOLUX_SHARED_END
#define ISOLUX_CONSTANT const
#define ISOLUX_CHECK_SIZE(type, bytes)
#endif

#endif
