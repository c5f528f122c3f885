#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "idl/control_messages.hpp"
#include "server/sensing/take_samples.hpp"
#include "tools/bench/measure.hpp"
#include "tools/bench/thesis.hpp"
#include "tools/cohort/cli/log.hpp"
#include "tools/cohort/running/run_options.hpp"
#include "tools/drawing/run_trace.hpp"
#include "tools/bench/lockstep/bench_client.hpp"
#include "tools/bench/lockstep/lockstep.hpp"

/// The commands of `cohort`, one file each. Every command returns the process's exit code.
namespace cohort::tool {

int run(const RunCommand& asked, Log& log, const std::atomic<bool>& stop);

struct HostCommand {
  std::string plugin;
  std::vector<std::string> robots;
  std::string server;
  std::vector<std::uint32_t> domains{};  ///< of the server; one of them is used. Empty: 0
  std::filesystem::path secure{};        ///< folder of an identity; empty: without security
  bool inline_step = false;              ///< ClientOptions
  bool for_run = false;                  ///< started by `cohort run`, whose server tells what becomes of a client
};
int host(const HostCommand& command, Log& log, const std::atomic<bool>& stop);

struct TeleopCommand {
  std::vector<std::string> robots;
  std::string server;
  std::vector<std::uint32_t> domains{};  ///< of the server; one of them is used. Empty: 0
  std::filesystem::path secure{};        ///< the same
};
int teleop(const TeleopCommand& command, Log& log, const std::atomic<bool>& stop);

int check(const std::filesystem::path& file, Log& log);

/// Log times of a recording, both in it [s].
struct RecordingPart {
  double from = 0.0;
  std::optional<double> to{};  ///< none: to the end
};

struct ReplayCommand {
  std::filesystem::path file;
  bool verify = false;  ///< compare the state of every boundary
  RecordingPart part{};
  unsigned threads = 0;  ///< 0: one for each core
  bool quiet = false;
};
struct ExportDataCommand {
  std::filesystem::path file;
  std::filesystem::path csv;   ///< folder; empty: hdf5
  std::filesystem::path hdf5;  ///< file; one of the two is not empty
  std::vector<std::string> robots;
  RecordingPart part{};
};
int export_data(const ExportDataCommand& command, Log& log);

struct PlotCommand {
  std::filesystem::path file;
  std::filesystem::path output;     ///< .svg or .png
  std::vector<std::string> what{};  ///< `speed` and channels; empty: paths
  std::vector<std::string> robots{};
  Viewpoint viewpoint = Viewpoint::above;  ///< of paths
  RecordingPart part{};
};
int plot(const PlotCommand& command, Log& log, const std::atomic<bool>& stop);

struct DiffCommand {
  std::filesystem::path first;
  std::filesystem::path second;
  bool json = false;
};
int diff(const DiffCommand& command, Log& log, const std::atomic<bool>& stop);

int replay(const ReplayCommand& command, Log& log, const std::atomic<bool>& stop);

struct ExportCommand {
  std::filesystem::path file;
  std::filesystem::path output;       ///< .sdf or .yaml
  std::optional<std::uint64_t> seed;  ///< of the populations; none: the experiment's, or 1
};
int export_world(const ExportCommand& command, Log& log);

struct SamplesCommand {
  std::filesystem::path file;  ///< model, or world whose first robot is meant
  std::string device;          ///< name of a proximity ring
  std::filesystem::path output;
  sensing::SampleGrid grid;
};
int take_samples(const SamplesCommand& command, Log& log);

/// `cohort recover`: a closed recording of what can be read of a damaged one.
struct RecoverCommand {
  std::filesystem::path file;
  std::filesystem::path output;  ///< empty: in place of `file`
};
int recover(const RecoverCommand& command, Log& log);

/// `cohort ctl`: docs/cli.md.
struct CtlCommand {
  enum class What {
    request,  ///< one, and its reply
    status,
    history,
    entities,
    save,
    load,
  };
  What what = What::request;
  wire::Request request{};
  std::string server;
  std::vector<std::uint32_t> domains{};  ///< of the server; the first is used. Empty: 0
  std::filesystem::path secure{};        ///< folder of an identity; empty: without security
  std::filesystem::path file{};          ///< of a snapshot
  std::filesystem::path model{};         ///< of what is spawned: a file, or the name of a model of the world
  std::optional<double> timeout{};       ///< [s]; none: by operation
  bool watch = false;
  bool json = false;
};
int ctl(CtlCommand command, Log& log, const std::atomic<bool>& stop);

/// `cohort record`: docs/recordings.md.
struct RecordCommand {
  RecordOptions record;
  std::string server;
  std::vector<std::uint32_t> domains{};  ///< of the server; the first is used. Empty: 0
  std::filesystem::path secure{};        ///< folder of an identity; empty: without security
};
int record(const RecordCommand& command, Log& log, const std::atomic<bool>& stop);

/// `cohort security`: docs/security.md.
struct SecurityCommand {
  enum class What { init, add, list };
  What what = What::list;
  std::filesystem::path folder;      ///< of all identities
  std::vector<std::string> clients;  ///< of init: NAME=SELECTORS
  std::string name;                  ///< of add
  std::vector<std::string> robots;   ///< of add: selectors
  bool encrypt = false;
  unsigned days = 365;
};
int security(const SecurityCommand& command, Log& log);

/// `cohort doctor`: docs/troubleshooting.md.
struct DoctorCommand {
  std::string server;  ///< empty: one on this machine
  bool expects_server = false;
  std::uint32_t domain = 0;
  std::string network = "127.0.0.1";
  std::filesystem::path secure;  ///< of all identities, or of one; empty: without security
  bool json = false;
};
int doctor(DoctorCommand command, Log& log);

/// `topic`: empty for the list of topics.
int help(const std::string& topic, Log& log);

/// `cohort view`: docs/view.md.
struct ViewCommand {
  std::filesystem::path recording;  ///< what is shown; empty: a server
  std::string server = "127.0.0.1";
  std::vector<std::uint32_t> domains{};    ///< of the server; the first of them is used. Empty: 0
  std::filesystem::path secure{};          ///< folder of an identity; empty: without security
  std::filesystem::path secure_control{};  ///< the same, of one that may control
  std::filesystem::path secure_drive{};    ///< and of one that may drive; empty: the one above
  bool may_control = false;
  std::string network = "127.0.0.1";    ///< address of the interface to serve on
  std::optional<std::uint16_t> port{};  ///< 0: any free one; none: 8080, or any free one where that is taken
  std::string token{};                  ///< that browsers have to give; empty: one is made where strangers can connect
  std::vector<std::string> origins{};   ///< of other pages that may connect
  unsigned threads = 0;                 ///< that replay a recording; 0: one for each core
};
int view(const ViewCommand& command, Log& log, const std::atomic<bool>& stop);

struct BenchCommand {
  bench::Options options;
  std::optional<bench::ThesisOptions> thesis;      ///< the thesis's tables, in place of the scenes
  std::optional<bench::LockstepOptions> lockstep;  ///< the barrier, in place of the scenes
  std::optional<bench::BenchClient> client;        ///< be one of its processes
  std::filesystem::path json;                      ///< file to write; empty: none
  std::filesystem::path svg;                       ///< the same: lockstep's graph
};
int bench(const BenchCommand& command, Log& log, const std::atomic<bool>& stop);

}  // namespace cohort::tool
