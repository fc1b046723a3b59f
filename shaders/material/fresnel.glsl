// How much a smooth interface reflects.
#ifndef ISOLUX_MATERIAL_FRESNEL_GLSL
#define ISOLUX_MATERIAL_FRESNEL_GLSL

// (1 - cosine)^5 (Schlick 1994).
float schlickWeight(float cosine) {
    float m = clamp(1.0 - cosine, 0.0, 1.0);
    float m2 = m * m;
    return m2 * m2 * m;
}

// Cosine of the refracted direction, 0 at total reflection; eta = index beyond / index on the side of the cosine.
float refractedCosine(float cosine, float eta) {
    return sqrt(max(1.0 - (1.0 - cosine * cosine) / (eta * eta), 0.0));
}

// Exact, for unpolarised light; 1 at total reflection.
float dielectricFresnel(float cosine, float eta) {
    float refracted = refractedCosine(cosine, eta);
    float parallel = (eta * cosine - refracted) / (eta * cosine + refracted);
    float perpendicular = (cosine - eta * refracted) / (cosine + eta * refracted);
    float partial = 0.5 * (parallel * parallel + perpendicular * perpendicular);
    return refracted > 0.0 ? partial : 1.0;
}

#endif
