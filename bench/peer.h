// What a program that is timed looks like from here, and where each is found.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/cases.h"
#include "bench/timing.h"

namespace bandlimit::bench {

/// One operation, made ready.
struct Task {
    /// Does it from source k to target k; returns the seconds it took.
    std::function<double(int k)> run;
    /// Empty where run(k) writes target k. Else brings the result there in the layout of the case; not timed.
    std::function<void(int k)> collect = {};
    bool other = false;  ///< it is not the operation of the case, but what the program offers in its place
};

/// The common Task: `work(k)` is timed here.
template <class Work>
Task timed(Work work) {
    return {.run = [work](int k) { return seconds_of([&] { work(k); }); }};
}

struct Peer {
    std::string name;  ///< with its version
    std::string note;  ///< what it really computes, and how it is driven
    int threads = 2;   ///< it can use
    /// Empty where the program has nothing like the case.
    std::function<std::optional<Task>(const Case& c, const Buffers& buffers, int threads)> prepare;
};

/// bandlimit on the target of this name, or on the widest for "all". Throws Error for another name.
Peer bandlimit_peer(const std::string& name);

/// A program that speaks the protocol of bench/README.md, started by `command` in a shell. Empty if it does not answer.
std::optional<Peer> process_peer(const std::string& command);

// Built only where their libraries are installed.
std::vector<Peer> opencv_peers();
std::vector<Peer> zimg_peers();
std::vector<Peer> vips_peers();
std::vector<Peer> stb_peers();
std::vector<Peer> oiio_peers();

}  // namespace bandlimit::bench
