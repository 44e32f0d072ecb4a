#include <chrono>
#include <cstdlib>

#include <sys/resource.h>

#include <beltrami/io/read_mesh.h>
#include <beltrami/io/write_mesh.h>

#include "support.h"

namespace beltrami::io_tests {

namespace {

using Reader = LoadedMesh (*)(std::string_view, const std::string&);

struct Format {
    const char* name;
    Reader read;
};
constexpr Format formats[]{{"obj", &read_obj}, {"ply", &read_ply}, {"off", &read_off}, {"stl", &read_stl}};

/// Whether the reader takes the bytes; any exception but a proper Error fails the test.
bool is_read(Reader read, std::string_view bytes) {
    // A copy of exactly this size, so that a sanitizer sees a read past the end.
    const std::vector<char> exact(bytes.begin(), bytes.end());
    try {
        const LoadedMesh loaded = read({exact.data(), exact.size()}, "t");
        const Mesh& mesh = loaded.mesh;
        for (const int vertex : mesh.faces.vertices()) {
            EXPECT_TRUE(vertex >= 0 && vertex < mesh.vertex_count());
        }
        for (int face = 0; face < mesh.face_count(); ++face) {
            EXPECT_TRUE(mesh.faces.degree(face) == 3 || mesh.faces.degree(face) == 4);
        }
        if (mesh.texture) {
            EXPECT_EQ(mesh.texture->corners.size(), mesh.faces.vertices().size());
            for (const int point : mesh.texture->corners) EXPECT_LT(point, mesh.texture->points.rows());
        }
        return true;
    } catch (const Error& error) {
        EXPECT_EQ(error.cause(), Cause::unreadable);
        return false;
    }
}

/// The valid files of the corpus.
std::vector<std::pair<Format, std::string>> corpus(bool only_valid) {
    std::vector<std::pair<Format, std::string>> files;
    for (const Format& format : formats) {
        for (const auto& entry :
             std::filesystem::directory_iterator(std::filesystem::path(BELTRAMI_FUZZ_CORPUS) / format.name)) {
            const bool valid = entry.path().filename().string().starts_with("valid");
            if (valid || !only_valid) files.emplace_back(format, entry.path().string());
        }
    }
    return files;
}

}  // namespace

TEST(HostileFiles, CorpusIsReadOrRefusedAsItsNamesSay) {
    const auto files = corpus(false);
    EXPECT_GE(files.size(), 40U);
    for (const auto& [format, path] : files) {
        SCOPED_TRACE(path);
        const std::string name = std::filesystem::path(path).filename().string();
        ASSERT_TRUE(name.starts_with("valid") || name.starts_with("bad"));
        EXPECT_EQ(is_read(format.read, get(path)), name.starts_with("valid"));
    }
}

TEST(HostileFiles, AFileCutAnywhereIsReadOrRefused) {
    for (const auto& [format, path] : corpus(true)) {
        SCOPED_TRACE(path);
        const std::string bytes = get(path);
        ASSERT_LE(bytes.size(), 2000U);
        for (std::size_t size = 0; size < bytes.size(); ++size) {
            is_read(format.read, std::string_view(bytes).substr(0, size));
            is_read(format.read, std::string_view(bytes).substr(size));
        }
    }
}

TEST(HostileFiles, AnyByteMayBeWrong) {
    for (const auto& [format, path] : corpus(true)) {
        SCOPED_TRACE(path);
        const std::string bytes = get(path);
        for (std::size_t at = 0; at < bytes.size(); ++at) {
            for (const char wrong : {'\0', '\xFF', '\n', '9', '-', ' '}) {
                std::string changed = bytes;
                changed[at] = wrong;
                is_read(format.read, changed);
            }
        }
    }
}

TEST(HostileFiles, FilesOfOneFormatAreNoneOfAnother) {
    for (const auto& [format, path] : corpus(true)) {
        SCOPED_TRACE(path);
        for (const Format& other : formats) {
            if (other.name == format.name) continue;
            EXPECT_FALSE(is_read(other.read, get(path))) << other.name;
        }
    }
}

TEST(HostileFiles, FalseCountsTakeNoMemory) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || defined(__clang__)  // clang hides its sanitizers
    GTEST_SKIP() << "a sanitizer needs more address space than this test leaves";
#endif
    const std::pair<Reader, std::string> files[]{
        {&read_off, "OFF\n2000000000 1 0\n0 0 0\n"},
        {&read_off, "OFF\n1 2000000000 0\n0 0 0\n"},
        {&read_off, "OFF\n1 1 0\n0 0 0\n2000000000 0 0 0\n"},
        {&read_off, "OFF\n9223372036854775807 9223372036854775807 0\n"},
        {&read_ply,
         "ply\nformat ascii 1.0\nelement vertex 2000000000\nproperty float x\nproperty float y\nend_header\n0 0\n"},
        {&read_ply,
         "ply\nformat binary_little_endian 1.0\nelement vertex 2000000000\nproperty float x\nproperty float "
         "y\nend_header\n"},
        {&read_ply,
         "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty uchar x\nproperty uchar y\nelement face 1\n"
         "property list uint uchar vertex_indices\nend_header\n" +
             std::string(2, '\0') + "\xFF\xFF\xFF\xFF"},
        {&read_stl, std::string(80, ' ') + "\xFF\xFF\xFF\xFF" + std::string(50, '\0')},
        {&read_obj, "v 0 0 0\nf 2147483647 2147483647 2147483647\n"},
    };
    EXPECT_EXIT(
        {
            rlimit limit;
            limit.rlim_cur = limit.rlim_max = 256U << 20;
            ::setrlimit(RLIMIT_AS, &limit);
            for (const auto& [read, bytes] : files) {
                try {
                    read(bytes, "t");
                    std::_Exit(1);
                } catch (const Error&) {
                }
            }
            std::_Exit(7);
        },
        testing::ExitedWithCode(7), "");
}

TEST(HostileFiles, TimeGrowsWithTheSizeOnly) {
    // A megabyte or so each of what invites quadratic work; done in milliseconds, minutes if it were quadratic.
    std::string forward = "v 0 0 0\n";
    std::string continued = "v 0 0 0\nf";
    std::string large = "v 0 0 0\n";
    for (int i = 0; i < 100000; ++i) {
        forward += "f 9 9 9\n";
        continued += " \\\n1";
        large += "f 1 1 1 1 1\n";
    }
    std::string elements = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n";
    for (int i = 0; i < 100000; ++i) elements += "property float p\n";
    for (int i = 0; i < 100000; ++i) elements += fmt::format("element e{} 0\n", i);
    elements += "end_header\n";
    std::string comb = "solid\n";
    for (int i = 0; i < 30000; ++i) {
        comb += fmt::format("facet\nouter loop\nvertex {} 0 0\nvertex 0 0 0\nvertex 0 {} 0\nendloop\nendfacet\n", i, i);
    }
    const auto start = std::chrono::steady_clock::now();
    EXPECT_FALSE(is_read(&read_obj, forward));
    EXPECT_TRUE(is_read(&read_obj, continued));
    EXPECT_TRUE(is_read(&read_obj, large));
    EXPECT_TRUE(is_read(&read_obj, "v 0 0 0\n#" + std::string(1000000, '\\') + "\n" + std::string(1000000, '\n')));
    EXPECT_FALSE(is_read(&read_ply, elements));
    EXPECT_TRUE(is_read(&read_stl, comb + "endsolid\n"));
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
}

}  // namespace beltrami::io_tests
