#include <beltrami/coefficient/differential_quadrature.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <beltrami/base/parallel.h>
#include <beltrami/base/stop.h>

namespace beltrami {

namespace {

using Place = std::array<double, 2>;

constexpr int kPoints = 6;
struct Node {
    std::array<double, 3> corner;  ///< weights of the corners
    double weight;
};
constexpr double kA = 0.44594849091596488632, kB = 0.09157621350977074346;
constexpr double kWeightA = 0.22338158967801146570, kWeightB = 0.10995174365532186764;
constexpr std::array<Node, kPoints> kRule{{{{1 - 2 * kA, kA, kA}, kWeightA},
                                           {{kA, 1 - 2 * kA, kA}, kWeightA},
                                           {{kA, kA, 1 - 2 * kA}, kWeightA},
                                           {{1 - 2 * kB, kB, kB}, kWeightB},
                                           {{kB, 1 - 2 * kB, kB}, kWeightB},
                                           {{kB, kB, 1 - 2 * kB}, kWeightB}}};

/// A triangle in the coordinates of its face, with the sample to which it belongs.
struct Piece {
    std::array<Place, 3> corners;
    int sample;
    double area;  ///< in those coordinates
};

/// Pieces of a sample's mean are smaller than this part of their distance, or so often divided.
constexpr double kMeanSlope = 0.7;
constexpr int kMeanDepth = 3;
constexpr int kPiecesPerChunk = 512;
/// So many at a time, beyond the faces, or φ is no function that a mesh can resolve.
constexpr std::size_t kMostPieces = 1 << 21;
/// So many are evaluated before the next ones, which keeps memory small; whoever wants a stop is heard in between.
constexpr int kPiecesAtOnce = 32 * kPiecesPerChunk;

Place middle(const Place& a, const Place& b) {
    return {0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])};
}

Place inside(const Piece& piece, const Node& node) {
    Place p{0, 0};
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 2; ++i) p[i] += node.corner[j] * piece.corners[j][i];
    return p;
}

/// Position, derivative and area element at the places of faces.
class Places {
  public:
    Places(const Surface& source, const Chart& chart)
        : operators_(source.operators), faces_(source.mesh.faces), chart_(chart) {
        analytic_ = chart.exact && chart.analytic && source.in_plane();
        if (source.in_plane()) plane_ = *source.coordinate();
    }

    struct At {
        Complex position, derivative;
        double area;  ///< per area in the coordinates of the face
    };
    /// The places of one sample.
    class OfSample {
      public:
        OfSample(const Places& all, int sample)
            : all_(all),
              points_(all.corners(sample)),
              derivative_(all.chart_.derivatives[sample]),
              weight_(all.operators_.weights[sample]),
              vertices_(all.operators_.stencil(sample)) {}
        At operator()(const Place& p) const {
            At at{0.0, derivative_, 2 * weight_};
            if (vertices_.size() == 3) {
                at.position = points_[0] + p[0] * (points_[1] - points_[0]) + p[1] * (points_[2] - points_[0]);
            } else {
                const double x = p[0], y = p[1];
                at.position = (1 - x) * (1 - y) * points_[0] + x * (1 - y) * points_[1] + x * y * points_[2] +
                              (1 - x) * y * points_[3];
                at.area = all_.plane_.size() ? all_.area_in_plane(vertices_, x, y) : 4 * weight_;
            }
            if (all_.analytic_) {
                const auto [value, derivative] = all_.chart_.analytic(at.position);
                at.position = value;
                at.derivative = derivative;
            }
            return at;
        }

      private:
        const Places& all_;
        std::array<Complex, 4> points_;
        Complex derivative_;
        double weight_;
        std::span<const int> vertices_;
    };
    At operator()(int sample, const Place& p) const { return OfSample(*this, sample)(p); }

  private:
    std::array<Complex, 4> corners(int sample) const {
        const auto v = operators_.stencil(sample);
        const int first = chart_.corners.size() ? faces_.first_corner(operators_.faces[sample]) : 0;
        std::array<Complex, 4> points{};
        for (std::size_t j = 0; j < v.size(); ++j)
            points[j] = analytic_               ? plane_[v[j]]
                        : chart_.corners.size() ? chart_.corners[first + static_cast<int>(j)]
                                                : chart_.vertices[v[j]];
        return points;
    }

    double area_in_plane(std::span<const int> v, double x, double y) const {
        const Complex along_x = (1 - y) * (plane_[v[1]] - plane_[v[0]]) + y * (plane_[v[2]] - plane_[v[3]]);
        const Complex along_y = (1 - x) * (plane_[v[3]] - plane_[v[0]]) + x * (plane_[v[2]] - plane_[v[1]]);
        return std::imag(std::conj(along_x) * along_y);
    }

