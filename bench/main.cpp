// Times resizing by bandlimit and by other programs, and prints a table: see bench/README.md.
#include <sys/mman.h>

#include <CLI/CLI.hpp>
#include <cstring>
#include <fstream>
#include <iostream>
#include <memory>

#include "bandlimit/core/error.h"
#include "bandlimit/math/random.h"
#include "bench/check.h"
#include "bench/peer.h"
#include "bench/table.h"

namespace bandlimit::bench {
namespace {

struct Options {
    std::vector<std::string> cases, targets{"all"}, only, processes;
    std::vector<int> threads{1, 2};
    Limits limits;
    std::string quoted;
    bool alone = false, check = false, huge_pages = false;
};

/// Owns the memory of Buffers. All sources hold the same picture of random samples; a `gentle` one holds codes from 64
/// to 191, whose results no program clamps, so that programs that clamp between their passes do not differ by that.
class Storage {
public:
    Storage(const Case& c, bool huge_pages, bool gentle = false) {
        // Together at least 256 MiB, more than the caches hold, and never less than three.
        const std::size_t each = source_bytes(c) + target_bytes(c);
        const std::size_t count = std::max(std::size_t{3}, ((std::size_t{256} << 20) + each - 1) / each);
        for (std::size_t i = 0; i < count; ++i) {
            sources.push_back(allocate(source_bytes(c), huge_pages));
            targets.push_back(allocate(target_bytes(c), huge_pages));
            std::memset(targets[i].data(), 1, targets[i].size());
            if (i == 0) fill(c, sources[0], gentle);
            else std::memcpy(sources[i].data(), sources[0].data(), sources[0].size());
            buffers.sources.push_back(sources[i]);
            buffers.targets.push_back(targets[i]);
        }
    }

    Buffers buffers;
    std::vector<std::span<std::byte>> sources, targets;

private:
    std::span<std::byte> allocate(std::size_t bytes, bool huge_pages) {
        const std::size_t alignment = huge_pages ? std::size_t{2} << 20 : 4096;
        const std::size_t whole = (bytes + alignment - 1) / alignment * alignment;
        memory_.emplace_back(static_cast<std::byte*>(std::aligned_alloc(alignment, whole)), &std::free);
        if (!memory_.back()) throw std::bad_alloc();
        if (huge_pages) madvise(memory_.back().get(), whole, MADV_HUGEPAGE);
        return {memory_.back().get(), bytes};
    }
    static void fill(const Case& c, std::span<std::byte> bytes, bool gentle) {
        Random random(1);
        for (std::size_t i = 0; c.channels > 1 && i + 8 <= bytes.size(); i += 8) {
            std::uint64_t bits = random.bits();
            if (gentle) bits = (bits >> 1 & 0x7f7f7f7f7f7f7f7fu) + 0x4040404040404040u;
            std::memcpy(&bytes[i], &bits, sizeof bits);
        }
        for (std::size_t i = 0; c.channels == 1 && i < bytes.size(); i += sizeof(float)) {
            const auto value = static_cast<float>(random.uniform());
            std::memcpy(&bytes[i], &value, sizeof value);
        }
    }

