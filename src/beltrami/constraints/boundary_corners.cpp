#include <beltrami/constraints/boundary_corners.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/constraints/corner_fit.h>

namespace beltrami {

namespace {

using detail::Outline;
using detail::Reach;
using detail::WindowFit;

/// The lower sixth of the residuals, raised to a standard deviation: what is left where no corner is near, even if most
/// windows hold one.
void set_noise(Outline& outline, const CornerOptions& options) {
    const int n = outline.size();
    std::array<std::vector<double>, 3> residuals;
    for (auto& of_channel : residuals) of_channel.resize(n);
    const int scale = std::min(4, outline.reach);
    parallel_for(
        0, n,
        [&](int first, int last) {
            for (int i = first; i < last; ++i) {
                const WindowFit fit = fit_window(outline, i, scale, options);
                for (int c = 0; c < 3; ++c) residuals[c][i] = fit.residual[c];
            }
        },
        256);
    constexpr double kToDeviation = 1.5;
    for (int c = 0; c < 3; ++c) {
        const auto at = residuals[c].begin() + n / 6;
        std::nth_element(residuals[c].begin(), at, residuals[c].end());
        outline.noise[c] = kToDeviation * *at;
    }
}

/// The search for the corners of one loop.
class Search {
  public:
    Search(const Outline& outline, const CornerOptions& options)
        : outline_(outline),
          options_(options),
          n_(outline.size()),
          reach_(n_, Reach{outline.reach, outline.reach}),
          significance_(n_),
          taken_(n_, 0) {}

    std::vector<BoundaryCorner> run() {
        fit_all();
        take();
        while (drop()) take();
        std::vector<BoundaryCorner> corners;
        for (int i = 0; i < n_; ++i)
            if (taken_[i] == 1) corners.push_back(fit_corner(outline_, i, reach_[i], options_));
        return corners;
    }

  private:
    /// Takes the most significant vertex, ends the windows of its neighbours there, and so on.
    void take() {
        struct Candidate {
            double significance;
            int position;
            bool operator<(const Candidate& other) const {
                return significance != other.significance ? significance < other.significance
                                                          : position > other.position;
            }
        };
        std::priority_queue<Candidate> queue;
        const auto offer = [&](int i) {
            if (taken_[i] == 0 && significance_[i] > 1) queue.push({significance_[i], i});
        };
        for (int i = 0; i < n_; ++i) offer(i);
        while (!queue.empty()) {
            const Candidate best = queue.top();
            queue.pop();
            if (taken_[best.position] != 0 || best.significance != significance_[best.position]) continue;
            taken_[best.position] = 1;
            if (fit_corner(outline_, best.position, reach_[best.position], options_).exponent != 1)
                keep_clear(best.position);
            for (const int i : limit(best.position)) {
                if (taken_[i] != 0) continue;
                const double before = significance_[i];
                significance_[i] = fit_corner(outline_, i, reach_[i], options_).significance;
                if (significance_[i] != before) offer(i);
            }
        }
    }

    /// Ends windows at a corner; returns where one has become shorter.
    std::vector<int> limit(int corner) {
        std::vector<int> shorter;
        const auto shorten = [&](int i, int& end, int d) {
            if (d >= end) return;
            end = d;
            shorter.push_back(i);
        };
        for (int d = 1; d <= outline_.reach; ++d) {
            const int before = (corner - d + n_) % n_, after = (corner + d) % n_;
            shorten(before, reach_[before].out, d);
            shorten(after, reach_[after].in, d);
        }
        return shorter;
    }

    /// Gives up the neighbours of a vertex where the data behave like a power: that is singular at every scale, so its
    /// nearest neighbours look like corners too.
    void keep_clear(int corner) {
        constexpr int kClear = 8;
        for (int d = 1; d <= std::min(kClear, outline_.reach); ++d)
            for (const int i : {(corner - d + n_) % n_, (corner + d) % n_})
                if (taken_[i] == 0) taken_[i] = 2;
    }

