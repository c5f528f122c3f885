#include "server/parsing/sdf/schema/libsdformat_scope.hpp"

#include <iostream>
#include <sdf/Console.hh>

namespace cohort::parsing {
namespace {

std::mutex& libsdformat_mutex() {
  static std::mutex mutex;
  return mutex;
}

// libsdformat keeps a log of its own in the home folder, and says so on standard error where there is none.
sdf::Console& console() {
  static const sdf::ConsolePtr made = [] {
    std::streambuf* const before = std::cerr.rdbuf(nullptr);
    sdf::ConsolePtr silent = sdf::Console::Instance();
    std::cerr.rdbuf(before);
    return silent;
  }();
  return *made;
}

}  // namespace

LibsdformatScope::LibsdformatScope() : lock_(libsdformat_mutex()), saved_(sdf::ParserConfig::GlobalConfig()) {
  config() = sdf::ParserConfig();
  // A misspelt element or attribute would otherwise be left out with a line on the console.
  config().SetWarningsPolicy(sdf::EnforcementPolicy::ERR);
  config().SetUnrecognizedElementsPolicy(sdf::EnforcementPolicy::ERR);
  config().SetDeprecatedElementsPolicy(sdf::EnforcementPolicy::LOG);
  console().SetQuiet(true);
}

LibsdformatScope::~LibsdformatScope() {
  config() = saved_;
  console().SetQuiet(false);
}

}  // namespace cohort::parsing
