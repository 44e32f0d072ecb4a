#include <cstdlib>
#include <sstream>
#include <thread>

#include <sys/stat.h>

#include <beltrami/io/number_lists.h>
#include <beltrami/io/read_mesh.h>

#include "support.h"

namespace beltrami::io_tests {

TEST(ReadMesh, DispatchesByExtensionInEitherCase) {
    const TemporaryFolder folder;
    const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    put(folder / "a.obj", triangle);
    put(folder / "a.b.OBJ", triangle);
    put(folder / "a.Off", "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    for (const char* name : {"a.obj", "a.b.OBJ", "a.Off"}) EXPECT_EQ(read_mesh(folder / name).mesh.face_count(), 1);
}

TEST(ReadMesh, RefusesWhatIsNoReadableFile) {
    const TemporaryFolder folder;
    const auto expect_refusal = [](const std::string& part, const std::filesystem::path& path) {
        expect_error(Cause::unreadable, part, [&] { read_mesh(path); });
    };
    expect_refusal("there is no such file", folder / "missing.obj");
    expect_refusal("the extension '.stp' is none of", folder / "a.stp");
    expect_refusal("the extension '' is none of", folder / "obj");
    std::filesystem::create_directory(folder / "folder.obj");
    expect_refusal("it is a folder", folder / "folder.obj");
    std::filesystem::create_symlink("/dev/zero", folder / "endless.obj");
    expect_refusal("neither a regular file nor a pipe", folder / "endless.obj");
    std::filesystem::create_symlink("loop.obj", folder / "loop.obj");
    expect_refusal("cannot read", folder / "loop.obj");
    put(folder / "empty.obj", "");
    expect_refusal("empty.obj: the file holds no vertex", folder / "empty.obj");
    put(folder / "secret.obj", "v 0 0 0\n");
    ASSERT_EQ(::chmod((folder / "secret.obj").c_str(), 0), 0);
    expect_no_permission(Cause::unreadable, [&] { read_mesh(folder / "secret.obj"); });
}

TEST(ReadMesh, ReadsAPipe) {
    const TemporaryFolder folder;
    const std::string path = folder / "pipe.obj";
    ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
    std::thread writer([&] { put(path, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"); });
    const int faces = read_mesh(path).mesh.face_count();
    writer.join();
    EXPECT_EQ(faces, 1);
}

TEST(ReadMesh, SharedMeshesHaveTheCountsTheyAreListedWith) {
    const char* folder = std::getenv("BELTRAMI_TEST_MESHES");
    if (!folder || !std::filesystem::exists(folder)) GTEST_SKIP() << "BELTRAMI_TEST_MESHES names no folder of meshes";
    std::ifstream list(std::filesystem::path(folder) / "SOURCES.tsv");
    int read = 0;
    std::string line;
    std::getline(list, line);  // titles
    while (std::getline(list, line)) {
        std::istringstream fields(line);
        std::string name;
        int vertices = 0;
        int faces = 0;
        fields >> name >> vertices >> faces;
        SCOPED_TRACE(name);
        const LoadedMesh loaded = read_mesh(std::filesystem::path(folder) / name);
        EXPECT_EQ(loaded.mesh.vertex_count(), vertices);
        // Faces with more than four corners are cut, and said to be.
        if (loaded.warnings.empty()) {
            EXPECT_EQ(loaded.mesh.face_count(), faces);
        } else {
            EXPECT_GT(loaded.mesh.face_count(), faces);
            for (const Warning& warning : loaded.warnings)
                EXPECT_NE(warning.sentence.find("cut into"), std::string::npos) << warning.sentence;
        }
        ++read;
    }
    EXPECT_GE(read, 14);
}

TEST(NumberLists, ReadsRows) {
    const TemporaryFolder folder;
    put(folder / "pins.txt", "# vertex x y\n0 -6 -4\r\n\n  7 1e-3 +2.5 # comment\n12\t0 nan");
    const auto read = read_rows(folder / "pins.txt", 3, "a pin");
    ASSERT_EQ(read.size(), 3U);
    EXPECT_EQ(read[0], (std::vector<double>{0, -6, -4}));
    EXPECT_EQ(read[1], (std::vector<double>{7, 1e-3, 2.5}));

    const IndexedRows indexed = read_indexed_rows(folder / "pins.txt", 1, 13, 2, "a pin");
    EXPECT_EQ(indexed.indices, (Eigen::Matrix<int, 3, 1>(0, 7, 12)));
    expect_same_bits(indexed.values.topRows(2), rows({{-6, -4}, {1e-3, 2.5}}));

    put(folder / "empty.txt", "# nothing\n");
    EXPECT_TRUE(read_rows(folder / "empty.txt", 3, "a pin").empty());
    EXPECT_EQ(read_indexed_rows(folder / "empty.txt", 1, 13, 2, "a pin").indices.rows(), 0);
}

TEST(NumberLists, StarsAreLeftOpenWhereTheyMay) {
    const TemporaryFolder folder;
    put(folder / "pins.txt", "3 * 1.5\n4 -2 *  # the height is free\n");
    const IndexedRows read = read_indexed_rows(folder / "pins.txt", 1, 13, 2, "a pin", Stars::read_as_nan);
    ASSERT_EQ(read.indices.rows(), 2);
    EXPECT_TRUE(std::isnan(read.values(0, 0)));
    EXPECT_EQ(read.values(0, 1), 1.5);
    EXPECT_EQ(read.values(1, 0), -2);
    EXPECT_TRUE(std::isnan(read.values(1, 1)));
    for (const auto& [part, text] : std::vector<std::pair<std::string, std::string>>{
             {"pins.txt:1: '*5' is neither a number nor *", "3 *5 1\n"},
             {"pins.txt:1: '*' is not a number", "* 5 1\n"},
             {"pins.txt:2: a pin holds a value that is no number", "1 2 *\n3 nan 1\n"},
             {"pins.txt:1: the line ends", "3 *\n"},
             {"the line holds more", "3 * 1 *\n"}}) {
        put(folder / "pins.txt", text);
        expect_error(Cause::unreadable, part,
                     [&] { read_indexed_rows(folder / "pins.txt", 1, 13, 2, "a pin", Stars::read_as_nan); });
    }
    put(folder / "pins.txt", "3 * 1\n");
    expect_error(Cause::unreadable, "'*' is not a number",
                 [&] { read_indexed_rows(folder / "pins.txt", 1, 13, 2, "a pin"); });
}

TEST(NumberLists, ErrorsNameFileAndLine) {
    const TemporaryFolder folder;
    const auto expect_refusal = [&](const std::string& part, const std::string& text) {
        put(folder / "pins.txt", text);
        expect_error(Cause::unreadable, part, [&] { read_indexed_rows(folder / "pins.txt", 1, 10, 1, "a pin"); });
    };
    expect_refusal("pins.txt:2: the line ends where one of the 2 numbers of a pin should follow", "0 0\n1\n");
    expect_refusal("pins.txt:1: a pin has 2 numbers, the line holds more", "0 0 0\n");
    expect_refusal("pins.txt:3: 'x' is not a number", "#\n0 0\n1 x\n");
    expect_refusal("pins.txt:2: 10 of a pin is not an index from 0 to 9", "9 0\n10 0\n");
    expect_refusal("-1 of a pin is not an index", "-1 0\n");
    expect_refusal("1.5 of a pin is not an index", "1.5 0\n");
    expect_refusal("nan of a pin is not an index", "nan 0\n");
    expect_refusal("1e+300 of a pin is not an index", "1e300 0\n");
    expect_error(Cause::unreadable, "no such file", [&] { read_rows(folder / "none.txt", 3, "a pin"); });
}

}  // namespace beltrami::io_tests
