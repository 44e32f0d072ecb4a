#include <csignal>
#include <cstdlib>

#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <beltrami/io/atomic_file.h>

#include "support.h"

namespace beltrami::io_tests {

TEST(AtomicFile, AppearsOnlyWithCommit) {
    const TemporaryFolder folder;
    put(folder / "a.txt", "old");
    {
        AtomicFile file(folder / "a.txt");
        file.write("new ");
        file.write("text");
        EXPECT_EQ(get(folder / "a.txt"), "old");
        EXPECT_EQ(folder.entry_count(), 2);
        file.commit(AtomicFile::Durability::synced);
        EXPECT_EQ(get(folder / "a.txt"), "new text");
    }
    EXPECT_EQ(get(folder / "a.txt"), "new text");
    EXPECT_EQ(folder.entry_count(), 1);
}

TEST(AtomicFile, LeavesNothingBehindWithoutCommit) {
    const TemporaryFolder folder;
    {
        AtomicFile file(folder / "a.txt");
        file.write("text");
        EXPECT_EQ(folder.entry_count(), 1);
    }
    EXPECT_EQ(folder.entry_count(), 0);
    try {
        AtomicFile file(folder / "a.txt");
        throw 1;
    } catch (int) {
    }
    EXPECT_EQ(folder.entry_count(), 0);
}

TEST(AtomicFile, KeepsPermissionsAndFollowsLinks) {
    const TemporaryFolder folder;
    put(folder / "a.txt", "old");
    ASSERT_EQ(::chmod((folder / "a.txt").c_str(), 0640), 0);
    std::filesystem::create_symlink("a.txt", folder / "link.txt");
    write_atomically(folder / "link.txt", "new");
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.txt"));
    EXPECT_EQ(get(folder / "a.txt"), "new");
    EXPECT_EQ(static_cast<int>(std::filesystem::status(folder / "a.txt").permissions()), 0640);
    const mode_t mask = ::umask(027);
    write_atomically(folder / "b.txt", "new");
    ::umask(mask);
    EXPECT_EQ(static_cast<int>(std::filesystem::status(folder / "b.txt").permissions()), 0640);
}

TEST(AtomicFile, SurvivesAChangeOfFolder) {
    const TemporaryFolder folder;
    const std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::create_directory(folder / "sub");
    std::filesystem::current_path(folder / "sub");
    {
        AtomicFile file("a.txt");
        std::filesystem::current_path(before);
        file.write("text");
        file.commit();
    }
    EXPECT_EQ(get(folder / "sub/a.txt"), "text");
}

TEST(AtomicFile, SaysWhyAPlaceCannotBeWritten) {
    const TemporaryFolder folder;
    const auto expect_refusal = [](const std::string& part, const std::filesystem::path& path) {
        expect_error(Cause::unwritable, part, [&] { write_atomically(path, "text"); });
    };
    expect_refusal("No such file or directory: create the folder first", folder / "missing/a.txt");
    std::filesystem::create_directory(folder / "sub");
    expect_refusal("Is a directory", folder / "sub");
    put(folder / "file", "");
    expect_refusal("Not a directory", folder / "file/a.txt");
    expect_refusal("cannot write", "");
    expect_refusal("File name too long", folder / std::string(300, 'x'));
    std::filesystem::create_symlink("loop", folder / "loop");
    expect_refusal("Too many levels of symbolic links", folder / "loop");
    EXPECT_EQ(folder.entry_count(), 3);
}

TEST(AtomicFile, RespectsPermissions) {
    const TemporaryFolder folder;
    put(folder / "a.txt", "old");
    ASSERT_EQ(::chmod((folder / "a.txt").c_str(), 0444), 0);
    expect_no_permission(Cause::unwritable, [&] { write_atomically(folder / "a.txt", "new"); });
    std::filesystem::create_directory(folder / "sub");
    ASSERT_EQ(::chmod((folder / "sub").c_str(), 0555), 0);
    expect_no_permission(Cause::unwritable, [&] { write_atomically(folder / "sub/a.txt", "new"); });
    EXPECT_TRUE(std::filesystem::is_empty(folder / "sub"));
    EXPECT_EQ(get(folder / "a.txt"), "old");
}

TEST(AtomicFile, FullDiskIsAnErrorAndADeviceIsNotReplaced) {
    expect_error(Cause::unwritable, "No space left on device: make room",
                 [] { write_atomically("/dev/full", "text"); });
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
    write_atomically("/dev/null", "text");
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST(AtomicFile, FailureInTheMiddleOfWritingRemovesTheTemporary) {
    const TemporaryFolder folder;
    put(folder / "a.txt", "old");
    EXPECT_EXIT(
        {
            std::signal(SIGXFSZ, SIG_IGN);
            rlimit limit;
            limit.rlim_cur = limit.rlim_max = 100000;
            ::setrlimit(RLIMIT_FSIZE, &limit);
            try {
                write_atomically(folder / "a.txt", std::string(1000000, 'x'));
            } catch (const Error& error) {
                std::_Exit(error.cause() == Cause::unwritable ? 7 : 8);
            }
            std::_Exit(9);
        },
        testing::ExitedWithCode(7), "");
    EXPECT_EQ(folder.entry_count(), 1);
    EXPECT_EQ(get(folder / "a.txt"), "old");
}

TEST(AtomicFile, SignalHandlerRemovesWhatIsUnfinishedOnly) {
    const TemporaryFolder folder;
    EXPECT_EXIT(
        {
            std::signal(SIGINT, [](int) {
                remove_temporaries_from_signal_handler();
                std::_Exit(7);
            });
            AtomicFile done(folder / "done.txt");
            done.commit();
            AtomicFile first(folder / "a.txt");
            AtomicFile second(folder / "b.txt");
            second.write("text");
            std::raise(SIGINT);
        },
        testing::ExitedWithCode(7), "");
    EXPECT_EQ(folder.entry_count(), 1);
    EXPECT_TRUE(std::filesystem::exists(folder / "done.txt"));
}

TEST(AtomicFile, RegistryIsUsedAgainAndMayOverflow) {
    const TemporaryFolder folder;
    for (int round = 0; round < 3; ++round) {
        std::vector<std::unique_ptr<AtomicFile>> files;
        for (int i = 0; i < 70; ++i) files.push_back(std::make_unique<AtomicFile>(folder / std::to_string(i)));
        EXPECT_EQ(folder.entry_count(), 70);
        remove_temporaries_from_signal_handler();
        EXPECT_EQ(folder.entry_count(), 6);  // those beyond the registry's 64
    }
    EXPECT_EQ(folder.entry_count(), 0);
}

}  // namespace beltrami::io_tests
