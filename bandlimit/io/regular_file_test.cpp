// What is no regular file is not read, and nothing waits for it.
#include "bandlimit/io/regular_file.h"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <map>

#include "bandlimit/io/files_test.h"
#include "bandlimit/io/taps_json.h"

namespace bandlimit {
namespace {

namespace fs = std::filesystem;

TEST(RegularFile, NothingElseIsOpened) {
    const Folder folder;
    const std::string pipe = folder / "pipe", link = folder / "link.png", socket = folder / "socket";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    fs::create_symlink("pipe", link);
    fs::create_symlink("circle", folder / "circle");
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    ASSERT_LT(socket.size(), sizeof address.sun_path);
    socket.copy(address.sun_path, socket.size());
    const int listener = ::socket(AF_UNIX, SOCK_STREAM, 0);
    ASSERT_EQ(::bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    ::close(listener);
    for (const auto& [path, word] : std::map<std::string, std::string>{{pipe, "is a pipe"},
                                                                       {link, "is a pipe"},
                                                                       {socket, "is a socket"},
                                                                       {folder / "", "is a directory"},
                                                                       {"/dev/zero", "is a device"},
                                                                       {"/dev/null", "is a device"},
                                                                       {folder / "circle", "cannot be read"},
                                                                       {folder / "none", "does not exist"},
                                                                       {"", "does not exist"}}) {
        const auto refuses = [&path = path, &word = word](auto read) {
            return fails_for(
                path, [&] { read(path); }, word);
        };
        EXPECT_TRUE(refuses([](const std::string& p) { open_regular(p); }));
        EXPECT_TRUE(refuses([](const std::string& p) { read_text(p, 1 << 20, "a text"); }));
        EXPECT_TRUE(refuses([](const std::string& p) { read_taps(p); }));
        EXPECT_TRUE(refuses([](const std::string& p) { ImageReader reader(p); }));
    }
}

TEST(RegularFile, TextIsReadWholeUpToItsLimit) {
    const Folder folder;
    const std::string path = folder / "a.txt";
    const std::string text(1 << 20, 'x');
    write_bytes(path, text);
    EXPECT_EQ(read_text(path, 1 << 20, "a text"), text);
    EXPECT_EQ(length_of(open_regular(path)), text.size());
    write_bytes(path, text + "y");
    EXPECT_TRUE(fails_for(
        path, [&] { read_text(path, 1 << 20, "a text"); }, "more than 1 MB; name a text"));
}

}  // namespace
}  // namespace bandlimit
