#include <beltrami/differentials/pole_sums.h>

#include <algorithm>
#include <cstdlib>

#include <beltrami/mesh/parallel.h>

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define BELTRAMI_VECTOR_CLONES __attribute__((target_clones("arch=skylake-avx512", "arch=haswell", "default")))
#else
#define BELTRAMI_VECTOR_CLONES
#endif

namespace beltrami {

namespace {

/// Points worked through at a time: their values stay in the first cache.
constexpr int kBlock = 256;
/// Points of a thread's chunk.
constexpr int kGrain = 4 * kBlock;
/// Sums are gathered in so many parts, which a vector unit adds at once.
constexpr int kLanes = 8;

/// Real and imaginary parts of a block of points or values.
struct Block {
    alignas(64) double re[kBlock];
    alignas(64) double im[kBlock];
};

/// Whether a pole is the next power of the one before.
bool follows(const std::vector<Pole>& poles, std::size_t j) {
    return j > 0 && poles[j - 1].centre == poles[j].centre && poles[j - 1].scale == poles[j].scale &&
           poles[j - 1].power * poles[j].power >= 0 && std::abs(poles[j - 1].power) == std::abs(poles[j].power) - 1;
}

void load(const Eigen::VectorXcd& z, int first, int count, Block& to) {
    for (int i = 0; i < count; ++i) {
        to.re[i] = z[first + i].real();
        to.im[i] = z[first + i].imag();
    }
    // The rest of the block is computed with but not used.
    for (int i = count; i < kBlock; ++i) {
        to.re[i] = z[first].real();
        to.im[i] = z[first].imag();
    }
}

/// scale/(z − centre).
BELTRAMI_VECTOR_CLONES
void reciprocal(const Block& z, double x, double y, double scale, Block& result) {
    for (int i = 0; i < kBlock; ++i) {
        const double dx = z.re[i] - x, dy = z.im[i] - y, size = scale / (dx * dx + dy * dy);
        result.re[i] = dx * size;
        result.im[i] = -dy * size;
    }
}

BELTRAMI_VECTOR_CLONES
void multiply(Block& a, const Block& b) {
    for (int i = 0; i < kBlock; ++i) {
        const double re = a.re[i] * b.re[i] - a.im[i] * b.im[i];
        a.im[i] = a.re[i] * b.im[i] + a.im[i] * b.re[i];
        a.re[i] = re;
    }
}

BELTRAMI_VECTOR_CLONES
void add_multiple(const Block& value, double x, double y, Block& sum) {
    for (int i = 0; i < kBlock; ++i) {
        sum.re[i] += x * value.re[i] - y * value.im[i];
        sum.im[i] += y * value.re[i] + x * value.im[i];
    }
}

/// Adds x + iy times scale/(z − centre).
BELTRAMI_VECTOR_CLONES
void add_reciprocal(const Block& z, double centre_x, double centre_y, double x, double y, Block& sum) {
    for (int i = 0; i < kBlock; ++i) {
        const double dx = z.re[i] - centre_x, dy = z.im[i] - centre_y, size = 1 / (dx * dx + dy * dy);
        sum.re[i] += size * (x * dx + y * dy);
        sum.im[i] += size * (y * dx - x * dy);
    }
}

/// Σ w v in lanes: re, im.
BELTRAMI_VECTOR_CLONES
void dot(const Block& value, const Block& weight, double* re, double* im) {
    double re_re[kLanes] = {}, im_im[kLanes] = {}, re_im[kLanes] = {}, im_re[kLanes] = {};
    for (int i = 0; i < kBlock; i += kLanes)
        for (int l = 0; l < kLanes; ++l) {
            re_re[l] += value.re[i + l] * weight.re[i + l];
            im_im[l] += value.im[i + l] * weight.im[i + l];
            re_im[l] += value.re[i + l] * weight.im[i + l];
            im_re[l] += value.im[i + l] * weight.re[i + l];
        }
    for (int l = 0; l < kLanes; ++l) {
        *re += re_re[l] - im_im[l];
        *im += re_im[l] + im_re[l];
    }
}

/// Calls visit(j, values) for every pole in turn.
template <class Visit>
void visit_values(const std::vector<Pole>& poles, const Block& z, Visit&& visit) {
    Block base, value;
    for (std::size_t j = 0; j < poles.size(); ++j) {
        const Pole& pole = poles[j];
        if (follows(poles, j) && std::abs(pole.power) > 1) {
            multiply(value, base);
        } else if (pole.power > 0) {
            reciprocal(z, pole.centre.real(), pole.centre.imag(), pole.scale, base);
            value = base;
            for (int i = 1; i < pole.power; ++i) multiply(value, base);
        } else {
            for (int i = 0; i < kBlock; ++i) {
                base.re[i] = (z.re[i] - pole.centre.real()) / pole.scale;
                base.im[i] = (z.im[i] - pole.centre.imag()) / pole.scale;
            }
            std::fill_n(value.re, kBlock, 1.0);
            std::fill_n(value.im, kBlock, 0.0);
            for (int i = 0; i < -pole.power; ++i) multiply(value, base);
        }
        visit(j, value);
    }
}

/// Whether a pole is simple and no powers of it are wanted.
bool alone(const std::vector<Pole>& poles, std::size_t j) {
    return poles[j].power == 1 && !(j + 1 < poles.size() && follows(poles, j + 1));
}

}  // namespace

Eigen::VectorXcd pole_combination(const std::vector<Pole>& poles, const Eigen::VectorXcd& z,
                                  const Eigen::VectorXcd& coefficients) {
    std::vector<Pole> others, simple;
    std::vector<Complex> of_others, of_simple;
    for (std::size_t j = 0; j < poles.size(); ++j) {
        (alone(poles, j) ? simple : others).push_back(poles[j]);
        (alone(poles, j) ? of_simple : of_others).push_back(coefficients[static_cast<Eigen::Index>(j)]);
    }
    Eigen::VectorXcd result(z.size());
    parallel_for(
        0, static_cast<int>(z.size()),
        [&](int begin, int end) {
            Block at, sum;
            for (int first = begin; first < end; first += kBlock) {
                const int count = std::min(kBlock, end - first);
                load(z, first, count, at);
                std::fill_n(sum.re, kBlock, 0.0);
                std::fill_n(sum.im, kBlock, 0.0);
                visit_values(others, at, [&](std::size_t j, const Block& value) {
                    add_multiple(value, of_others[j].real(), of_others[j].imag(), sum);
                });
                for (std::size_t j = 0; j < simple.size(); ++j) {
                    const Complex c = of_simple[j] * simple[j].scale;
                    add_reciprocal(at, simple[j].centre.real(), simple[j].centre.imag(), c.real(), c.imag(), sum);
                }
                for (int i = 0; i < count; ++i) result[first + i] = {sum.re[i], sum.im[i]};
            }
        },
        kGrain);
    return result;
}

Eigen::MatrixXcd pole_pairing(const std::vector<Pole>& poles, const Eigen::VectorXcd& z,
                              const Eigen::MatrixXcd& weights) {
    const Eigen::Index columns = weights.cols();
    const Eigen::MatrixXcd zero = Eigen::MatrixXcd::Zero(static_cast<Eigen::Index>(poles.size()), columns);
    return parallel_sum<Eigen::MatrixXcd>(
        static_cast<int>(z.size()), zero,
        [&](int begin, int end) {
            Eigen::MatrixXcd sum = zero;
            Block at;
            std::vector<Block> by(static_cast<std::size_t>(columns));
            for (int first = begin; first < end; first += kBlock) {
                const int count = std::min(kBlock, end - first);
                load(z, first, count, at);
                for (Eigen::Index c = 0; c < columns; ++c) {
                    Block& w = by[static_cast<std::size_t>(c)];
                    std::fill_n(w.re, kBlock, 0.0);
                    std::fill_n(w.im, kBlock, 0.0);
                    for (int i = 0; i < count; ++i) {
                        w.re[i] = weights(first + i, c).real();
                        w.im[i] = weights(first + i, c).imag();
                    }
                }
                visit_values(poles, at, [&](std::size_t j, const Block& value) {
                    for (Eigen::Index c = 0; c < columns; ++c) {
                        double re = 0, im = 0;
                        dot(value, by[static_cast<std::size_t>(c)], &re, &im);
                        sum(static_cast<Eigen::Index>(j), c) += Complex(re, im);
                    }
                });
            }
            return sum;
        },
        kGrain);
}

Eigen::MatrixXcd pole_values(const std::vector<Pole>& poles, const Eigen::VectorXcd& z) {
    Eigen::MatrixXcd result(z.size(), static_cast<Eigen::Index>(poles.size()));
    parallel_for(
        0, static_cast<int>(z.size()),
        [&](int begin, int end) {
            Block at;
            for (int first = begin; first < end; first += kBlock) {
                const int count = std::min(kBlock, end - first);
                load(z, first, count, at);
                visit_values(poles, at, [&](std::size_t j, const Block& value) {
                    Complex* const to = &result(first, static_cast<Eigen::Index>(j));
                    for (int i = 0; i < count; ++i) to[i] = {value.re[i], value.im[i]};
                });
            }
        },
        kGrain);
    return result;
}

}  // namespace beltrami