    std::vector<std::unique_ptr<std::byte, void (*)(void*)>> memory_;
};

bool listed(const std::vector<std::string>& list, const std::string& name) {
    return list.empty() || std::any_of(list.begin(), list.end(), [&](const std::string& part) {
               return std::search(name.begin(), name.end(), part.begin(), part.end(),
                                  [](char a, char b) { return std::tolower(a) == std::tolower(b); }) != name.end();
           });
}

std::vector<Case> chosen_cases(const Options& options) {
    std::vector<Case> chosen;
    std::string names;
    for (const Case& c : all_cases()) {
        names += " " + c.name;
        if (options.cases.empty() || std::count(options.cases.begin(), options.cases.end(), c.name))
            chosen.push_back(c);
    }
    for (const std::string& name : options.cases)
        if (std::none_of(chosen.begin(), chosen.end(), [&](const Case& c) { return c.name == name; }))
            fail("case \"", name, "\" is unknown; choose of:", names);
    return chosen;
}

std::vector<Peer> chosen_peers(const Options& options) {
    std::vector<Peer> peers;
    for (const std::string& targets : options.targets) peers.push_back(bandlimit_peer(targets));
    if (options.alone) return peers;
    std::vector<std::vector<Peer>> others{
#ifdef BENCH_OPENCV
        opencv_peers(),
#endif
#ifdef BENCH_ZIMG
        zimg_peers(),
#endif
#ifdef BENCH_VIPS
        vips_peers(),
#endif
#ifdef BENCH_STB
        stb_peers(),
#endif
#ifdef BENCH_OIIO
        oiio_peers(),
#endif
    };
    for (const std::string& command : options.processes)
        if (const std::optional<Peer> peer = process_peer(command)) others.push_back({*peer});
        else std::cerr << "left out, it does not answer: " << command << "\n";
    for (const std::vector<Peer>& group : others)
        for (const Peer& peer : group)
            if (listed(options.only, peer.name)) peers.push_back(peer);
    return peers;
}

/// Copies of as many bytes as the case moves, half of them read and half written: from the begin of one buffer to the
/// end of the next, so that all of the memory is used and little of it is in a cache. The pictures become others, as
/// random.
Cell time_memcpy(Clock& clock, const Case& c, const Storage& storage, int threads) {
    const bool more_out = target_bytes(c) > source_bytes(c);
    const auto& memory = more_out ? storage.targets : storage.sources;
    const std::size_t bytes = (source_bytes(c) + target_bytes(c)) / 2;
    const auto run = [&](int k) {
        const auto i = static_cast<std::size_t>(k);
        return memcpy_seconds(memory[i].first(bytes), memory[(i + 1) % memory.size()].last(bytes), threads);
    };
    return {c.name, threads, false, clock.measure(run, storage.buffers, threads)};
}

Table measure_all(const Options& options, Clock& clock) {
    const std::vector<Case> cases = chosen_cases(options);
    const std::vector<Peer> peers = chosen_peers(options);
    Table table;
    table.cases = cases;
    table.copies.name = "memcpy of as many bytes";
    for (const Peer& peer : peers) table.rows.push_back({peer.name, peer.note, {}});
    for (const Case& c : cases) {
        const Storage storage(c, options.huge_pages);
        for (const int threads : options.threads) table.copies.cells.push_back(time_memcpy(clock, c, storage, threads));
        for (std::size_t i = 0; i < peers.size(); ++i)
            for (const int threads : options.threads) {
                if (threads > peers[i].threads) continue;
                const std::optional<Task> task = peers[i].prepare(c, storage.buffers, threads);
                if (!task) continue;
                std::cerr << "case " << c.name << ", " << threads << " threads: " << peers[i].name << "\n";
                table.rows[i].cells.push_back(
                    {c.name, threads, task->other, clock.measure(task->run, storage.buffers, threads)});
            }
    }
    return table;
}

/// What each program computes, beside what bandlimit computes.
void check_all(const Options& options) {
    std::cout << "| program | case | largest difference, codes | mean difference, codes |\n|---|---|---|---|\n";
    const std::vector<Peer> peers = chosen_peers(options);
    for (const Case& c : chosen_cases(options)) {
        const Storage storage(c, options.huge_pages, true);
        std::vector<std::byte> expected;
        for (const Peer& peer : peers) {
            const std::optional<Task> task = peer.prepare(c, storage.buffers, 1);
            if (!task) continue;
            task->run(0);
            if (task->collect) task->collect(0);
            const std::span<const std::byte> got = storage.buffers.targets[0];
            if (expected.empty()) expected.assign(got.begin(), got.end());
            const Difference d = difference(c, expected, got);
            std::cout << "| " << peer.name << " | " << c.name << (task->other ? ", another operation" : "") << " | "
                      << d.largest << " | " << d.mean << " |" << std::endl;
        }
    }
}

void read_options(CLI::App& app, Options& options) {
    app.add_option("--cases", options.cases, "Only these: a, b, c, d, e, f-box, f, g")->delimiter(',');
    app.add_option("--only", options.only, "Beside bandlimit only programs whose name contains one of these")
        ->delimiter(',');
    app.add_flag("--alone", options.alone, "bandlimit alone");
    app.add_option("--targets", options.targets,
                   "Instruction sets of bandlimit, a row each: all (the widest), avx2, ...")
        ->delimiter(',')
        ->capture_default_str();
    app.add_option("--threads", options.threads, "How many threads")
        ->delimiter(',')
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();
    app.add_option("--samples", options.limits.samples, "Samples from a quiet machine")->capture_default_str();
    app.add_option("--attempts", options.limits.attempts, "Samples at most")->capture_default_str();
    app.add_option("--seconds", options.limits.seconds, "After so many, three samples of a slow program must do")
        ->capture_default_str();
    app.add_option("--process", options.processes, "Start this command, and time it as a program too");
    app.add_option("--quoted", options.quoted, "A file with rows for the end of the table, where it has all cases")
        ->check(CLI::ExistingFile);
    app.add_flag("--huge-pages", options.huge_pages, "Sources and targets in huge pages");
    app.add_flag("--check", options.check, "Time nothing; compare the results with those of bandlimit");
}

int run(const Options& options) {
    if (options.check) {
        check_all(options);
        return 0;
    }
    Clock clock(options.limits);
    const Table table = measure_all(options, clock);
    write(std::cout, table, options.threads, clock);
    // Their columns are all cases.
    if (!options.quoted.empty() && options.cases.empty()) std::cout << std::ifstream(options.quoted).rdbuf();
    std::cout << "\n";
    write_notes(std::cout, table, options.threads, clock);
    return 0;
}

}  // namespace
}  // namespace bandlimit::bench

int main(int argc, char** argv) {
    bandlimit::bench::Options options;
    CLI::App app("Times resizing by bandlimit and by other programs");
    bandlimit::bench::read_options(app, options);
    CLI11_PARSE(app, argc, argv);
    try {
        return bandlimit::bench::run(options);
    } catch (const std::exception& e) {
        std::cerr << "error: " << e.what() << "\n";
        return 1;
    }
}
