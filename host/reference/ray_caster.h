// Nearest hit and visibility of a ray in the whole world, through the BVH or by asking every primitive.
#pragma once

#include "accel/bvh.h"
#include "reference/intersect.h"
#include "reference/options.h"

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace isolux {

inline constexpr std::uint32_t kNoPrimitive = 0xFFFFFFFFu;

template <typename Real> struct Hit {
    Real t = 0;
    std::uint32_t primitive = kNoPrimitive;
    Vec3<Real> barycentric{0}; ///< of a triangle

    [[nodiscard]] Place<Real> place() const { return {primitive, barycentric}; }
};

enum class Visibility { clear, blocked };

/// What searches cost.
struct TraversalTests {
    std::uint64_t boxes = 0; ///< of nodes
    std::uint64_t primitives = 0;

    void merge(const TraversalTests& other) {
        boxes += other.boxes;
        primitives += other.primitives;
    }
};

/// Keeps a reference to the world. Every acceleration gives the same answers bit by bit: a hit's distance is clamped to
/// the part of the ray in its primitive's box, so no node that holds it is ever passed over, and of hits at equal
/// distance the lowest primitive id wins. Every search adds its tests to `tests`.
template <typename Real> class RayCaster {
public:
    explicit RayCaster(const World<Real>& world, const IntersectionMethod& method = {})
        : world_(world), method_(method) {
        if (method.acceleration == Acceleration::none) return;
        const bool byMean = method.acceleration == Acceleration::meanSplit;
        const SplitMethod split = byMean ? SplitMethod::mean : SplitMethod::surfaceArea;
        bvh_ = buildBvh(world.boxes, {.split = split, .maxLeafSize = method.maxLeafSize});
    }

    [[nodiscard]] std::optional<Hit<Real>> nearest(const Ray<Real>& ray) const {
        TraversalTests unused;
        return nearest(ray, unused);
    }
    [[nodiscard]] std::optional<Hit<Real>> nearest(const Ray<Real>& ray, TraversalTests& tests) const {
        return nearest(ray, tests, kEverything);
    }
    /// Among the hits for which `isThere` is true.
    template <typename IsThere>
    [[nodiscard]] std::optional<Hit<Real>> nearest(const Ray<Real>& ray, TraversalTests& tests,
                                                   const IsThere& isThere) const {
        const RayView<Real> view(ray);
        Hit<Real> best;
        best.t = ray.tMax;
        forEachCandidate(ray, tests, [&](std::uint32_t primitive) {
            ++tests.primitives;
            const std::optional<Hit<Real>> hit = intersect(ray, view, primitive);
            const bool nearer = hit && (hit->t < best.t || (hit->t == best.t && primitive < best.primitive));
            if (nearer && isThere(hit->place())) best = *hit;
            return best.t;
        });
        return best.primitive == kNoPrimitive ? std::nullopt : std::optional(best);
    }

    /// Whether anything but the primitive `ignored` lies before `ray.tMax`.
    [[nodiscard]] Visibility visibility(const Ray<Real>& ray, std::uint32_t ignored) const {
        TraversalTests unused;
        return visibility(ray, ignored, unused);
    }
    [[nodiscard]] Visibility visibility(const Ray<Real>& ray, std::uint32_t ignored, TraversalTests& tests) const {
        return visibility(ray, ignored, tests, kEverything);
    }
    /// Among the hits for which `isThere` is true.
    template <typename IsThere>
    [[nodiscard]] Visibility visibility(const Ray<Real>& ray, std::uint32_t ignored, TraversalTests& tests,
                                        const IsThere& isThere) const {
        const RayView<Real> view(ray);
        Visibility visibility = Visibility::clear;
        forEachCandidate(ray, tests, [&](std::uint32_t primitive) {
            if (primitive == ignored) return ray.tMax;
            ++tests.primitives;
            const std::optional<Hit<Real>> hit = intersect(ray, view, primitive);
            if (!hit || !isThere(hit->place())) return ray.tMax;
            visibility = Visibility::blocked;
            return kStop;
        });
        return visibility;
    }

private:
    struct Entry {
        std::uint32_t node;
        Real t; ///< where the ray enters the node
    };
    static constexpr Real kStop = -1;
    static constexpr auto kEverything = [](const Place<Real>&) { return true; };

    [[nodiscard]] std::optional<TriangleHit<Real>> intersectTriangle(const Ray<Real>& ray, const RayView<Real>& view,
                                                                     const WorldTriangle<Real>& triangle) const {
        const bool watertight = method_.triangleTest == TriangleTest::watertight;
        return watertight ? intersectWatertight(view, triangle) : intersectMollerTrumbore(ray, triangle);
    }

    /// A hit before `ray.tMax`.
    [[nodiscard]] std::optional<Hit<Real>> intersect(const Ray<Real>& ray, const RayView<Real>& view,
                                                     std::uint32_t primitive) const {
        Hit<Real> hit;
        hit.primitive = primitive;
        if (world_.isTriangle(primitive)) {
            const auto triangleHit = intersectTriangle(ray, view, world_.triangles[primitive]);
            if (!triangleHit) return std::nullopt;
            hit.t = triangleHit->t;
            hit.barycentric = triangleHit->barycentric;
        } else {
            const auto t = intersectSphere(ray, world_.sphere(primitive));
            if (!t) return std::nullopt;
            hit.t = *t;
        }
        const auto inBox = clipToBox(Ray<Real>{ray.origin, ray.direction}, world_.boxes[primitive]);
        if (!inBox) return std::nullopt;
        hit.t = std::clamp(hit.t, inBox->lower, inBox->upper);
        return hit.t < ray.tMax ? std::optional(hit) : std::nullopt;
    }

    /// Calls `visit` with primitives that the ray may hit. It returns the distance beyond which no hit matters any
    /// more, and `kStop` to end the search.
    template <typename Visit>
    void forEachCandidate(const Ray<Real>& ray, TraversalTests& tests, const Visit& visit) const {
        if (method_.acceleration != Acceleration::none) {
            tests.boxes += walkBvh(ray, visit);
            return;
        }
        for (std::uint32_t primitive = 0; primitive < world_.primitiveCount(); ++primitive)
            if (visit(primitive) == kStop) return;
    }

    /// The number of boxes tested.
    template <typename Visit> std::uint64_t walkBvh(const Ray<Real>& ray, const Visit& visit) const {
        if (bvh_.nodes.empty()) return 0;
        std::uint64_t boxes = 1;
        Real tMax = ray.tMax;
        std::vector<Entry> stack;
        stack.reserve(std::size_t{bvh_.depth} + 2);
        push(stack, ray, 0);
        while (!stack.empty() && tMax != kStop) {
            const Entry entry = stack.back();
            stack.pop_back();
            // A node entered at tMax itself may hold a hit at equal distance with a lower id.
            if (entry.t > tMax) continue;
            const Bvh::Node& node = bvh_.nodes[entry.node];
            for (std::uint32_t i = node.first; i < node.first + node.count && tMax != kStop; ++i)
                tMax = visit(bvh_.primitives[i]);
            if (node.count > 0) continue;
            pushChildren(stack, ray, node.first);
            boxes += 2;
        }
        return boxes;
    }

    /// Pushes the nearer child last, so that it is visited first.
    void pushChildren(std::vector<Entry>& stack, const Ray<Real>& ray, std::uint32_t first) const {
        const std::size_t before = stack.size();
        push(stack, ray, first);
        push(stack, ray, first + 1);
        if (stack.size() == before + 2 && stack[before].t < stack[before + 1].t)
            std::swap(stack[before], stack[before + 1]);
    }

    void push(std::vector<Entry>& stack, const Ray<Real>& ray, std::uint32_t node) const {
        if (const auto inBox = clipToBox(ray, bvh_.nodes[node].bounds)) stack.push_back({node, inBox->lower});
    }

    const World<Real>& world_;
    IntersectionMethod method_;
    Bvh bvh_;
};

} // namespace isolux
