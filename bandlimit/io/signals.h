// Work that no signal handler interrupts.
// Stability: evolving.
#pragma once
#include <signal.h>

namespace bandlimit {

/// No handler runs in this thread while it lives; signals wait. Other threads are as they were.
class BlockedSignals {
public:
    BlockedSignals() noexcept {
        sigset_t all;
        ::sigfillset(&all);
        ::pthread_sigmask(SIG_SETMASK, &all, &before_);
    }
    ~BlockedSignals() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
    BlockedSignals(const BlockedSignals&) = delete;
    BlockedSignals& operator=(const BlockedSignals&) = delete;

    /// What was blocked before.
    const sigset_t& before() const { return before_; }

private:
    sigset_t before_;
};

}  // namespace bandlimit
