#include <limits>

#include "tools/cohort/commands/command_lines.hpp"
#include "tools/cohort/cli/usage.hpp"

namespace cohort::tool {

void add_view_options(CLI::App& app, ViewCommand& command) {
  auto* const recording =
      app.add_option("RECORDING", command.recording, "Recording (MCAP) to show, instead of a server")->type_name("");
  app.add_option("--server", command.server, "Address of the server")
      ->envname("COHORT_SERVER")
      ->capture_default_str()
      ->type_name("ADDRESS");
  app.add_flag("--control", command.may_control, "Let whoever looks control the server")->excludes(recording);
  app.add_option("--secure-control", command.secure_control, "Folder of an identity that may control, for --control")
      ->type_name("DIR");
  app.add_option("--secure-drive", command.secure_drive,
                 "Folder of the identity that drives robots from the page (default: that of --secure-control)")
      ->type_name("DIR");
  app.add_option("--port", command.port, "Where browsers find it (default: 8080, or any free one if that is taken)")
      ->check(whole_number(0, std::numeric_limits<std::uint16_t>::max()))
      ->type_name("N");
  app.add_option("--network", command.network, "Address of the interface to serve browsers on")
      ->capture_default_str()
      ->type_name("ADDRESS");
  app.add_option("--token", command.token,
                 "What browsers have to give (default: none on the loopback, or a random one)")
      ->type_name("TEXT");
  app.add_option("--origin", command.origins, "Another page that may connect, such as https://app.foxglove.dev")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("URL[,URL...]");
  app.add_option("--threads", command.threads, "Threads that replay a recording (default: the cores)")
      ->check(whole_number(1, 1024))
      ->type_name("N");
  app.footer("Example: cohort view run.mcap");
}

}  // namespace cohort::tool
