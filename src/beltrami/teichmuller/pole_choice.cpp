#include <beltrami/teichmuller/pole_choice.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <beltrami/plane/circle_fit.h>
#include <beltrami/teichmuller/coarse_start.h>
#include <beltrami/teichmuller/crowding.h>
#include <beltrami/teichmuller/elongation.h>

namespace beltrami {

namespace {

/// A corner is clear from this significance on (those of scans have 1 to 2.5), one of the image where that turns by so
/// much (radians).
constexpr double kClearCorner = 3, kSharpImage = 0.35;
/// Corners beyond this number are how the outline of a scan runs: of a coarse mesh that was divided, say. With all of
/// their functions a map of 110 088 faces with 47 corners takes 39 harmonic ones. In the surface's metric each keeps
/// its farthest poles then, those at more than this part of its reach, and of very many corners the most significant
/// ones are taken (of the 47: K 1.502 above the bound 1.496, with all poles 1.494 above 1.481). In the plane of the
/// chart, where poles would come to a map that has settled without them, there are none then: K rises to what
/// quadrilaterals of the outline force.
constexpr std::size_t kManyCorners = 24, kVeryManyCorners = 48, kMostCorners = 96;
constexpr double kPartOfReach = 0.15, kLargePartOfReach = 0.3;
/// Noise, as part of k, above which the plane of a chart is taken as the metric. Measured: smooth meshes have .002, a
/// face of 34 144 triangles .015, where the surface's metric is more exact; scans whose maps it keeps from settling, or
/// whose bracket the plane narrows, .04 to .3.
constexpr double kNoise = 0.03;
/// Where the bracket of the coarse problem, times its triangles, is below this, the corners are not seen. (A bump has
/// .7; four points of a disk have 4, and leaving their poles out would cost .35 % of K.)
constexpr double kTight = 2;
/// Up to this they may be seen on the coarse mesh alone. That they are not on the fine one is shown by its bracket:
/// that of a smooth problem falls like 1/triangles (three lobes: 10.8, 10.5, 10.4 times that on any mesh), that of a
/// singular one does not (four points of a disk: 3.5, then 11.5; a half-plane: 20, then 102). So much more is taken for
/// smooth. In a chart that is not exact noise does not let it fall.
constexpr double kPerhapsTight = 16, kFallsLikeSmooth = 1.5;
/// Directions of held vertices that turn by less (radians) are kept.
constexpr double kTurned = 0.02;

/// Whether the outer loop goes to a circle; that of a triangle or of a rectangle always lies on one.
bool goes_to_circle(const std::vector<int>& loop, const Eigen::VectorXcd& map) {
    std::vector<Complex> images;
    images.reserve(loop.size());
    for (const int v : loop) images.push_back(map[v]);
    return loop.size() > 4 && fit_circle(images).exact();
}

/// Leaves so many functions at corners as a c-step can do with.
Singularities thinned(Singularities singularities) {
    std::vector<Singularities::Corner>& corners = singularities.corners;
    if (corners.size() <= kManyCorners) return singularities;
    if (corners.size() > kMostCorners) corners.resize(kMostCorners);
    const double part = corners.size() > kVeryManyCorners ? kLargePartOfReach : kPartOfReach;
    for (Singularities::Corner& corner : corners) corner.finest = std::max(corner.finest, part * corner.reach);
    return singularities;
}

bool turns_image(const BoundaryCorner& corner) {
    return std::abs(corner.image_angle - std::numbers::pi) > kSharpImage;
}

}  // namespace

PoleChoice::PoleChoice(ExtremalProblem& problem, const BoundaryCondition& boundary,
                       const std::vector<BoundaryCorner>& corners, const ExtremalOptions& options)
    : problem_(problem), boundary_(boundary), corners_(corners), options_(options) {}

/// Corners of the image's outline. A circle has none, even where a coarse rim turns by as much at each of its vertices.
std::ptrdiff_t PoleChoice::image_corners() const {
    if (round_image_) return 0;
    return std::count_if(corners_.begin(), corners_.end(), turns_image);
}

/// The corners that are more than what the outline of a scan has everywhere. In the plane of a chart poles at the
/// others would be fitted to single edges, and at these they are withheld as long as the bracket is narrow without.
std::vector<BoundaryCorner> PoleChoice::clear_corners() const {
    std::vector<BoundaryCorner> result;
    for (const BoundaryCorner& corner : corners_)
        if (corner.significance > kClearCorner) result.push_back(corner);
    return result;
}

/// Whether the plane of the problem's chart is to be the metric of the iteration: not where the image has corners, at
/// which φ needs its poles from the start.
bool PoleChoice::wants_chart_metric() {
    if (image_corners() > 0 || !problem_.chart_metric_possible()) return false;
    if (options_.slack > 0) return true;
    if (options_.chart_metric) return *options_.chart_metric;
    noise_ = problem_.chart_noise(options_.cluster_count);
    return noise_ > kNoise;
}

/// φ of products of one-forms, without a chart.
void PoleChoice::take_form_products() {
    const Surface& source = problem_.source();
    const Eigen::VectorXcd& harmonic = problem_.harmonic();
    products_ = form_product_space(source.operators, rim_nodes(source, harmonic), problem_.solver());
    const double clip = crowded_clip(source, problem_.chart(), harmonic);
    problem_.set_chart(uncrowded(source, problem_.chart(), harmonic));
    problem_.set_singularities({}, std::max(options_.cluster_count, kCrowdedClusters));
    problem_.coefficient_step().set_clip(clip);
}

HamiltonState PoleChoice::choose(ProblemChart charts, bool plain) {
    const Surface& source = problem_.source();
    const auto& loops = source.topology.boundary_loops;
    round_image_ = problem_.is_disk_in_space() && goes_to_circle(loops[0], problem_.harmonic());
    HamiltonState state;
    instead_ = std::move(charts.instead);
    elongated_ = plain && loops.size() == 1 && boundary_.lines.empty() &&
                 boundary_.vertices.size() == loops[0].size() && image_corners() > 2 &&
                 is_elongated(source.operators, problem_.harmonic());
    if (plain && !elongated_ && problem_.is_disk_in_space() &&
        values_crowd(source, charts.chart, problem_.harmonic())) {
        instead_.reset();
        problem_.set_chart(std::move(charts.chart));
        take_form_products();
        return {};
    }
    Singularities singularities = take_chart(std::move(charts.chart), problem_.harmonic());
    // Corners that only a fine mesh would resolve need no poles; that they do not, the coarse problem shows. In a
    // chart far from conformal poles at corners would see its errors as dilatation.
    if (!elongated_ && (singularities.only_corners() || (instead_ && singularities.empty())) && plain &&
        problem_.chart_is_round()) {
        CoarseStart coarse = coarse_start(source, boundary_, problem_.chart(), problem_.phase(),
                                          problem_.largest_degree(), options_, instead_ ? 0 : kCoarseStartPays);
        const bool tight = coarse.bracket_by_triangles < kTight;
        if (tight || (problem_.chart().exact && coarse.bracket_by_triangles < kPerhapsTight)) {
            smooth_ = true;
            state = std::move(coarse.state);
            withheld_ = std::move(singularities);
            singularities = {};
            if (!tight)
                widest_bracket_ = std::min(
                    kPolesNeeded, kFallsLikeSmooth * coarse.bracket_by_triangles / source.operators.sample_count());
        }
    }
    if (instead_ && !withheld_) singularities = take_instead(problem_.harmonic());
    if (elongated_) singularities = {};
    problem_.set_singularities(std::move(singularities), options_.cluster_count);
    if (elongated_) problem_.coefficient_step().set_clip(clip_of_elongated(source.operators, problem_.harmonic()));
    return state;
}

/// Makes a chart that of the problem; returns where φ may be singular in it.
Singularities PoleChoice::take_chart(Chart chart, const Eigen::VectorXcd& at) {
    const Surface& source = problem_.source();
    Singularities result = singularities_of(source, chart, boundary_, corners_, at);
    if (problem_.is_disk_in_space() && image_corners() == 0) result = thinned(std::move(result));
    const bool on_boundary = result.empty() || result.only_corners();
    held_alone_ = held_vertices(source, chart, boundary_, at);
    problem_.set_chart(std::move(chart));
    if (on_boundary && !elongated_ && wants_chart_metric()) {
        problem_.take_chart_metric();
        result = {};
        Singularities clear = singularities_of(source, problem_.chart(), boundary_, clear_corners(), at);
        if (!clear.empty() && clear.corners.size() <= kManyCorners) withheld_ = std::move(clear);
    }
    smooth_ = result.empty();
    return result;
}

Singularities PoleChoice::take_instead(const Eigen::VectorXcd& at) {
    Chart chart = std::move(*instead_);
    instead_.reset();
    return take_chart(std::move(chart), at);
}

void PoleChoice::take_withheld(const Eigen::VectorXcd& map) {
    if (instead_) *withheld_ = take_instead(map);
    problem_.set_singularities(std::move(*withheld_), options_.cluster_count);
    withheld_.reset();
    smooth_ = false;
}

bool PoleChoice::follow(const Eigen::VectorXcd& map) {
    HeldVertices now = held_vertices(problem_.source(), problem_.chart(), boundary_, map);
    bool turned = false;
    for (std::size_t i = 0; i < now.vertices.size(); ++i)
        turned = turned || std::abs(std::imag(now.directions[i] * std::conj(held_alone_.directions[i]))) > kTurned;
    if (!turned) return false;
    held_alone_ = std::move(now);
    problem_.set_singularities(singularities_of(problem_.source(), problem_.chart(), boundary_, corners_, map),
                               options_.cluster_count);
    return true;
}

}  // namespace beltrami
