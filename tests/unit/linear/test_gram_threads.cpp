#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include <beltrami/base/parallel.h>
#include <beltrami/base/random.h>
#include <beltrami/linear/dense.h>

namespace beltrami {
namespace {

Eigen::MatrixXd random_matrix(Random& random, int rows, int columns) {
    Eigen::MatrixXd result(rows, columns);
    for (double& value : result.reshaped()) value = random.uniform(-1, 1);
    return result;
}

/// Numbers of rows and columns around the sizes of tiles, tasks and chunks.
TEST(GramOnThreads, IsTheProductWithTheSameBytesOnAnyNumberOfThreads) {
    Random random(5);
    const int threads = thread_count();
    for (const int columns : {1, 3, 4, 5, 16, 17, 37, 130})
        for (const int rows : {1, 7, 8, 513, 1024, 1500}) {
            const Eigen::MatrixXd A = random_matrix(random, rows, columns);
            set_thread_count(1);
            const Eigen::MatrixXd one = gram_lower(A);
            set_thread_count(3);
            EXPECT_EQ(gram_lower(A), one);
            const Eigen::MatrixXd exact = (A.transpose() * A).triangularView<Eigen::Lower>();
            EXPECT_LT((one - exact).cwiseAbs().maxCoeff(), 1e-14 * rows) << rows << " x " << columns;
        }
    set_thread_count(threads);
}

// Two calls at once spoiled each other's products in a BLAS without locks.
TEST(GramOnThreads, ComplexProductsOfSeveralThreadsAreThoseOfOne) {
    Random random(6);
    Eigen::MatrixXcd A(700, 220);
    A.real() = random_matrix(random, 700, 220);
    A.imag() = random_matrix(random, 700, 220);
    const Eigen::MatrixXcd B = A.topRows(220), gram = complex_gram_upper(A), product = complex_product(A, B);
    std::vector<int> wrong(2, 0);
    std::vector<std::thread> threads;
    for (int t = 0; t < 2; ++t)
        threads.emplace_back([&, t] {
            for (int i = 0; i < 40; ++i) wrong[t] += complex_gram_upper(A) != gram || complex_product(A, B) != product;
        });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(wrong[0] + wrong[1], 0);
}

}  // namespace
}  // namespace beltrami
