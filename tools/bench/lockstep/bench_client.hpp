#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "tools/bench/lockstep/udp_floor.hpp"

namespace cohort::bench {

/// Computes for this long, by the CPU time of the calling thread [s].
void compute(double seconds);

/// A client process of `cohort bench lockstep`: of the server over DDS, or of the floor.
struct BenchClient {
  std::vector<std::string> robots;  ///< selectors; empty: this is a client of the floor
  std::uint32_t domain = 0;
  double work = 0.0;  ///< CPU time of a step, of all robots together [s]
  bool inline_step = false;
  UdpClientOptions udp;
};

/// Until the run ends or `stop` is set. The process's exit code.
int run_bench_client(const BenchClient& client, const std::atomic<bool>& stop);

}  // namespace cohort::bench
