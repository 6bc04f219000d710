// Files appear whole or not at all.
#include "bandlimit/io/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>

#include "bandlimit/io/files_test.h"

namespace bandlimit {
namespace {

namespace fs = std::filesystem;

/// For as long as it lives, no file of this process may grow beyond `bytes`.
class FileSizeLimit {
public:
    explicit FileSizeLimit(rlim_t bytes) {
        ::getrlimit(RLIMIT_FSIZE, &before_);
        handler_ = std::signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{bytes, before_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit() {
        ::setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, handler_);
    }
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;

private:
    rlimit before_{};
    void (*handler_)(int) = nullptr;
};

void write_text(const std::string& path, const std::string& text) {
    AtomicFile file(path);
    file.write(text.data(), text.size());
    file.commit();
}

TEST(AtomicFile, AppearsOnCommitAndReplacesWhatWasThere) {
    const Folder folder;
    const std::string path = folder / "a.txt";
    write_bytes(path, "old");
    ::chmod(path.c_str(), 0640);
    {
        AtomicFile file(path);
        file.write("new text", 8);
        EXPECT_EQ(bytes_of(path), "old");
        EXPECT_EQ(fs::path(file.unfinished()).extension(), ".txt");
        file.commit();
    }
    EXPECT_EQ(bytes_of(path), "new text");
    EXPECT_EQ(folder.count(), 1);
    EXPECT_EQ(fs::status(path).permissions(), fs::perms(0640));
}

TEST(AtomicFile, VanishesWithoutCommit) {
    const Folder folder;
    {
        AtomicFile file(folder / "a.txt");
        file.write("x", 1);
        EXPECT_EQ(folder.count(), 1);
    }
    EXPECT_EQ(folder.count(), 0);
}

TEST(AtomicFile, UnfinishedOnesAreRemovedOnCall) {
    const Folder folder;
    EXPECT_EXIT(
        {
            write_text(folder / "done.txt", "done");
            AtomicFile a(folder / "a.txt");
            AtomicFile b(folder / "b.txt");
            const auto before = folder.count();
            remove_unfinished_files();
            ::_exit(before == 3 ? 7 : 8);
        },
        ::testing::ExitedWithCode(7), "");
    EXPECT_EQ(folder.count(), 1);
    EXPECT_EQ(bytes_of(folder / "done.txt"), "done");
}

TEST(AtomicFile, AnInterruptedProcessLeavesNothing) {
    const Folder folder;
    EXPECT_EXIT(
        {
            std::signal(SIGTERM, [](int) {
                remove_unfinished_files();
                ::_exit(7);
            });
            AtomicFile file(folder / "a.txt");
            file.write("half", 4);
            std::raise(SIGTERM);
        },
        ::testing::ExitedWithCode(7), "");
    EXPECT_EQ(folder.count(), 0);
}

TEST(AtomicFile, ALinkStaysAndWhatItLeadsToIsReplaced) {
    const Folder folder;
    fs::create_directory(folder / "there");
    write_bytes(folder / "there/real.txt", "old");
    fs::create_symlink("there/real.txt", folder / "link.txt");
    fs::create_symlink("link.txt", folder / "link2.txt");
    fs::create_symlink("there/new.txt", folder / "dangling.txt");
    write_text(folder / "link2.txt", "new");
    write_text(folder / "dangling.txt", "fresh");
    EXPECT_TRUE(fs::is_symlink(folder / "link.txt") && fs::is_symlink(folder / "link2.txt"));
    EXPECT_EQ(bytes_of(folder / "there/real.txt"), "new");
    EXPECT_EQ(bytes_of(folder / "there/new.txt"), "fresh");
}

TEST(AtomicFile, PlacesThatCannotBeWrittenAreRefused) {
    const Folder folder;
    const std::string pipe = folder / "pipe.unknown", nowhere = folder / "no/a.png", under = folder / "file/a.png";
    write_bytes(folder / "file", "x");
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    const auto refuses = [](const std::string& path, const std::string& word) {
        const ::testing::AssertionResult early = fails_for(
            path, [&] { check_output_path(path); }, word);
        if (!early) return early;
        // The path is judged before its extension and before anything else about the target.
        return fails_for(
            path, [&] { ImageWriter writer(path, {}); }, word);
    };
    EXPECT_TRUE(refuses(folder / "", "a directory"));
    EXPECT_TRUE(refuses("/dev/full", "a device"));
    EXPECT_TRUE(refuses("/dev/null", "a device"));
    EXPECT_TRUE(refuses(pipe, "a pipe"));
    EXPECT_TRUE(refuses(nowhere, "create it first"));
    EXPECT_TRUE(refuses(under, "file"));
    fs::create_symlink("/dev/full", folder / "device.png");
    EXPECT_TRUE(refuses(folder / "device.png", "a device"));
    EXPECT_TRUE(fails_for("/proc/a.png", [] { AtomicFile file("/proc/a.png"); }));
    EXPECT_EQ(folder.count(), 3);
}

TEST(AtomicFile, FoldersAndFilesWithoutPermissionAreRefused) {
    const Folder folder;
    fs::create_directory(folder / "locked");
    write_bytes(folder / "precious.png", "x");
    fs::permissions(folder / "", fs::perms(0755));
    fs::permissions(folder / "locked", fs::perms(0555));
    fs::permissions(folder / "precious.png", fs::perms(0444));
    const bool was_root = ::geteuid() == 0;
    if (was_root) {
        ASSERT_EQ(::seteuid(65534), 0);
    }
    EXPECT_TRUE(fails_for(
        folder / "locked/a.png", [&] { check_output_path(folder / "locked/a.png"); }, "not writable"));
    EXPECT_TRUE(fails_for(
        folder / "precious.png", [&] { check_output_path(folder / "precious.png"); }, "write-protected"));
    if (was_root) {
        ASSERT_EQ(::seteuid(0), 0);
    }
}

TEST(AtomicFile, AFullDiskIsReportedAndNothingIsLeft) {
    // Small files fail when the buffer is emptied, at the very end; large ones on the way.
    const Folder folder;
    for (const std::size_t size : {std::size_t{100}, std::size_t{1} << 20}) {
        const std::string path = folder / "a.txt";
        const FileSizeLimit limit(size - 1);
        EXPECT_TRUE(fails_for(
            path, [&] { write_text(path, std::string(size, 'x')); }, "cannot be written"));
        EXPECT_EQ(folder.count(), 0);
    }
}

TEST(ImageWriter, AFullDiskIsReportedWhereverItStrikes) {
    const Folder folder;
    for (const std::string extension : {"png", "jpg", "tif", "exr", "hdr", "ppm", "pfm", "webp", "tga", "bmp"}) {
        SCOPED_TRACE(extension);
        const std::string path = folder / ("a." + extension);
        const Depth depth = abilities_of(path).depths.front();
        AnyImage image = noise(depth, 64, 48, 3);
        const ImageTarget target = target_of(depth, 64, 48, 3);
        write_image(path, target, pixels(image));
        const auto size = static_cast<rlim_t>(fs::file_size(path));
        fs::remove(path);
        std::vector<rlim_t> limits{0, 1, 7, 8, 100, size / 3, size / 2, size - 1500};
        for (rlim_t short_of = 1; short_of < 300; short_of += extension == "tif" ? 3 : 37)
            limits.push_back(size - short_of);
        for (const rlim_t bytes : limits) {
            const FileSizeLimit limit(bytes);
            EXPECT_TRUE(fails_for(
                path, [&] { write_image(path, target, pixels(image)); }, "cannot be written"))
                << bytes << " of " << size;
            ASSERT_EQ(folder.count(), 0) << bytes << " of " << size;
        }
        const FileSizeLimit enough(size);
        EXPECT_NO_THROW(write_image(path, target, pixels(image)));
        fs::remove(path);
    }
}

TEST(ImageWriter, AnAbandonedOneLeavesNothing) {
    const Folder folder;
    for (const std::string extension : {"png", "jpg", "tif", "exr", "hdr", "ppm", "webp", "tga", "bmp"}) {
        const std::string path = folder / ("a." + extension);
        write_bytes(path, "old");
        const Depth depth = abilities_of(path).depths.front();
        AnyImage image = noise(depth, 40, 30, 3);
        {
            ImageWriter writer(path, target_of(depth, 40, 30, 3), 1);
            writer.write_rows(const_view(rows_of(view_of(image), 0, 11)));
        }
        EXPECT_EQ(bytes_of(path), "old");
        fs::remove(path);
        EXPECT_EQ(folder.count(), 0);
    }
}

}  // namespace
}  // namespace bandlimit
