#include "scene/camera_matrices.h"

#include <cmath>

namespace isolux {

Mat4d cameraFromWorld(const Camera& camera) {
    const Mat3d& axes = camera.worldFromCamera;
    const Mat3d rotation = glm::transpose(Mat3d(axes[0], axes[1], -axes[2]));
    Mat4d result(rotation);
    result[3] = glm::dvec4(-(rotation * camera.position), 1.0);
    return result;
}

Mat4d ndcFromWorld(const Camera& camera, double aspect) {
    const bool perspective = camera.projection == Projection::perspective;
    const double halfHeight = perspective ? std::tan(0.5 * camera.yfov) : camera.ymag;
    Mat4d ndcFromCamera(0.0); // columns
    ndcFromCamera[0][0] = 0.5 / (aspect * halfHeight);
    ndcFromCamera[1][1] = -0.5 / halfHeight;
    // (0.5, 0.5) is the middle: times w, which is z under perspective and 1 otherwise.
    const int wColumn = perspective ? 2 : 3;
    ndcFromCamera[wColumn][0] = 0.5;
    ndcFromCamera[wColumn][1] = 0.5;
    ndcFromCamera[wColumn][3] = 1.0;
    ndcFromCamera[perspective ? 3 : 2][2] = 1.0;
    return ndcFromCamera * cameraFromWorld(camera);
}

} // namespace isolux
