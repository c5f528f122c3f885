#include "server/parsing/sdf/schema/libsdformat_scope.hpp"

#include <iostream>
#include <sdf/Console.hh>

namespace cohort::parsing {
namespace {

std::mutex& libsdformat_mutex() {
  static std::mutex mutex;
  return mutex;
}

// libsdformat writes a log in the home folder, and prints to standard error if there is none.
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
  // Otherwise a misspelt element or attribute would be ignored with a line on the console.
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
