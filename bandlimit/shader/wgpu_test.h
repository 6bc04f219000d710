// WGSL, executed by wgpu: a WebGPU implementation from a Python package, which scripts/setup installs.
#pragma once
#include <string>
#include <vector>

#include "bandlimit/shader/vulkan_test.h"

namespace bandlimit::test {

/// A shader, and what it is given. WebGPU has no clamp to border, so edges other than zero only.
struct WgpuJob {
    std::string shader;
    Dispatch dispatch;
    int feedback = -1;  ///< the texture that is the result of the job before, if 0 or more; it has its size
};

/// What is missing, with how to get it; empty if wgpu is there.
std::string missing_wgpu();

/// The results of all jobs, from one process.
/// throws   std::runtime_error with what it says
std::vector<std::vector<float>> run_by_wgpu(const std::vector<WgpuJob>& jobs);

}  // namespace bandlimit::test