    const Operators& operators_;
    const FaceList& faces_;
    const Chart& chart_;
    bool analytic_;
    Eigen::VectorXcd plane_;  ///< empty for a surface in space
};

std::vector<Piece> whole_faces(const Operators& operators, const Chart& chart) {
    std::vector<Piece> pieces;
    pieces.reserve(operators.weights.size());
    for (int s = 0, q = 0; s < operators.sample_count(); ++s) {
        q = s > 0 && operators.faces[s] == operators.faces[s - 1] ? q + 1 : 0;
        if (chart.excluded[s]) continue;
        if (operators.stencil(s).size() == 3) {
            pieces.push_back({{{{0, 0}, {1, 0}, {0, 1}}}, s, 0.5});
            continue;
        }
        // The Gauss point q is the one next to corner q.
        const double x = q == 1 || q == 2 ? 0.5 : 0, y = q >= 2 ? 0.5 : 0;
        const Place a{x, y}, b{x + 0.5, y}, c{x + 0.5, y + 0.5}, d{x, y + 0.5};
        pieces.push_back({{a, b, c}, s, 0.125});
        pieces.push_back({{a, c, d}, s, 0.125});
    }
    return pieces;
}

void divide(const Piece& p, std::vector<Piece>& into) {
    const Place ab = middle(p.corners[0], p.corners[1]), bc = middle(p.corners[1], p.corners[2]),
                ca = middle(p.corners[2], p.corners[0]);
    const double area = 0.25 * p.area;
    into.push_back({{p.corners[0], ab, ca}, p.sample, area});
    into.push_back({{ab, p.corners[1], bc}, p.sample, area});
    into.push_back({{ca, bc, p.corners[2]}, p.sample, area});
    into.push_back({{ab, bc, ca}, p.sample, area});
}

/// Where a sample lies in its face: a triangle's centroid, or the Gauss point next to corner q of a quad.
Place place_of_sample(std::size_t corners, int q) {
    if (corners == 3) return {1.0 / 3, 1.0 / 3};
    constexpr double near = 0.21132486540518711775;
    return {q == 1 || q == 2 ? 1 - near : near, q >= 2 ? 1 - near : near};
}

/// The quadrature of a function that is known at the samples only.
double visit_samples(const Operators& operators, const Chart& chart, const Eigen::VectorXcd& phi,
                     const std::function<void(const FacePoint&)>& visit) {
    for (int s = 0, q = 0; s < operators.sample_count(); ++s) {
        q = s > 0 && operators.faces[s] == operators.faces[s - 1] ? q + 1 : 0;
        if (chart.excluded[s]) continue;
        if (!std::isfinite(std::norm(phi[s]))) return std::numeric_limits<double>::infinity();
        visit({s, place_of_sample(operators.stencil(s).size(), q), phi[s], operators.weights[s]});
    }
    return 1;
}

/// Integrals over a piece, and whether φ varies on it by more than a part of its mean.
struct PieceSums {
    Complex phi;     ///< ∫φ
    double abs_phi;  ///< ∫|φ|
    bool varies;
};

PieceSums sums_of(const FacePoint* own, double variation) {
    Complex mean = 0;
    PieceSums sums{0.0, 0.0, false};
    for (int n = 0; n < kPoints; ++n) {
        mean += own[n].phi / static_cast<double>(kPoints);
        sums.phi += own[n].weight * own[n].phi;
        sums.abs_phi += own[n].weight * std::sqrt(std::norm(own[n].phi));
    }
    double most = 0;
    for (int n = 0; n < kPoints; ++n) most = std::max(most, std::norm(own[n].phi - mean));
    sums.varies = most > variation * variation * std::norm(mean);
    return sums;
}

/// φ at the points of some pieces, and what it comes to on each.
struct Evaluated {
    std::vector<FacePoint> points;  ///< kPoints a piece
    std::vector<PieceSums> sums;
};

