#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/cohort/running/outputs.hpp"

namespace cohort::tool {

enum class Controllers {
  in_process,  ///< in the server's process
  process,     ///< one process for each team
  per_robot,   ///< one process for each robot
  external,    ///< started by somebody else
};

/// What a recording holds, where the experiment says something else.
struct RecordOptions {
  std::optional<double> pose_rate{};          ///< [Hz]
  std::optional<double> joint_rate{};         ///< [Hz]
  std::optional<double> observation_rate{};   ///< [Hz]
  std::vector<std::string> robots{};          ///< selectors: whose observations
  std::optional<double> snapshot_interval{};  ///< [s]
};

struct RunCommand {
  std::vector<std::filesystem::path> files;  ///< experiments, one after the other
  bool runs_xacro = false;                   ///< to expand those of them that are xacro files
  std::uint64_t repeat = 1;                  ///< how often all of them are run
  unsigned threads = 0;                      ///< 0: one for each core
  std::optional<double> duration;
  std::optional<std::uint64_t> seed;
  std::vector<std::uint64_t> seeds;  ///< all are run with each of these; empty: with `seed`
  Controllers controllers = Controllers::process;
  std::optional<double> speed;  ///< 0: as fast as it goes; none: that, or real time if people drive
  Outputs outputs;
  RecordOptions record;
  bool record_or_stop = false;  ///< the run ends when its recording does
  bool quiet = false;
  bool paused = false;                 ///< at first
  bool view = false;                   ///< in a browser too
  bool view_controls = false;          ///< which may steer it
  bool view_opens = false;             ///< which is opened; the run begins when it is seen
  double keep_interval = 0.0;          ///< [s], simulated, between snapshots to go back to; 0: none
  std::filesystem::path from;          ///< snapshot to go on from; empty: from the beginning
  std::vector<std::uint32_t> domains;  ///< empty: any free ones, or 0 if others start controllers
  std::string network = "127.0.0.1";
  std::filesystem::path secure;  ///< folder of identities; empty: without security
};

}  // namespace cohort::tool
