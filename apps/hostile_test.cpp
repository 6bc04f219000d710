// The program among files that are not what they say, places that cannot be written, and interruptions.
#include <sys/stat.h>

#include <array>

#include "apps/run_program_test.h"

namespace bandlimit {
namespace {

/// Seconds: what hangs or eats the machine takes longer, even where the machine has other work.
constexpr double quickly = 60;

/// A small picture called `name`.
void add_picture(const Shell& shell, const std::string& name = "in.png") {
    AnyImage image = noise(abilities_of(name).depths.front(), 40, 30, 3);
    save(shell / name, image);
}

TEST(BadInput, WhatIsNoImageIsExitCode1) {
    const Shell shell(BANDLIMIT_PROGRAM);
    add_picture(shell);
    write_bytes(shell / "empty.png", "");
    write_bytes(shell / "text.png", "This is no picture, though its name says so.\n");
    std::filesystem::create_directory(shell / "folder.png");
    ASSERT_EQ(::mkfifo((shell / "pipe.png").c_str(), 0600), 0);
    std::filesystem::create_symlink("nowhere", shell / "dangling.png");
    std::filesystem::create_symlink("loop.png", shell / "loop.png");
    const std::set<std::string> before = shell.files();
    for (const std::string name : {"none.png", "none/in.png", "in.png/in.png", "empty.png", "text.png", "folder.png",
                                   ".", "pipe.png", "dangling.png", "loop.png", "/dev/null", "/dev/zero"}) {
        EXPECT_TRUE(fails(1, shell("info " + name + " --json"), name));
    }
    EXPECT_TRUE(fails(1, shell("resize none.png out.png --scale 0.5 --json"), "none.png"));
    EXPECT_TRUE(fails(1, shell("resize . out.png --scale 0.5"), "directory"));
    EXPECT_TRUE(fails(1, shell.run({"info", ""})));
    EXPECT_TRUE(fails(1, shell("compare in.png text.png --json"), "text.png"));
    EXPECT_TRUE(fails(1, shell("resize in.png out.png --scale 1 --region 30,0,11,30"), "40 x 30"));
    EXPECT_TRUE(fails(1, shell("resize in.png out.png --scale 1 --region -1,0,10,10"), "40 x 30"));
    EXPECT_EQ(shell.files(), before);
}

TEST(BadInput, TruncatedFilesLeaveNothingBehind) {
    const Shell shell(BANDLIMIT_PROGRAM);
    for (const std::string format : {"png", "tif", "exr", "ppm", "pfm", "jpg", "webp", "hdr", "bmp", "tga"}) {
        const std::string whole = "whole." + format, cut = "cut." + format;
        add_picture(shell, whole);
        const std::string bytes = bytes_of(shell / whole);
        const std::set<std::string> before{whole, cut};
        for (const double share : {0.1, 0.8}) {
            write_bytes(shell / cut,
                        bytes.substr(0, static_cast<std::size_t>(share * static_cast<double>(bytes.size()))));
            // What codecs print by themselves is for the program to keep away.
            const std::string line = "resize " + cut + " out.png --scale 0.5 --depth u8";
            EXPECT_TRUE(fails(1, share < 0.5 ? shell(line) : shell.start(line), cut)) << share;
            EXPECT_EQ(shell.files(), before) << cut << " " << share;
        }
        std::filesystem::remove(shell / whole);
        std::filesystem::remove(shell / cut);
    }
}

std::string big_endian(std::uint32_t v) {
    return {static_cast<char>(v >> 24), static_cast<char>(v >> 16), static_cast<char>(v >> 8), static_cast<char>(v)};
}
std::string little_endian(std::uint32_t v) {
    const std::string text = big_endian(v);
    return {text.rbegin(), text.rend()};
}

/// A PNG that claims a size and holds no pixel; the checksum of its header is right.
std::string png_of(std::uint32_t width, std::uint32_t height) {
    const std::string head = "IHDR" + big_endian(width) + big_endian(height) + std::string("\x08\x02\0\0\0", 5);
    std::uint32_t crc = 0xffffffff;
    for (const char c : head) {
        crc ^= static_cast<unsigned char>(c);
        for (int k = 0; k < 8; ++k) crc = crc & 1 ? 0xedb88320 ^ (crc >> 1) : crc >> 1;
    }
    return "\x89PNG\r\n\x1a\n" + big_endian(13) + head + big_endian(~crc) + big_endian(100) + "IDAT" +
           std::string(100, '\0');
}

/// A grey TIFF in one strip.
std::string tiff_of(std::uint32_t width, std::uint32_t height) {
    std::string entries;
    int count = 0;
    const auto entry = [&](char tag, std::uint32_t value) {
        entries += std::string{tag, 1} + std::string("\x04\0\x01\0\0\0", 6) + little_endian(value);
        ++count;
    };
    entry(0, width), entry(1, height), entry(2, 8), entry(3, 1), entry(6, 1), entry(17, 8), entry(21, 1),
        entry(22, height);
    entry(23, 100);
    return std::string("II*\0\x08\0\0\0", 8) + std::string{static_cast<char>(count), 0} + entries +
           std::string(200, '\0');
}

TEST(BadInput, HeadersThatClaimTheWorldAreRefusedQuickly) {
    const Shell shell(BANDLIMIT_PROGRAM);
    constexpr std::uint32_t most = 0x7fffffff;
    const std::string n = "2147483647", junk(200, 'x');
    const std::array<std::pair<std::string, std::string>, 9> files{{
        {"a.png", png_of(most, most)},
        {"b.png", png_of(0, 5)},
        {"a.ppm", "P6\n" + n + " " + n + "\n255\n" + junk},
        {"b.ppm", "P6\n0 0\n255\n"},
        {"a.pfm", "PF\n" + n + " " + n + "\n-1.0\n" + junk},
        {"a.tif", tiff_of(most, most)},
        {"b.tif", tiff_of(0, 0)},
        {"a.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + n + " +X " + n + "\n" + junk},
        {"a.bmp", "BM" + little_endian(1000) + little_endian(0) + little_endian(54) + little_endian(40) +
                      little_endian(most) + little_endian(most) + std::string("\x01\0\x18\0", 4) +
                      std::string(24, '\0') + junk},
    }};
    Circumstances little_memory;
    // A sanitizer maps terabytes for itself.
    if (!is_sanitized) little_memory.limits = {{RLIMIT_AS, rlim_t(2) << 30}};
    for (const auto& [name, bytes] : files) {
        write_bytes(shell / name, bytes);
        const Outcome run = shell("resize " + name + " out.png --size 8x8", little_memory);
        EXPECT_TRUE(fails(1, run, name));
        EXPECT_LT(run.seconds, quickly) << name;
        EXPECT_EQ(shell.files(), std::set<std::string>{name});
        std::filesystem::remove(shell / name);
    }
}

TEST(BadInput, SizesBeyondTheMachineAreRefusedQuickly) {
    const Shell shell(BANDLIMIT_PROGRAM);
    add_picture(shell);
    for (const std::string line :
         {"resize in.png out.png --size 2147483647x2147483647", "resize in.png out.tif --size 2147483647x1",
          "resize in.png out.tif --size 1x2147483647", "resize in.png out.tif --scale 5e7 --kernel jinc2",
          "pattern checker out.tif --size 2147483647x2147483647",
          "pattern noise out.tif --size 1000000x1000000 --cutoff 0.1"}) {
        const Outcome run = shell(line);
        EXPECT_TRUE(fails(1, run, "memory")) << line;
        EXPECT_LT(run.seconds, quickly) << line;
    }
    EXPECT_EQ(shell.files(), std::set<std::string>{"in.png"});
}

TEST(Output, PlacesThatCannotBeWrittenAreExitCode1) {
    const Shell shell(BANDLIMIT_PROGRAM);
    add_picture(shell);
    for (const char* folder : {"folder", "folder.png", "locked"}) std::filesystem::create_directory(shell / folder);
    ASSERT_EQ(::mkfifo((shell / "pipe").c_str(), 0600), 0);
    write_bytes(shell / "file", "kept");
    const std::set<std::string> before = shell.files();
    // Where something exists that is no regular file, that is the error, whatever the extension.
    for (const std::string out :
         {"/dev/null", "/dev/full", "folder", "folder.png", "pipe", "none/out.png", "file/out.png", "."}) {
        EXPECT_TRUE(fails(1, shell("resize in.png " + out + " --scale 0.5"), out));
    }
    EXPECT_TRUE(fails(1, shell("pattern box /dev/null --size 8x8"), "/dev/null"));
    EXPECT_TRUE(fails(1, shell("pattern box none/out.png --size 8x8"), "none"));
    EXPECT_TRUE(fails(1, shell("analyze tent --plot /dev/null"), "/dev/null"));
    EXPECT_TRUE(fails(1, shell("analyze tent --plot none/out.svg"), "none"));
    EXPECT_TRUE(fails(1, shell("tour none/out"), "none/out"));
    EXPECT_TRUE(fails(1, shell("tour file"), "file"));
    if (::geteuid() != 0) {  // root may write everywhere
        ASSERT_EQ(::chmod((shell / "locked").c_str(), 0500), 0);
        EXPECT_TRUE(fails(1, shell("resize in.png locked/out.png --scale 0.5"), "locked"));
    }
    EXPECT_EQ(shell.files(), before);
    EXPECT_EQ(bytes_of(shell / "file"), "kept");
}

TEST(Output, AFullDiskKeepsWhatWasThere) {
    const Shell shell(BANDLIMIT_PROGRAM);
    const Circumstances full{.limits = {{RLIMIT_FSIZE, 2000}}};
    AnyImage image = noise(Depth::u16, 100, 80, 3);
    save(shell / "in.png", image);
    for (const std::string format : {"png", "jpg", "tif", "exr", "hdr", "ppm", "pfm", "webp", "tga", "bmp"}) {
        const std::string out = "out." + format;
        write_bytes(shell / out, "as it was");
        EXPECT_TRUE(fails(1, shell("resize in.png " + out + " --scale 2 --threads 1", full), out));
        EXPECT_EQ(shell.files(), (std::set<std::string>{"in.png", out}));
        EXPECT_EQ(bytes_of(shell / out), "as it was");
        std::filesystem::remove(shell / out);
    }
    EXPECT_TRUE(fails(1, shell("pattern zoneplate z.png --size 200x200", full), "z.png"));
    EXPECT_TRUE(fails(1, shell("compare in.png in.png --diff d.ppm", full), "d.ppm"));
    EXPECT_TRUE(fails(1, shell("analyze tent --plot p.svg", full), "disk"));
    EXPECT_EQ(shell.files(), std::set<std::string>{"in.png"});
}

TEST(Output, AFailureKeepsWhatWasThere) {
    const Shell shell(BANDLIMIT_PROGRAM);
    add_picture(shell);
    write_bytes(shell / "cut.png", bytes_of(shell / "in.png").substr(0, 2500));
    write_bytes(shell / "out.png", "as it was");
    EXPECT_TRUE(fails(1, shell("resize cut.png out.png --scale 0.5"), "cut.png"));
    EXPECT_TRUE(fails(1, shell("resize cut.png cut.png --scale 0.5"), "cut.png"));
    EXPECT_EQ(bytes_of(shell / "out.png"), "as it was");
    EXPECT_EQ(bytes_of(shell / "cut.png").size(), 2500u);
    EXPECT_EQ(shell.files(), (std::set<std::string>{"in.png", "cut.png", "out.png"}));
}

TEST(Output, MayBeTheInputOrBehindALink) {
    const Shell shell(BANDLIMIT_PROGRAM);
    add_picture(shell);
    ASSERT_TRUE(succeeds(shell("resize in.png small.png --scale 0.5")));
    std::filesystem::create_symlink("in.png", shell / "link.png");
    ASSERT_TRUE(succeeds(shell("resize in.png link.png --scale 0.5")));  // the input, by another name
    EXPECT_TRUE(std::filesystem::is_symlink(shell / "link.png"));
    AnyImage small = read_image(shell / "small.png"), same = read_image(shell / "in.png");
    EXPECT_TRUE(equal(pixels(small), pixels(same)));
    EXPECT_EQ(shell.files(), (std::set<std::string>{"in.png", "small.png", "link.png"}));
}

TEST(Output, NamesAreTakenAsTheyAre) {
    const Shell shell(BANDLIMIT_PROGRAM);
    add_picture(shell);
    std::string last = "in.png";
    for (const std::string name :
         {"with blank.png", "it's \"quoted\".png", "Größe-寸法.png", "100%d %s.png", "-dash.png", "a\\b.png",
          "{brace}.png", "#0001.png", "%04d.png", "resize.png", "a:b.png", "a?b=c.png"}) {
        const Outcome run = shell.run({"resize", "--scale", "1", "--json", "--", last, name});
        ASSERT_TRUE(succeeds(run)) << name;
        EXPECT_EQ(shell.files().count(name), 1u) << name;
        EXPECT_EQ(run.json()["output"]["file"], name);
        last = name;
    }
    const Outcome missing = shell.run({"info", "two\nlines %s {} none.png"});
    EXPECT_TRUE(fails(1, missing, "%s {} none.png"));
    write_bytes(shell / "\xff\xfe.png", bytes_of(shell / "in.png"));  // no UTF-8: the report must still be JSON
    const Outcome strange = shell.run({"info", "--json", "\xff\xfe.png"});
    EXPECT_EQ(strange.code, 0) << strange;
    EXPECT_EQ(strange.json()["width"], 40);
}

TEST(Output, AnInterruptionLeavesNothing) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        const Shell shell(BANDLIMIT_PROGRAM);
        write_bytes(shell / "out.png", "as it was");
        // Minutes of work, if nothing interrupted it: killed once the unfinished file shows.
        bool was_seen = false;
        const auto kill_in_the_middle = [&](pid_t process) {
            was_seen = shell.files().size() > 1;
            return was_seen && ::kill(process, signal) == 0;
        };
        const Outcome run =
            shell("pattern siemens out.png --size 6000x6000 --antialias lanczos3 --samples 16 --threads 1",
                  {.meanwhile = kill_in_the_middle});
        EXPECT_TRUE(was_seen) << run;
        EXPECT_EQ(run.signal, signal) << run;
        EXPECT_EQ(shell.files(), std::set<std::string>{"out.png"});
        EXPECT_EQ(bytes_of(shell / "out.png"), "as it was");
    }
}

}  // namespace
}  // namespace bandlimit