/// Of the pieces begin to end.
void evaluate(const Places& places, const DifferentialSpace& space, const Eigen::VectorXcd& coefficients,
              double variation, const std::vector<Piece>& pieces, int begin, int end, Evaluated& result) {
    result.points.resize(static_cast<std::size_t>(kPoints) * (end - begin));
    result.sums.resize(static_cast<std::size_t>(end - begin));
    const auto evaluate_chunk = [&](int first, int last) {
        ChartPoints at;
        at.positions.resize(kPoints * (last - first));
        at.derivatives.resize(at.positions.size());
        FacePoint* const own = &result.points[static_cast<std::size_t>(kPoints) * (first - begin)];
        for (int i = first, j = 0; i < last; ++i) {
            const Places::OfSample of_sample(places, pieces[i].sample);
            for (int n = 0; n < kPoints; ++n, ++j) {
                const Place place = inside(pieces[i], kRule[n]);
                const Places::At here = of_sample(place);
                at.positions[j] = here.position;
                at.derivatives[j] = here.derivative;
                own[j] = {pieces[i].sample, place, 0.0, pieces[i].area * kRule[n].weight * here.area};
            }
        }
        const Eigen::VectorXcd phi = space.combination(at, coefficients);
        for (Eigen::Index j = 0; j < phi.size(); ++j) own[j].phi = phi[j];
        for (int i = first; i < last; ++i) result.sums[i - begin] = sums_of(own + kPoints * (i - first), variation);
    };
    parallel_for(begin, end, evaluate_chunk, kPiecesPerChunk);
}

/// The adaptive quadrature, piece by piece: take(points, sums), with kPoints points.
/// @return see visit_quadrature
template <class Take>
double visit_pieces(const Surface& source, const Chart& chart, const DifferentialSpace& space,
                    const Eigen::VectorXcd& coefficients, const QuadratureOptions& options, Take&& take) {
    const Places places(source, chart);
    std::vector<Piece> pieces = whole_faces(source.operators, chart), divided;
    for (int depth = 0; depth < options.least_depth; ++depth) {
        divided.clear();
        divided.reserve(4 * pieces.size());
        for (const Piece& piece : pieces) divide(piece, divided);
        pieces.swap(divided);
    }
    double total = 0, unresolved = 0;
    Evaluated block, held;   // held: of pieces that wait until the total is known
    std::vector<int> waits;  // the indices of those
    for (int depth = options.least_depth; !pieces.empty(); ++depth) {
        const int count = static_cast<int>(pieces.size());
        const bool total_known = depth > options.least_depth;
        divided.clear();
        const auto decide = [&](int piece, const FacePoint* own, const PieceSums& sums) {
            const bool matters = sums.abs_phi > options.tolerance * total;
            if (matters && depth < options.most_depth && divided.size() < kMostPieces) {
                divide(pieces[piece], divided);
                return;
            }
            if (matters) unresolved += sums.abs_phi;
            take(own, sums);
        };
        for (int begin = 0; begin < count; begin += kPiecesAtOnce) {
            const int end = std::min(count, begin + kPiecesAtOnce);
            stop_if_wanted();
            evaluate(places, space, coefficients, options.variation, pieces, begin, end, block);
            for (int i = begin; i < end; ++i) {
                const FacePoint* own = &block.points[static_cast<std::size_t>(kPoints) * (i - begin)];
                const PieceSums& sums = block.sums[i - begin];
                if (!std::isfinite(sums.abs_phi)) return std::numeric_limits<double>::infinity();
                if (!total_known) total += sums.abs_phi;
                if (!sums.varies) {
                    take(own, sums);
                } else if (total_known) {
                    decide(i, own, sums);
                } else {
                    waits.push_back(i);
                    held.points.insert(held.points.end(), own, own + kPoints);
                    held.sums.push_back(sums);
                }
            }
        }
        for (std::size_t i = 0; i < waits.size(); ++i)
            decide(waits[i], &held.points[static_cast<std::size_t>(kPoints) * i], held.sums[i]);
        waits.clear();
        held = {};
        pieces.swap(divided);
    }
    return total > 0 ? unresolved / total : 0.0;
}

}  // namespace

double visit_quadrature(const Surface& source, const Chart& chart, const DifferentialSpace& space,
                        const Eigen::VectorXcd& coefficients, const std::function<void(const FacePoint&)>& visit,
                        const QuadratureOptions& options) {
    if (const Eigen::MatrixXcd* values = space.tabulated())
        return visit_samples(source.operators, chart, *values * space.of_generators(coefficients), visit);
    return visit_pieces(source, chart, space, coefficients, options, [&](const FacePoint* own, const PieceSums&) {
        for (int n = 0; n < kPoints; ++n) visit(own[n]);
    });
}

