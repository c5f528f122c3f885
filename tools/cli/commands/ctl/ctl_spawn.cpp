// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/commands/ctl/ctl_spawn.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <optional>
#include <regex>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/core/bounded_file.hpp"
#include "tools/cli/commands/ctl/ctl_errors.hpp"
#include "tools/cli/common/installed_files.hpp"

namespace cohort::tool {
namespace {

std::string text_of_file(const std::filesystem::path& file) {
  constexpr std::size_t longest = std::size_t{64} << 20U;
  return read_bounded(file, longest);
}

// Returns the first file to which the text of a model refers; empty if there is none.
std::string first_file_in(const std::string& text) {
  static const std::regex uri(R"(<uri>\s*([^<]*?)\s*</uri>|\buri:\s*([^\s,}]+))");
  std::smatch match;
  if (!std::regex_search(text, match, uri)) return "";
  return match[1].matched ? match[1] : match[2];
}

std::vector<std::string> installed_models_of_one_file() {
  std::vector<std::string> names = installed_models();
  std::erase_if(names,
                [](const std::string& name) { return !first_file_in(text_of_file(*installed_model(name))).empty(); });
  return names;
}

// Sends the text of the model file. The server has only the files of its own world, so it may not have those to which
// the text refers. `why_not_named` is the reason why the world cannot spawn the model by name; it may be empty.
void spawn_file(Control& control, Spawn what, const std::filesystem::path& file, const std::string& why_not_named) {
  const std::string model = std::exchange(what.model, "");
  what.text = text_of_file(file);
  try {
    control.spawn(what);
  } catch (const ControlError& error) {
    const std::string other_file = first_file_in(what.text);
    if (other_file.empty() || error.result != ControlResult::missing_file) throw;
    throw ControlError(
        fmt::format("'{}' cannot be spawned here: it refers to '{}', which is not a file of the server's world{}. "
                    "Models of one file that are installed with Cohort can be spawned: {}",
                    model, other_file, why_not_named.empty() ? "" : ", and " + why_not_named,
                    fmt::join(installed_models_of_one_file(), ", ")),
        error.result);
  }
}

}  // namespace

ControlReply spawn_model(Control& control, Spawn what) {
  constexpr std::string_view scheme = "model://";
  if (std::filesystem::is_regular_file(what.model)) {
    spawn_file(control, what, what.model, "");
    return control.last_reply();
  }
  if (what.model.starts_with(scheme))
    what.model.erase(0, scheme.size());
  else if (std::filesystem::path(what.model).has_extension())
    throw std::invalid_argument("there is no file '" + what.model + "'");
  try {
    control.spawn(what);
  } catch (const ControlError& error) {
    const std::optional<std::filesystem::path> file =
        may_mean(error, ControlResult::unknown_model) ? installed_model(what.model) : std::nullopt;
    if (!file) throw;
    spawn_file(control, what, *file, error.what());
  }
  return control.last_reply();
}

}  // namespace cohort::tool
