#include <beltrami/generate/grids.h>

#include <cmath>
#include <initializer_list>
#include <string>

#include <beltrami/base/constants.h>
#include <beltrami/base/error.h>

namespace beltrami {
namespace {

void require(const char* what, bool lengths_good, int n, int least_n, int m, int least_m) {
    if (lengths_good && n >= least_n && m >= least_m && 1.0 * n * m < 1.5e8) return;
    throw Error(Cause::bad_option,
                std::string("a ") + what + " of this size with " + std::to_string(n) + " × " + std::to_string(m) +
                    " cells is impossible",
                "give positive lengths, at least " + std::to_string(least_n) + " × " + std::to_string(least_m) +
                    " and fewer than 150 million cells");
}

bool are_lengths(std::initializer_list<double> lengths) {
    for (const double length : lengths) {
        if (!(length > 0.0) || !std::isfinite(length)) return false;
    }
    return true;
}

/// Adds the cell a, b, c, d (counter-clockwise), cut along a–c or b–d if it is to be triangles.
void add_cell(FaceList& faces, Cells cells, int a, int b, int c, int d, bool along_ac) {
    if (cells == Cells::quads) {
        faces.add({a, b, c, d});
    } else if (along_ac) {
        faces.add({a, b, c});
        faces.add({a, c, d});
    } else {
        faces.add({a, b, d});
        faces.add({b, c, d});
    }
}

void reserve(FaceList& faces, Cells cells, int n, int m) {
    if (cells == Cells::quads) {
        faces.reserve(n * m, 4 * n * m);
    } else {
        faces.reserve(2 * n * m, 6 * n * m);
    }
}

}  // namespace

Mesh rectangle(double width, double height, int nx, int ny, Cells cells) {
    require("rectangle", are_lengths({width, height}), nx, 1, ny, 1);
    Mesh mesh;
    mesh.positions.resize(static_cast<Eigen::Index>(nx + 1) * (ny + 1), 2);
    for (int j = 0; j <= ny; ++j) {
        for (int i = 0; i <= nx; ++i) {
            mesh.positions.row(j * (nx + 1) + i) << (i == nx ? width : width * i / nx),
                (j == ny ? height : height * j / ny);
        }
    }
    reserve(mesh.faces, cells, nx, ny);
    for (int j = 0; j < ny; ++j) {
        for (int i = 0; i < nx; ++i) {
            const int a = j * (nx + 1) + i, d = a + nx + 1;
            bool along_ac = (i + j) % 2 == 0;
            const bool left = i == 0, right = i == nx - 1, low = j == 0, high = j == ny - 1;
            if ((left && low) || (right && high)) along_ac = true;
            if ((right && low && !left) || (left && high && !low)) along_ac = false;
            add_cell(mesh.faces, cells, a, a + 1, d + 1, d, along_ac);
        }
    }
    return mesh;
}

Mesh torus(double major, double minor, int nu, int nv, Cells cells) {
    require("torus", are_lengths({minor, major}) && minor < major, nu, 3, nv, 3);
    Mesh mesh;
    mesh.positions.resize(static_cast<Eigen::Index>(nu) * nv, 3);
    reserve(mesh.faces, cells, nu, nv);
    for (int i = 0; i < nu; ++i) {
        for (int j = 0; j < nv; ++j) {
            const double u = kTurn * i / nu, v = kTurn * j / nv;
            const double distance = major + minor * std::cos(v);
            mesh.positions.row(i * nv + j) << distance * std::cos(u), distance * std::sin(u), minor * std::sin(v);
            const int right = (i + 1) % nu, up = (j + 1) % nv;
            add_cell(mesh.faces, cells, i * nv + j, right * nv + j, right * nv + up, i * nv + up, true);
        }
    }
    return mesh;
}

Mesh cylinder(double radius, double height, int nu, int nz, Cells cells) {
    require("cylinder", are_lengths({radius, height}), nu, 3, nz, 1);
    const int rows = nz + 1;
    Mesh mesh;
    mesh.positions.resize(static_cast<Eigen::Index>(nu) * rows, 3);
    reserve(mesh.faces, cells, nu, nz);
    for (int i = 0; i < nu; ++i) {
        const double u = kTurn * i / nu;
        for (int j = 0; j < rows; ++j) {
            mesh.positions.row(i * rows + j) << radius * std::cos(u), radius * std::sin(u), height * j / nz;
            const int right = (i + 1) % nu;
            if (j < nz) {
                add_cell(mesh.faces, cells, i * rows + j, right * rows + j, right * rows + j + 1, i * rows + j + 1,
                         true);
            }
        }
    }
    return mesh;
}

}  // namespace beltrami
