// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/cli/running/outputs.hpp"

namespace cohort::tool {

enum class Controllers {
  in_process,  ///< in the server's process
  process,     ///< one process for each team
  per_robot,   ///< one process for each robot
  external,    ///< started by another program
};

/// Contents of a recording that replace those of the experiment.
struct RecordOptions {
  std::optional<double> pose_rate{};          ///< [Hz]
  std::optional<double> joint_rate{};         ///< [Hz]
  std::optional<double> observation_rate{};   ///< [Hz]
  std::vector<std::string> robots{};          ///< selectors of robots whose observations are recorded
  std::optional<double> snapshot_interval{};  ///< [s]
  bool makes_rosbag2 = false;                 ///< the folder of the recording becomes a bag (write_rosbag2_metadata)
};

struct RunCommand {
  std::vector<std::filesystem::path> files;  ///< experiments, in order
  bool runs_xacro = false;                   ///< expand xacro files among them
  std::uint64_t repeat = 1;                  ///< number of repetitions of all files
  unsigned threads = 0;                      ///< 0: one for each core
  std::optional<double> duration;
  std::optional<std::uint64_t> seed;
  std::vector<std::string> settings{};  ///< values that replace those of the files, as PATH=VALUE
  std::vector<std::uint64_t> seeds;   ///< run all files with each of these; empty: with `seed`
  unsigned jobs = 0;                  ///< with `seeds`: runs at once; 0: number of idle cores
  bool is_part = false;               ///< one run of several, started by SideBySide: no summary, no progress
  Controllers controllers = Controllers::process;
  std::optional<double> speed;  ///< 0: no limit; none: no limit, or real time if people drive
  Outputs outputs;
  RecordOptions record;
  bool record_or_stop = false;  ///< the run ends when its recording does
  bool ros2 = false;            ///< ROS 2 nodes drive the robots of the experiment's `ros2`
  bool quiet = false;
  bool profile = false;                      ///< print the time of each stage of a tick
  bool paused = false;                       ///< start paused
  bool view = false;                         ///< show the run in a browser
  bool view_controls = false;                ///< viewers may control the run
  std::optional<std::uint16_t> view_port{};  ///< TCP port of the page; none: chosen by `cohort view`
  bool view_opens = false;                   ///< open a browser; the run starts when the page is shown
  double keep_interval = 0.0;                ///< simulated time between kept snapshots [s]; 0: none
  std::filesystem::path from;                ///< snapshot to continue from; empty: start at the beginning
  std::vector<std::uint32_t> domains;        ///< empty: free ones, or 0 if controllers are started elsewhere
  std::string network = "127.0.0.1";
  std::filesystem::path secure;  ///< folder of identities; empty: without security
};

}  // namespace cohort::tool
