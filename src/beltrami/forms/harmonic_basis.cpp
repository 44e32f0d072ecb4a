#include <beltrami/forms/harmonic_basis.h>

#include <utility>

#include <beltrami/forms/delaunay_forms.h>

namespace beltrami {

namespace detail {

HarmonicBasis basis_of(const Surface& surface, HomologyBasis homology, const DelaunayForms& found) {
    HarmonicBasis basis;
    basis.forms = homology.cochains.cast<double>();
    for (int e = 0; e < surface.topology.edge_count(); ++e) {
        const auto [a, b] = surface.topology.edges[e];
        basis.forms.row(e) += found.potentials.row(b) - found.potentials.row(a);
    }
    basis.homology = std::move(homology);
    basis.potentials = found.potentials;
    basis.energies = found.energies;
    basis.flips = static_cast<int>(found.flips.size());
    basis.factorizations = 1;
    return basis;
}

}  // namespace detail

HarmonicBasis harmonic_basis(const Surface& surface) {
    HomologyBasis homology = homology_basis(surface);
    const detail::DelaunayForms found(surface, homology);
    return detail::basis_of(surface, std::move(homology), found);
}

Eigen::MatrixXd wedge_products(const Surface& surface, const Eigen::MatrixXd& forms) {
    const FaceList& faces = surface.mesh.faces;
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(forms.cols(), forms.cols());
    for (int f = 0; f < faces.size(); ++f) {
        const int first = faces.first_corner(f), n = faces.degree(f);
        Eigen::RowVectorXd reached = Eigen::RowVectorXd::Zero(forms.cols());  // integrals from the first corner on
        for (int i = 0; i + 1 < n; ++i) {
            const int edge = surface.topology.corner_edges[first + i];
            const int along = surface.topology.edges[edge][0] == faces.vertices()[first + i] ? 1 : -1;
            const Eigen::RowVectorXd next = reached + along * forms.row(edge);
            result += 0.5 * (reached.transpose() * next - next.transpose() * reached);
            reached = next;
        }
    }
    return result;
}

}  // namespace beltrami
