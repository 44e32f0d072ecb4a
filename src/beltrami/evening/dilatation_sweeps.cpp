#include <beltrami/evening/dilatation_sweeps.h>

#include <algorithm>
#include <numeric>

#include <beltrami/base/parallel.h>

namespace beltrami {

namespace {

/// Added to the diagonal of the 2×2 system, as a part of its trace.
constexpr double kSweepShift = 1e-3;
/// Lengths of the step that are tried: 1, .35, .35² …
constexpr double kShorten = 0.35;
constexpr int kSweepTrials = 4;
/// Vertices a thread takes at once.
constexpr int kGrain = 256;

}  // namespace

DilatationSweeps::DilatationSweeps(const Operators& operators, const VertexSamples& around,
                                   const std::vector<Freedom>& freedoms) {
    const int n = operators.vertex_count;
    std::vector<int> colour(static_cast<std::size_t>(n), -1), taken_by;
    for (int v = 0; v < n; ++v) {
        if (freedoms[v] != Freedom::free || around[v].empty()) continue;
        for (const auto& corner : around[v])
            for (const int u : operators.stencil(corner.sample))
                if (colour[u] >= 0) taken_by[colour[u]] = v;
        const auto first = std::find_if(taken_by.begin(), taken_by.end(), [v](int by) { return by != v; });
        colour[v] = static_cast<int>(first - taken_by.begin());
        if (first == taken_by.end()) taken_by.push_back(-1);
    }

    colours_.assign(taken_by.size() + 1, 0);
    for (const int c : colour)
        if (c >= 0) ++colours_[c + 1];
    std::partial_sum(colours_.begin(), colours_.end(), colours_.begin());
    vertices_.resize(static_cast<std::size_t>(colours_.back()));
    std::vector<int> place(colours_.begin(), colours_.end() - 1);
    for (int v = 0; v < n; ++v)
        if (colour[v] >= 0) vertices_[place[colour[v]]++] = v;
    offsets_.push_back(0);
    for (const int v : vertices_) {
        for (const auto& corner : around[v]) {
            const Complex h = 0.5 * operators.gradients[corner.position];
            incidences_.push_back({h.real(), h.imag(), corner.sample});
        }
        offsets_.push_back(static_cast<int>(incidences_.size()));
    }
}

void DilatationSweeps::run(DilatationSpread& spread, Eigen::VectorXcd& f, int sweeps, double outlier_penalty) const {
    const double k = spread.k();
    SpreadSample* const samples = spread.samples().data();
    const auto move = [&](int i) {
        const Incidence* const begin = incidences_.data() + offsets_[i];
        const Incidence* const end = incidences_.data() + offsets_[i + 1];
        double xx = 0, xy = 0, yy = 0, gx = 0, gy = 0;
        DilatationSpread::Value before;
        for (const Incidence* e = begin; e != end; ++e) {
            const SpreadSample& s = samples[e->sample];
            const double hx = e->h_re, hy = e->h_im;
            const SpreadTerm t = spread_term_held(s, k);
            // Rows (gradients) of r and of (q − νp)/S.
            const double rx = t.along_q * (s.q_re * hx + s.q_im * hy) + t.along_p * (s.p_re * hx - s.p_im * hy),
                         ry = -t.along_q * (s.q_re * hy - s.q_im * hx) + t.along_p * (s.p_re * hy + s.p_im * hx);
            const double cx = (hx - s.nu_re * hx - s.nu_im * hy) * t.inverse_size,
                         cy = (hy - s.nu_im * hx + s.nu_re * hy) * t.inverse_size;
            const double x = (s.q_re - s.nu_re * s.p_re + s.nu_im * s.p_im) * t.inverse_size,
                         y = (s.q_im - s.nu_re * s.p_im - s.nu_im * s.p_re) * t.inverse_size;
            const double r2 = outlier_penalty * t.r * t.r, slope = s.weight * (1 + 2 * r2) * t.r,
                         curvature = s.weight * (1 + 6 * r2), held = s.anchor * (cx * cx + cy * cy);
            xx += curvature * rx * rx + held;
            yy += curvature * ry * ry + held;
            xy += curvature * rx * ry;
            gx += slope * rx + s.anchor * (x * cx + y * cy);
            gy += slope * ry + s.anchor * (y * cx - x * cy);
            before.energy += s.weight * t.r * t.r * (1 + r2) + s.anchor * (x * x + y * y);
            before.flipped += s.p_re * s.p_re + s.p_im * s.p_im <= s.q_re * s.q_re + s.q_im * s.q_im;
        }
        const double shift = kSweepShift * (xx + yy);
        xx += shift;
        yy += shift;
        const double determinant = xx * yy - xy * xy;
        if (!(determinant > 0)) return;
        double dx = -(yy * gx - xy * gy) / determinant, dy = -(xx * gy - xy * gx) / determinant;
        for (int trial = 0; trial < kSweepTrials; ++trial, dx *= kShorten, dy *= kShorten) {
            DilatationSpread::Value there;
            for (const Incidence* e = begin; e != end; ++e) {
                const SpreadSample& s = samples[e->sample];
                const double a = dx * e->h_re, b = dy * e->h_im, c = dx * e->h_im, d = dy * e->h_re;
                there += spread_value(s, k, outlier_penalty, s.p_re + (a + b), s.p_im + (d - c), s.q_re + (a - b),
                                      s.q_im + (c + d));
            }
            if (!there.improves(before)) continue;
            for (const Incidence* e = begin; e != end; ++e) {
                SpreadSample& s = samples[e->sample];
                const double a = dx * e->h_re, b = dy * e->h_im, c = dx * e->h_im, d = dy * e->h_re;
                s.p_re += a + b;
                s.p_im += d - c;
                s.q_re += a - b;
                s.q_im += c + d;
            }
            f[vertices_[i]] += Complex(dx, dy);
            return;
        }
    };
    for (int sweep = 0; sweep < sweeps; ++sweep)
        for (int c = 0; c < colour_count(); ++c)
            parallel_for(
                colours_[c], colours_[c + 1],
                [&](int first, int last) {
                    for (int i = first; i < last; ++i) move(i);
                },
                kGrain);
    spread.set_map(f);  // without the rounding that updates have gathered
}

}  // namespace beltrami
