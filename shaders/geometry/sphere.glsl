// Robust ray-sphere test (Haines, Guenther and Akenine-Moeller 2019).
#ifndef ISOLUX_GEOMETRY_SPHERE_GLSL
#define ISOLUX_GEOMETRY_SPHERE_GLSL

// Nearest distance > 0 in units of the direction; 0 without a hit.
float intersectSphere(vec3 center, float radius, vec3 origin, vec3 direction) {
    vec3 f = origin - center;
    float a = dot(direction, direction);
    float b = -dot(f, direction);
    // The discriminant from the distance of the ray's closest point: no cancellation of large squares.
    vec3 closest = f + (b / a) * direction;
    float discriminant = (radius * radius - dot(closest, closest)) * a;
    float distanceToCenter = length(f);
    float c = (distanceToCenter - radius) * (distanceToCenter + radius);
    float root = sqrt(max(discriminant, 0.0));
    float q = b + (b < 0.0 ? -root : root);
    float t0 = c / q;
    float t1 = q / a;
    float nearest = min(t0, t1);
    float furthest = max(t0, t1);
    float hit = nearest > 0.0 ? nearest : max(furthest, 0.0);
    return discriminant < 0.0 || q == 0.0 ? 0.0 : hit;
}

#endif
