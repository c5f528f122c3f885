#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

namespace cohort::tool {

/// `cohort completion` and `cohort man-page`: what the command line tells of itself.
class PageCommands {
 public:
  /// `app` is what is told of, and has to outlive this.
  explicit PageCommands(CLI::App& app);

  std::vector<CLI::App*> apps() const { return {completion_, man_page_}; }
  /// The exit code of the one that was parsed, if one was.
  std::optional<int> run() const;

 private:
  CLI::App& app_;
  CLI::App* completion_;
  CLI::App* man_page_;
  std::string shell_;
};

}  // namespace cohort::tool