    /// Gives up for good what was taken but is no corner beside those taken later. False if there is none.
    bool drop() {
        bool any = false;
        for (int i = 0; i < n_; ++i) {
            if (taken_[i] != 1 || fit_corner(outline_, i, reach_[i], options_).significance > 1) continue;
            taken_[i] = 2;
            any = true;
        }
        if (!any) return false;
        std::fill(reach_.begin(), reach_.end(), Reach{outline_.reach, outline_.reach});
        for (int i = 0; i < n_; ++i)
            if (taken_[i] == 1) limit(i);
        fit_all();
        return true;
    }

    /// Fits windows to all that has not been decided.
    void fit_all() {
        parallel_for(
            0, n_,
            [&](int first, int last) {
                for (int i = first; i < last; ++i)
                    if (taken_[i] == 0) significance_[i] = fit_corner(outline_, i, reach_[i], options_).significance;
            },
            64);
    }

    const Outline& outline_;
    const CornerOptions& options_;
    int n_;
    std::vector<Reach> reach_;
    std::vector<double> significance_;
    std::vector<char> taken_;  ///< 1: a corner; 2: given up
};

}  // namespace

void CornerOptions::validate() const {
    for (const auto& [value, name] : {std::pair{min_turn, "min_turn"}, std::pair{min_log_speed, "min_log_speed"},
                                      std::pair{min_exponent, "min_exponent"}, std::pair{confidence, "confidence"}})
        if (!(value > 0)) throw Error(Cause::bad_option, std::string(name) + " must be positive");
}

double corner_bound(double source_angle, double image_angle, double speed_out, double speed_in, double exponent) {
    if (!(source_angle > 0) || !(image_angle > 0) || !(exponent > 0)) return std::numeric_limits<double>::infinity();
    const double shear = std::log(speed_in / speed_out) / source_angle, widen = image_angle / source_angle;
    const double half_sum =
        (exponent * exponent + shear * shear + widen * widen) / (2 * exponent * widen);  // ½(K + 1/K)
    return half_sum > 1 ? half_sum + std::sqrt((half_sum - 1) * (half_sum + 1)) : 1.0;
}

std::vector<BoundaryCorner> find_corners(const Surface& source, const BoundaryCondition& boundary,
                                         const CornerOptions& options) {
    options.validate();
    std::vector<Outline> loops = detail::outlines(source, boundary);
    std::vector<BoundaryCorner> result;
    for (std::size_t l = 0; l < loops.size(); ++l) {
        set_noise(loops[l], options);
        for (BoundaryCorner corner : Search(loops[l], options).run()) {
            corner.loop = static_cast<int>(l);
            result.push_back(corner);
        }
    }
    std::stable_sort(result.begin(), result.end(),
                     [](const BoundaryCorner& a, const BoundaryCorner& b) { return a.significance > b.significance; });
    return result;
}

BoundaryCorner measure_boundary_point(const Surface& source, const BoundaryCondition& boundary, int loop, int position,
                                      const CornerOptions& options) {
    options.validate();
    std::vector<Outline> loops = detail::outlines(source, boundary);
    if (loop < 0 || loop >= static_cast<int>(loops.size()) || position < 0 || position >= loops[loop].size())
        throw Error(Cause::bad_option,
                    "there is no vertex " + std::to_string(position) + " on boundary loop " + std::to_string(loop));
    Outline& outline = loops[loop];
    set_noise(outline, options);
    BoundaryCorner corner = fit_corner(outline, position, Reach{outline.reach, outline.reach}, options);
    corner.loop = loop;
    return corner;
}

int edges_to_next_corner(const BoundaryCorner& corner, const std::vector<BoundaryCorner>& corners, int loop_size) {
    int edges = loop_size / 2;
    for (const BoundaryCorner& other : corners) {
        const int apart = std::abs(other.position - corner.position);
        if (other.loop == corner.loop && apart > 0) edges = std::min({edges, apart, loop_size - apart});
    }
    return edges;
}

}  // namespace beltrami
