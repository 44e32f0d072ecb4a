#pragma once

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <initializer_list>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include <unistd.h>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <beltrami/base/error.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami::io_tests {

/// A new empty folder that goes with the test.
class TemporaryFolder {
  public:
    TemporaryFolder()
        : path_(std::filesystem::temp_directory_path() / fmt::format("beltrami-test-{:x}", std::random_device()())) {
        std::filesystem::create_directory(path_);
        std::filesystem::permissions(path_, std::filesystem::perms::all);  // see expect_no_permission
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder() { std::filesystem::remove_all(path_); }

    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    /// Number of entries, hidden ones too.
    std::ptrdiff_t entry_count() const {
        return std::distance(std::filesystem::directory_iterator(path_), std::filesystem::directory_iterator());
    }

  private:
    std::filesystem::path path_;
};

inline void put(const std::filesystem::path& path, std::string_view bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

inline std::string get(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// The call must throw an Error of this cause whose text holds this part.
inline void expect_error(Cause cause, const std::string& part, const std::function<void()>& call) {
    try {
        call();
        ADD_FAILURE() << "no error, though one with '" << part << "' was due";
    } catch (const Error& error) {
        EXPECT_EQ(error.cause(), cause) << error.what();
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
}

/// Runs the call in a child process without the powers of root; it must throw an Error of this cause that speaks of
/// permission.
inline void expect_no_permission(Cause cause, const std::function<void()>& call) {
    EXPECT_EXIT(
        {
            if (::geteuid() == 0 && ::setuid(65534) != 0) std::_Exit(1);
            try {
                call();
            } catch (const Error& error) {
                const bool says_why = std::string(error.what()).find("Permission denied") != std::string::npos;
                std::_Exit(error.cause() == cause && says_why ? 7 : 2);
            }
            std::_Exit(3);
        },
        testing::ExitedWithCode(7), "");
}

/// Same shape and the same bits, so that NaN equals NaN and −0 differs from 0.
inline void expect_same_bits(const Positions& a, const Positions& b) {
    ASSERT_EQ(a.rows(), b.rows());
    ASSERT_EQ(a.cols(), b.cols());
    EXPECT_EQ(std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())), 0)
        << a << "\nversus\n"
        << b;
}

inline void expect_same(const Mesh& a, const Mesh& b) {
    expect_same_bits(a.positions, b.positions);
    EXPECT_TRUE(a.faces == b.faces);
    ASSERT_EQ(a.texture.has_value(), b.texture.has_value());
    if (a.texture) {
        expect_same_bits(a.texture->points, b.texture->points);
        EXPECT_EQ(a.texture->corners, b.texture->corners);
    }
}

inline std::vector<int> corners_of(const Mesh& mesh, int face) {
    return {mesh.faces[face].begin(), mesh.faces[face].end()};
}

inline Positions rows(std::initializer_list<std::initializer_list<double>> values) {
    return Positions(values);
}

}  // namespace beltrami::io_tests