SampleIntegrals integrals_over_samples(const Surface& source, const Chart& chart, const DifferentialSpace& space,
                                       const Eigen::VectorXcd& coefficients) {
    const int samples = source.operators.sample_count();
    SampleIntegrals result{Eigen::VectorXcd::Zero(samples), Eigen::VectorXd::Zero(samples), 0};
    if (const Eigen::MatrixXcd* values = space.tabulated()) {
        result.unresolved = visit_samples(source.operators, chart, *values * space.of_generators(coefficients),
                                          [&](const FacePoint& p) {
                                              result.phi[p.sample] += p.weight * p.phi;
                                              result.abs_phi[p.sample] += p.weight * std::sqrt(std::norm(p.phi));
                                          });
        return result;
    }
    result.unresolved =
        visit_pieces(source, chart, space, coefficients, {}, [&](const FacePoint* own, const PieceSums& sums) {
            result.phi[own->sample] += sums.phi;
            result.abs_phi[own->sample] += sums.abs_phi;
        });
    return result;
}

SamplePoints points_near(const Singularities& singularities, const Surface& source, const Chart& chart) {
    SamplePoints result;
    if (singularities.curves.empty() && singularities.held.empty()) return result;
    std::vector<Complex> centres = singularities.pins;
    for (const auto& held : singularities.held) centres.push_back(held.at);
    for (const auto& corner : singularities.corners) centres.push_back(corner.vertex);
    for (const auto& curve : singularities.curves)
        centres.insert(centres.end(), curve.points.begin() + curve.first, curve.points.begin() + curve.last + 1);
    const Places places(source, chart);
    const std::vector<Piece> faces = whole_faces(source.operators, chart);
    std::vector<std::vector<Piece>> parts(faces.size());
    parallel_for(0, static_cast<int>(faces.size()), [&](int first, int last) {
        std::vector<Piece> pending, divided;
        for (int i = first; i < last; ++i) {
            pending.assign(1, faces[i]);
            for (int depth = 0; !pending.empty(); ++depth) {
                divided.clear();
                for (const Piece& piece : pending) {
                    std::array<Complex, 3> at;
                    for (int j = 0; j < 3; ++j) at[j] = places(piece.sample, piece.corners[j]).position;
                    const Complex middle_point = (at[0] + at[1] + at[2]) / 3.0;
                    double size = 0, distance = std::numeric_limits<double>::infinity();
                    for (const Complex corner : at) size = std::max(size, std::norm(corner - middle_point));
                    for (const Complex centre : centres)
                        distance = std::min(distance, std::norm(centre - middle_point));
                    if (depth < kMeanDepth && size > kMeanSlope * kMeanSlope * distance)
                        divide(piece, divided);
                    else
                        parts[i].push_back(piece);
                }
                pending.swap(divided);
            }
        }
    });
    std::vector<Complex> positions, derivatives;
    std::vector<double> weights;
    std::vector<double> whole(source.operators.sample_count(), 0.0);
    for (const Piece& face : faces) whole[face.sample] += face.area;
    // A quad's sample has two pieces; it is left alone where neither is divided.
    std::vector<char> is_divided(source.operators.sample_count(), 0);
    for (const auto& part : parts)
        if (part.size() > 1) is_divided[part[0].sample] = 1;
    for (const auto& part : parts)
        for (const Piece& piece : part) {
            if (!is_divided[piece.sample]) continue;
            Place centre{0, 0};
            for (const Place& corner : piece.corners)
                for (int i = 0; i < 2; ++i) centre[i] += corner[i] / 3;
            const Places::At here = places(piece.sample, centre);
            result.samples.push_back(piece.sample);
            positions.push_back(here.position);
            derivatives.push_back(here.derivative);
            weights.push_back(piece.area / whole[piece.sample]);
        }
    const auto count = static_cast<Eigen::Index>(positions.size());
    result.points.positions = Eigen::Map<const Eigen::VectorXcd>(positions.data(), count);
    result.points.derivatives = Eigen::Map<const Eigen::VectorXcd>(derivatives.data(), count);
    result.weights = Eigen::Map<const Eigen::VectorXd>(weights.data(), count);
    return result;
}

ChartPoints chart_points(const Surface& source, const Chart& chart, const std::vector<FacePoint>& points) {
    const Places places(source, chart);
    ChartPoints result;
    result.positions.resize(static_cast<Eigen::Index>(points.size()));
    result.derivatives.resize(result.positions.size());
    parallel_for(0, static_cast<int>(points.size()), [&](int first, int last) {
        for (int i = first; i < last; ++i) {
            const Places::At at = places(points[i].sample, points[i].place);
            result.positions[i] = at.position;
            result.derivatives[i] = at.derivative;
        }
    });
    return result;
}

}  // namespace beltrami
