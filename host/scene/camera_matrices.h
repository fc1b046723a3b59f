// A camera as the two matrices that image files carry.
#pragma once

#include "scene/scene.h"

namespace isolux {

/// World to camera space as OpenEXR defines it: left-handed, x right, y up, z where the camera looks. Column vectors.
[[nodiscard]] Mat4d cameraFromWorld(const Camera& camera);

/// World to normalised device coordinates as OpenEXR defines them: after division by w, (0, 0) is the image's upper
/// left corner and (1, 1) its lower right one. z/w is 1/distance along the axis for a perspective camera, that distance
/// for an orthographic one. `aspect` is width / height of the image.
[[nodiscard]] Mat4d ndcFromWorld(const Camera& camera, double aspect);

} // namespace isolux
