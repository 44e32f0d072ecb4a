#include <beltrami/solve/raised_corners.h>

#include <Eigen/Geometry>

#include <beltrami/sphere/unit_sphere.h>

namespace beltrami {

Positions raised_corners(const Surface& source, double part) {
    const Positions own = source.metric ? *source.metric : corner_positions(source.mesh);
    Positions corners = Positions::Zero(own.rows(), 3);
    corners.leftCols(own.cols()) = own;
    for (int f = 0; f < source.mesh.face_count(); ++f) {
        const int first = source.mesh.faces.first_corner(f), degree = source.mesh.faces.degree(f);
        if (degree != 3) continue;
        // The longest side lies along the real axis, the apex above it.
        int base = 0;
        double longest = 0;
        for (int i = 0; i < 3; ++i) {
            const double length = (corners.row(first + (i + 1) % 3) - corners.row(first + i)).norm();
            if (length > longest) longest = length, base = i;
        }
        const Eigen::Vector3d a = corners.row(first + base), b = corners.row(first + (base + 1) % 3);
        const Eigen::Vector3d c = corners.row(first + (base + 2) % 3);
        const Eigen::Vector3d along = (b - a) / longest, across = (c - a) - (c - a).dot(along) * along;
        const double height = across.norm(), least = part * longest;
        if (height >= least) continue;
        const Eigen::Vector3d up = height > 0 ? Eigen::Vector3d(across / height) : TangentFrame(along).first;
        corners.row(first + (base + 2) % 3) = c + (least - height) * up;
    }
    return corners;
}

}  // namespace beltrami
