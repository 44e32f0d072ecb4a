#include <beltrami/differentials/pole_sums.h>

#include <algorithm>
#include <cstdlib>

#include <beltrami/base/parallel.h>
#include <beltrami/base/vector_clones.h>

namespace beltrami {

namespace {

/// Points worked through at a time: their values stay in the first cache.
constexpr int kBlock = 256;
/// Points of a thread's chunk.
constexpr int kGrain = 4 * kBlock;
/// Numbers that a vector unit works on at once, and so many vectors of a block.
constexpr int kLanes = 8, kVectors = kBlock / kLanes;
using Lanes = double __attribute__((vector_size(8 * kLanes)));

/// Real and imaginary parts of a block of points or values.
struct Block {
    alignas(64) Lanes re[kVectors];
    alignas(64) Lanes im[kVectors];
    void set(int i, Complex value) {
        re[i / kLanes][i % kLanes] = value.real();
        im[i / kLanes][i % kLanes] = value.imag();
    }
    Complex get(int i) const { return {re[i / kLanes][i % kLanes], im[i / kLanes][i % kLanes]}; }
    void fill(Complex value) {
        for (int i = 0; i < kBlock; ++i) set(i, value);
    }
};

/// Whether a pole is the next power of the one before.
bool follows(const std::vector<Pole>& poles, std::size_t j) {
    return j > 0 && poles[j - 1].centre == poles[j].centre && poles[j - 1].scale == poles[j].scale &&
           poles[j - 1].power * poles[j].power >= 0 && std::abs(poles[j - 1].power) == std::abs(poles[j].power) - 1;
}

void load(const Eigen::VectorXcd& z, int first, int count, Block& to) {
    for (int i = 0; i < count; ++i) to.set(i, z[first + i]);
    // The rest of the block is computed with but not used.
    for (int i = count; i < kBlock; ++i) to.set(i, z[first]);
}

/// Vectors that share a division: 1/a and 1/b are b/(ab) and a/(ab), which costs less than two divisions.
constexpr int kShared = 4;

/// 1/a for every one of them.
inline __attribute__((always_inline)) void invert(Lanes a[kShared]) {
    const Lanes first = a[0] * a[1], second = a[2] * a[3], all = 1 / (first * second);
    const Lanes of_first = all * second, of_second = all * first;
    const Lanes inverse[kShared] = {of_first * a[1], of_first * a[0], of_second * a[3], of_second * a[2]};
    for (int l = 0; l < kShared; ++l) a[l] = inverse[l];
}

/// scale/(z − centre).
BELTRAMI_VECTOR_CLONES
void reciprocal(const Block& z, double x, double y, double scale, Block& result) {
    for (int i = 0; i < kVectors; i += kShared) {
        Lanes dx[kShared], dy[kShared], square[kShared];
        for (int l = 0; l < kShared; ++l) {
            dx[l] = z.re[i + l] - x;
            dy[l] = z.im[i + l] - y;
            square[l] = dx[l] * dx[l] + dy[l] * dy[l];
        }
        invert(square);
        for (int l = 0; l < kShared; ++l) {
            const Lanes size = scale * square[l];
            result.re[i + l] = dx[l] * size;
            result.im[i + l] = -dy[l] * size;
        }
    }
}

BELTRAMI_VECTOR_CLONES
void multiply(Block& a, const Block& b) {
    for (int i = 0; i < kVectors; ++i) {
        const Lanes re = a.re[i] * b.re[i] - a.im[i] * b.im[i];
        a.im[i] = a.re[i] * b.im[i] + a.im[i] * b.re[i];
        a.re[i] = re;
    }
}

BELTRAMI_VECTOR_CLONES
void add_multiple(const Block& value, double x, double y, Block& sum) {
    for (int i = 0; i < kVectors; ++i) {
        sum.re[i] += x * value.re[i] - y * value.im[i];
        sum.im[i] += y * value.re[i] + x * value.im[i];
    }
}

/// Adds x + iy times 1/(z − centre).
BELTRAMI_VECTOR_CLONES
void add_reciprocal(const Block& z, double centre_x, double centre_y, double x, double y, Block& sum) {
    for (int i = 0; i < kVectors; i += kShared) {
        Lanes dx[kShared], dy[kShared], square[kShared];
        for (int l = 0; l < kShared; ++l) {
            dx[l] = z.re[i + l] - centre_x;
            dy[l] = z.im[i + l] - centre_y;
            square[l] = dx[l] * dx[l] + dy[l] * dy[l];
        }
        invert(square);
        for (int l = 0; l < kShared; ++l) {
            sum.re[i + l] += square[l] * (x * dx[l] + y * dy[l]);
            sum.im[i + l] += square[l] * (y * dx[l] - x * dy[l]);
        }
    }
}

/// Sums of one kind that are gathered side by side, so that none waits for another.
constexpr int kSideBySide = 2;

/// Adds Σ w v to re + i im.
BELTRAMI_VECTOR_CLONES
void dot(const Block& value, const Block& weight, double* re, double* im) {
    Lanes re_re[kSideBySide] = {}, im_im[kSideBySide] = {}, re_im[kSideBySide] = {}, im_re[kSideBySide] = {};
    for (int i = 0; i < kVectors; i += kSideBySide)
        for (int l = 0; l < kSideBySide; ++l) {
            re_re[l] += value.re[i + l] * weight.re[i + l];
            im_im[l] += value.im[i + l] * weight.im[i + l];
            re_im[l] += value.re[i + l] * weight.im[i + l];
            im_re[l] += value.im[i + l] * weight.re[i + l];
        }
    const Lanes real = (re_re[0] + re_re[1]) - (im_im[0] + im_im[1]),
                imaginary = (re_im[0] + re_im[1]) + (im_re[0] + im_re[1]);
    for (int l = 0; l < kLanes; ++l) {
        *re += real[l];
        *im += imaginary[l];
    }
}

/// (z − centre)/scale.
void shifted(const Block& z, Complex centre, double scale, Block& result) {
    const double factor = 1 / scale;
    for (int i = 0; i < kVectors; ++i) {
        result.re[i] = (z.re[i] - centre.real()) * factor;
        result.im[i] = (z.im[i] - centre.imag()) * factor;
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
            shifted(z, pole.centre, pole.scale, base);
            value.fill(1.0);
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
                sum.fill(0.0);
                visit_values(others, at, [&](std::size_t j, const Block& value) {
                    add_multiple(value, of_others[j].real(), of_others[j].imag(), sum);
                });
                for (std::size_t j = 0; j < simple.size(); ++j) {
                    const Complex c = of_simple[j] * simple[j].scale;
                    add_reciprocal(at, simple[j].centre.real(), simple[j].centre.imag(), c.real(), c.imag(), sum);
                }
                for (int i = 0; i < count; ++i) result[first + i] = sum.get(i);
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
                    w.fill(0.0);
                    for (int i = 0; i < count; ++i) w.set(i, weights(first + i, c));
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
                    for (int i = 0; i < count; ++i) to[i] = value.get(i);
                });
            }
        },
        kGrain);
    return result;
}

}  // namespace beltrami
