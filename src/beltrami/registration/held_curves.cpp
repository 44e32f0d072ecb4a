#include <beltrami/registration/held_curves.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <Eigen/Geometry>

#include <beltrami/base/error.h>
#include <beltrami/flow/averaged_patches.h>
#include <beltrami/flow/unfolded_patches.h>
#include <beltrami/locate/point_at.h>
#include <beltrami/operators/frames.h>
#include <beltrami/registration/curve_start.h>
#include <beltrami/sphere/unit_sphere.h>
#include <beltrami/targets/curve_on_target.h>

namespace beltrami {

namespace {

constexpr double kNear = 0.02;   // of a partner's length: images of a curve that lie on it already
constexpr double kTouch = 1e-9;  // of lengths, below which a point counts as on a segment

PartnerCurves on_mesh(const Mesh& mesh, std::span<const CurveOnto> curves) {
    std::vector<CurveThrough> there;
    for (const CurveOnto& curve : curves) {
        CurveThrough through{{}, curve.source.closed};
        for (const Target::Point& point : curve.target) through.points.push_back(point.place);
        there.push_back(std::move(through));
    }
    try {
        MeshWithCurves with_curves = mesh_with_curves(mesh, there);
        return {std::move(with_curves.curves), std::move(with_curves.mesh.positions)};
    } catch (const Error& error) {
        throw Error(error.cause(), std::string("the target: ") + error.what(), {}, error.where());
    }
}

struct Segment {
    Eigen::Vector3d from, to;
};

/// Whether two short segments of a surface cross or touch, seen along its normal there.
bool meet(const Segment& a, const Segment& b, const Target& target) {
    const Eigen::Vector3d middle = 0.5 * (a.from + a.to);
    const double reach = (a.to - a.from).norm() + (b.to - b.from).norm();
    if ((0.5 * (b.from + b.to) - middle).norm() > reach) return false;
    const TangentFrame frame(target.nearest(middle).normal);
    const auto flat = [&](const Eigen::Vector3d& point) {
        return Complex((point - middle).dot(frame.first), (point - middle).dot(frame.second));
    };
    const std::array<Complex, 4> p{flat(a.from), flat(a.to), flat(b.from), flat(b.to)};
    const auto apart = [&](Complex from, Complex to, Complex first, Complex second) {  // sides of a line
        const double one = std::imag(std::conj(to - from) * (first - from)),
                     other = std::imag(std::conj(to - from) * (second - from)), tiny = kTouch * reach * reach;
        return (one > tiny && other < -tiny) || (one < -tiny && other > tiny);
    };
    if (apart(p[0], p[1], p[2], p[3]) && apart(p[2], p[3], p[0], p[1])) return true;
    const auto touches = [&](Complex point, Complex from, Complex to) {
        const Complex way = to - from;
        const double t = std::clamp(std::real(std::conj(way) * (point - from)) / std::norm(way), 0.0, 1.0);
        return std::abs(point - from - t * way) < kTouch * reach;
    };
    return touches(p[0], p[2], p[3]) || touches(p[1], p[2], p[3]) || touches(p[2], p[0], p[1]) ||
           touches(p[3], p[0], p[1]);
}

/// @throw Error bad_boundary if one of the curves meets itself or another one
void require_apart(const Target& target, const PartnerCurves& curves) {
    const auto segments_of = [&](const MeshWithCurves::Chain& chain) {
        std::vector<Segment> segments;
        segments.reserve(chain.vertices.size());
        for (std::size_t i = chain.closed ? 0 : 1; i < chain.vertices.size(); ++i)
            segments.push_back({curves.points.row(chain.vertices[i == 0 ? chain.vertices.size() - 1 : i - 1]),
                                curves.points.row(chain.vertices[i])});
        return segments;
    };
    std::vector<std::vector<Segment>> all;
    all.reserve(curves.chains.size());
    for (const MeshWithCurves::Chain& chain : curves.chains) all.push_back(segments_of(chain));
    for (std::size_t c = 0; c < all.size(); ++c)
        for (std::size_t d = 0; d <= c; ++d)
            for (std::size_t i = 0; i < all[c].size(); ++i)
                for (std::size_t j = 0; j < (c == d ? i : all[d].size()); ++j) {
                    const bool neighbours = c == d && (i - j < 2 || i - j + 1 == all[c].size());
                    if (neighbours || !meet(all[c][i], all[d][j], target)) continue;
                    const std::string name = "on the target curve " + std::to_string(c + 1);
                    throw Error(Cause::bad_boundary,
                                c == d ? name + " meets itself" : name + " meets curve " + std::to_string(d + 1),
                                "curves must not touch: move one of them, or give more points");
                }
}

PartnerCurves elsewhere(const Target& target, std::span<const CurveOnto> curves) {
    std::vector<Eigen::Vector3d> points;
    PartnerCurves result;
    for (const CurveOnto& curve : curves) {
        MeshWithCurves::Chain chain;
        chain.closed = curve.source.closed;
        const std::size_t given = curve.target.size(), pieces = given - (chain.closed ? 0 : 1);
        const auto add = [&](const Eigen::Vector3d& point) {
            if (!chain.vertices.empty()) chain.length += (point - points.back()).norm();
            chain.vertices.push_back(static_cast<int>(points.size()));
            chain.lengths.push_back(chain.length);
            points.push_back(point);
        };
        for (std::size_t i = 0; i < pieces; ++i) {
            const Target::Points way = straight_way(target, curve.target[i], curve.target[(i + 1) % given]);
            chain.given.push_back(static_cast<int>(chain.vertices.size()));
            for (std::size_t k = 0; k + 1 < way.size(); ++k) add(way[k].position);
        }
        if (chain.closed) {
            chain.length += (points[chain.vertices[0]] - points.back()).norm();
        } else {
            chain.given.push_back(static_cast<int>(chain.vertices.size()));
            add(curve.target.back().position);
        }
        result.chains.push_back(std::move(chain));
    }
    result.points.resize(static_cast<Eigen::Index>(points.size()), 3);
    for (std::size_t i = 0; i < points.size(); ++i) result.points.row(static_cast<Eigen::Index>(i)) = points[i];
    require_apart(target, result);
    return result;
}

Positions in_space(const Positions& points) {
    Positions result = Positions::Zero(points.rows(), 3);
    result.leftCols(points.cols()) = points;
    return result;
}

/// @throw Error bad_option
void require_start(const Positions& start, const Mesh& source) {
    if (start.rows() != source.vertex_count())
        throw Error(Cause::bad_option, "the start has " + std::to_string(start.rows()) + " points, the source " +
                                           std::to_string(source.vertex_count()) + " vertices");
}

/// A map of a surface's vertices as one of all vertices of it with curves.
Positions divided(const Positions& start, const MeshWithCurves& with_curves) {
    Positions result(start.rows() + static_cast<Eigen::Index>(with_curves.places.size()), 3);
    result.topRows(start.rows()) = start;
    for (std::size_t i = 0; i < with_curves.places.size(); ++i) {
        result.row(start.rows() + static_cast<Eigen::Index>(i)) = point_at(start, with_curves.places[i]).transpose();
    }
    return result;
}

/// The angle from one edge of a face to another, seen from the side of its normal.
double turn(const Mesh& mesh, int face, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    const Eigen::Vector3d up = face_vector_area(mesh, face).normalized();
    return std::atan2(from.cross(to).dot(up), from.dot(to));
}

/// The arc lengths of the points of a partner that are nearest to a curve's vertices, where these lie near it already
/// and in its order; else nothing.
std::optional<std::vector<double>> places_along(const SlideCurve& partner, const MeshWithCurves::Chain& chain,
                                                const Positions& images) {
    std::vector<double> places;
    for (const int v : chain.vertices) {
        const Eigen::Vector3d image = images.row(v);
        places.push_back(partner.nearest(image));
        if ((partner.point(places.back()) - image).norm() > kNear * partner.length()) return {};
    }
    if (!chain.closed) {
        places.front() = 0;
        places.back() = partner.length();
    }
    double around = 0;
    for (std::size_t i = chain.closed ? 0 : 1; i < places.size(); ++i) {
        double way = places[i] - places[i == 0 ? places.size() - 1 : i - 1];
        if (chain.closed && way < 0) way += partner.length();
        if (!(way > 0)) return {};
        around += way;
    }
    if (around > 1.5 * partner.length()) return {};
    return places;
}

}  // namespace

PartnerCurves partner_curves(const Target& target, std::span<const CurveOnto> curves) {
    for (std::size_t c = 0; c < curves.size(); ++c) {
        const std::string name = "curve " + std::to_string(c + 1);
        if (curves[c].source.points.size() != curves[c].target.size())
            throw Error(Cause::bad_boundary,
                        name + " has " + std::to_string(curves[c].source.points.size()) + " points and its partner " +
                            std::to_string(curves[c].target.size()),
                        "give as many points of the partner, in the same order");
        const std::size_t points = curves[c].target.size(), pieces = points - (curves[c].source.closed ? 0 : 1);
        for (std::size_t i = 0; i < pieces && points > 1; ++i)
            if (curves[c].target[i].position == curves[c].target[(i + 1) % points].position)
                throw Error(Cause::bad_boundary, "the partner of " + name + " has two points that coincide",
                            "leave one of them out");
    }
    return target.mesh() ? on_mesh(*target.mesh(), curves) : elsewhere(target, curves);
}

void hold_curves(const MeshWithCurves& source, const PartnerCurves& partners, std::span<const char> slides,
                 const Target& target, TargetConstraints& constraints, Positions& images) {
    for (std::size_t c = 0; c < source.curves.size(); ++c) {
        const MeshWithCurves::Chain &chain = source.curves[c], &partner = partners.chains[c];
        const auto curve = static_cast<int>(constraints.curves.size());
        std::optional<std::vector<double>> places;
        if (slides[c]) {
            const Positions points = partners.points(partner.vertices, Eigen::all);
            if (target.mesh())
                constraints.curves.push_back(std::make_shared<PolylineCurve>(points, partner.closed));
            else
                constraints.curves.push_back(std::make_shared<CurveOnTarget>(target, points, partner.closed));
            places = places_along(*constraints.curves.back(), chain, images);
        }
        for (std::size_t i = 0; i < chain.vertices.size(); ++i) {
            const bool end = !chain.closed && (i == 0 || i + 1 == chain.vertices.size());
            Eigen::Vector3d there;
            if (places) {
                there = constraints.curves.back()->point((*places)[i]);
            } else {
                const auto [segment, part] = partner_place(chain, i, partner);
                const int a = partner.vertices[segment], b = partner.vertices[(segment + 1) % partner.vertices.size()];
                there = (1 - part) * partners.points.row(a) + part * partners.points.row(b);
            }
            images.row(chain.vertices[i]) = target.nearest(there).position.transpose();
            if (slides[c] && !end)
                constraints.sliding.push_back({chain.vertices[i], curve});
            else
                constraints.fixed.push_back(chain.vertices[i]);
        }
    }
}

HeldCurves held_curves(const Mesh& source, const Target& target, std::span<const CurveOnto> curves,
                       const Positions& start) {
    require_start(start, source);
    std::vector<CurveThrough> here;
    for (const CurveOnto& curve : curves) here.push_back(curve.source);
    MeshWithCurves with_curves = [&] {
        try {
            return mesh_with_curves(source, here);
        } catch (const Error& error) {
            throw Error(error.cause(), std::string("the source: ") + error.what(), {}, error.where());
        }
    }();
    const Positions all = divided(in_space(start), with_curves);
    return held_curves(std::move(with_curves), target, curves, all);
}

HeldCurves held_curves(MeshWithCurves source, const Target& target, std::span<const CurveOnto> curves,
                       const Positions& start) {
    require_start(start, source.mesh);
    const PartnerCurves partners = partner_curves(target, curves);
    std::vector<char> slides;
    for (const CurveOnto& curve : curves) slides.push_back(curve.slides);
    HeldCurves result;
    result.source = std::move(source);
    result.wanted = result.start = in_space(start);
    hold_curves(result.source, partners, slides, target, result.constraints, result.wanted);
    return result;
}

LedMap led_start(const Surface& with_curves, const Target& target, const HeldCurves& held) {
    return led_map(with_curves, target, held.constraints, {nearest_points(target, held.start), {}},
                   target_map(with_curves, target, held.constraints, held.wanted));
}

Eigen::VectorXcd mu_along_curves(const Surface& source, const MeshWithCurves& divided, const Surface& with_curves,
                                 const Eigen::VectorXcd& mu) {
    const Eigen::VectorXcd along_edges = mu_along_first_edge(source, mu),
                           directions = first_edge_directions(with_curves);
    std::vector<std::vector<int>> samples_of(static_cast<std::size_t>(source.mesh.face_count()));
    for (int s = 0; s < source.operators.sample_count(); ++s) samples_of[source.operators.faces[s]].push_back(s);
    std::vector<int> next(static_cast<std::size_t>(with_curves.mesh.face_count()), 0);
    Eigen::VectorXcd result(with_curves.operators.sample_count());
    for (int s = 0; s < result.size(); ++s) {
        const int face = with_curves.operators.faces[s], old = divided.faces[face];
        const auto corners = with_curves.mesh.faces[face], before = source.mesh.faces[old];
        const bool whole = std::equal(corners.begin(), corners.end(), before.begin(), before.end());
        Complex value = 0;
        if (whole) {
            value = along_edges[samples_of[old][next[face]++]];
        } else {
            for (const int of : samples_of[old]) value += along_edges[of] / static_cast<double>(samples_of[old].size());
            const double angle = turn(source.mesh, old, source.mesh.point(before[1]) - source.mesh.point(before[0]),
                                      with_curves.mesh.point(corners[1]) - with_curves.mesh.point(corners[0]));
            value *= std::polar(1.0, -2 * angle);
        }
        result[s] = value * directions[s] * directions[s];
    }
    return result;
}

TargetMap own_part(const Surface& source, const Target& target, const TargetConstraints& constraints,
                   const TargetMap& map) {
    const int own = source.mesh.vertex_count();
    TargetMap result{{map.points.begin(), map.points.begin() + own}, {}};
    std::vector<char> held(static_cast<std::size_t>(own), 0);
    const auto hold = [&](int vertex) {
        if (vertex < own) held[vertex] = 1;
    };
    for (const int v : constraints.fixed) hold(v);
    for (const TargetConstraints::Slide& slide : constraints.sliding) hold(slide.vertex);
    if (average_flipped_patches(source, target, held, result) > 0) unfold_flipped_patches(source, target, held, result);
    return result;
}

}  // namespace beltrami
