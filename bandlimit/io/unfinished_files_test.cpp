// What is left of files when processes end before they are whole, and who removes it.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <set>
#include <thread>

#include "bandlimit/io/atomic_file.h"
#include "bandlimit/io/files_test.h"

namespace bandlimit {
namespace {

namespace fs = std::filesystem;

/// Dates a file back by so many seconds.
void make_old(const std::string& path, long seconds = 601) {
    const timespec then{::time(nullptr) - seconds, 0};
    const std::array<timespec, 2> times{then, then};
    ASSERT_EQ(::utimensat(AT_FDCWD, path.c_str(), times.data(), AT_SYMLINK_NOFOLLOW), 0) << path;
}

/// The one file in a folder.
std::string only_file_in(const Folder& folder) { return fs::directory_iterator(folder / "")->path().string(); }

TEST(UnfinishedFiles, NumbersOfProcessesMayComeAgain) {
    // As in a container, where every program has the same: names of those that were killed stand in the way of none.
    const Folder folder;
    for (int i = 0; i < 300; ++i)
        write_bytes(folder / (".bandlimit-" + std::to_string(::getpid()) + "-" + std::to_string(i) + ".txt"), "");
    std::set<std::string> names;
    for (int i = 0; i < 300; ++i) names.insert(AtomicFile(folder / "a.txt").unfinished());
    EXPECT_EQ(names.size(), 300u);
}

TEST(UnfinishedFiles, WhatAKilledProcessLeavesGoesOnceItIsOld) {
    const Folder folder;
    EXPECT_EXIT(
        {
            AtomicFile file(folder / "a.txt");
            file.write("half", 4);
            ::kill(::getpid(), SIGKILL);
        },
        ::testing::KilledBySignal(SIGKILL), "");
    ASSERT_EQ(folder.count(), 1);
    remove_abandoned_files(folder / "");
    ASSERT_EQ(folder.count(), 1);
    make_old(only_file_in(folder));
    remove_abandoned_files(folder / "");
    EXPECT_EQ(folder.count(), 0);
}

TEST(UnfinishedFiles, WhatSomebodyWorksOnStaysHoweverOld) {
    const Folder folder;
    AtomicFile file(folder / "a.txt");
    make_old(file.unfinished());
    remove_abandoned_files(folder / "");
    file.write("whole", 5);
    ASSERT_NO_THROW(file.commit());
    EXPECT_EQ(bytes_of(folder / "a.txt"), "whole");
    EXPECT_EQ(folder.count(), 1);
}

TEST(UnfinishedFiles, TheFirstFileOfAProcessInAFolderRemovesThem) {
    const Folder folder;
    const std::string left = folder / ".bandlimit-0123456789abcdef.png";
    for (const bool is_first : {true, false}) {
        write_bytes(left, "half");
        make_old(left);
        AtomicFile file(folder / "a.txt");
        EXPECT_EQ(fs::exists(left), !is_first);
    }
}

TEST(UnfinishedFiles, WhatIsCalledOtherwiseOrIsNoFileStays) {
    const Folder folder;
    const std::string target = folder / "target", pipe = folder / ".bandlimit-1111111111111111";
    const std::vector<std::string> files{".bandlimit-mips.json",
                                         ".bandlimit-0123456789abcde",
                                         ".bandlimit-0123456789abcdef0",
                                         ".bandlimit-0123456789ABCDEF",
                                         "x.bandlimit-0123456789abcdef",
                                         ".bandlimit-0123456789abcdef-1",
                                         "target"};
    for (const std::string& name : files) write_bytes(folder / name, "x");
    fs::create_directory(folder / ".bandlimit-2222222222222222");
    fs::create_symlink("target", folder / ".bandlimit-3333333333333333");
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    const auto count = folder.count();
    write_bytes(folder / ".bandlimit-4444444444444444", "x");
    write_bytes(folder / ".bandlimit-55555555aaaaffff.txt", "x");
    for (const auto& entry : fs::directory_iterator(folder / "")) make_old(entry.path().string());
    remove_abandoned_files(folder / "");  // does not wait for a writer of the pipe either
    EXPECT_EQ(folder.count(), count);
    EXPECT_FALSE(fs::exists(folder / ".bandlimit-4444444444444444"));
    remove_abandoned_files(folder / "no/such");
}

TEST(UnfinishedFiles, LinksInCirclesAreRefused) {
    const Folder folder;
    fs::create_symlink("b.txt", folder / "a.txt");
    fs::create_symlink("a.txt", folder / "b.txt");
    fs::create_symlink("self.txt", folder / "self.txt");
    for (const std::string name : {"a.txt", "b.txt", "self.txt"}) {
        EXPECT_TRUE(fails_for(
            folder / name, [&] { check_output_path(folder / name); }, "circles"));
        EXPECT_TRUE(fails_for(
            folder / name, [&] { AtomicFile file(folder / name); }, "circles"));
        EXPECT_TRUE(fs::is_symlink(folder / name));
    }
    EXPECT_EQ(folder.count(), 3);
}

TEST(UnfinishedFiles, LongExtensionsAndNamesAreNoMatter) {
    const Folder folder;
    const std::string path = folder / ("a." + std::string(250, 'x'));
    AtomicFile file(path);
    file.commit();
    EXPECT_TRUE(fs::exists(path));
}

/// Makes files in several threads until a signal ends the process.
[[noreturn]] void make_files_for_ever(const Folder& folder) {
    std::signal(SIGTERM, [](int) {
        remove_unfinished_files();
        ::_exit(7);
    });
    std::vector<std::jthread> threads;
    for (int t = 0; t < 6; ++t)
        threads.emplace_back([path = folder / ("a" + std::to_string(t))] {
            for (int i = 0;; ++i) {
                AtomicFile file(path);
                if (i % 2 == 0) file.commit();
            }
        });
    for (;;) ::pause();
}

TEST(UnfinishedFiles, ASignalAtAnyTimeLeavesNone) {
    const Folder folder;
    for (int round = 0; round < 40; ++round) {
        const pid_t child = ::fork();
        if (child == 0) make_files_for_ever(folder);
        while (!fs::exists(folder / "a5")) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        std::this_thread::sleep_for(std::chrono::microseconds(150 * round));
        ::kill(child, SIGTERM);
        int status = 0;
        ASSERT_EQ(::waitpid(child, &status, 0), child);
        ASSERT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 7) << status;
        for (const auto& entry : fs::directory_iterator(folder / ""))
            ASSERT_EQ(entry.path().filename().string().front(), 'a') << "round " << round << ": " << entry;
        fs::remove(folder / "a5");
    }
}

}  // namespace
}  // namespace bandlimit
