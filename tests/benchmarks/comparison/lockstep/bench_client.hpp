// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/benchmarks/comparison/lockstep/udp_floor.hpp"

namespace cohort::bench {

/// Computes for the given CPU time of the calling thread [s].
void compute(double seconds);

/// A client process of `cohort-bench lockstep`: a client of the server over DDS, or of the raw UDP exchange (UdpFloor).
struct BenchClient {
  std::vector<std::string> robots;  ///< selectors; empty: a client of UdpFloor
  std::uint32_t domain = 0;
  double work = 0.0;  ///< CPU time of a step, for all robots together [s]
  bool inline_step = false;
  UdpClientOptions udp;
};

/// Runs the client until the run ends or `stop` is set. Returns the process's exit code.
int run_bench_client(const BenchClient& client, const std::atomic<bool>& stop);

}  // namespace cohort::bench
