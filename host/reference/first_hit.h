// Integrators that stop where the camera ray lands: what is there, and how open it is. Lights play no part.
#pragma once

#include "reference/scattering.h"
#include "reference/tracing.h"

#include <cstdint>

namespace isolux {

/// Keeps a reference; safe to use from many threads.
template <typename Real> class FirstHitTracer {
public:
    FirstHitTracer(const Tracing<Real>& tracing, const RenderSettings& settings)
        : tracing_(tracing), integrator_(settings.integrator),
          ambientDistance_(static_cast<Real>(settings.ambientDistance)) {}

    [[nodiscard]] PathResult<Real> trace(const SampleStream& stream) const {
        PathResult<Real> result;
        const std::optional<Surface<Real>> surface =
            tracing_.findSurface(tracing_.cameraRay(stream), tracing_.presence(stream, 0), result);
        if (!surface) return result;
        tracing_.noteFirstHit(result, *surface);
        result.radiance = valueAt(*surface, stream, result);
        return result;
    }

private:
    [[nodiscard]] Vec3<Real> valueAt(const Surface<Real>& surface, const SampleStream& stream,
                                     PathResult<Real>& result) const {
        switch (integrator_) {
        case Integrator::normals: return (surface.ns + Real(1)) / Real(2);
        case Integrator::albedo: return baseAt(tracing_.attributes(), surface.place());
        case Integrator::depth: return Vec3<Real>(tracing_.depthOf(surface));
        case Integrator::ao: return Vec3<Real>(openness(surface, stream, result));
        case Integrator::path:
        case Integrator::direct: break;
        }
        return Vec3<Real>(0);
    }

    /// 1 if a direction distributed by its cosine leads away from everything near, else 0: the mean over directions is
    /// ambient occlusion's complement (Zhukov, Iones and Kronin 1998).
    [[nodiscard]] Real openness(const Surface<Real>& surface, const SampleStream& stream,
                                PathResult<Real>& result) const {
        const Vec3<Real> wi = scatterByCosine(surface, stream.block(2)).wi;
        if (!tracing_.onOurSide(surface, wi)) {
            result.record(PathEvent::noRay);
            return 0;
        }
        const Ray<Real> ray{surface.originTowards(wi), wi, ambientDistance_};
        const Visibility open = tracing_.visibility(ray, kNoPrimitive, tracing_.presence(stream, 1), result);
        return open == Visibility::clear ? Real(1) : Real(0);
    }

    const Tracing<Real>& tracing_;
    Integrator integrator_;
    Real ambientDistance_;
};

} // namespace isolux
