#pragma once

#include <mutex>
#include <new>
#include <optional>
#include <sdf/Exception.hh>
#include <sdf/ParserConfig.hh>
#include <stdexcept>
#include <string>

namespace cohort::parsing {

/// Makes libsdformat use the rules of Cohort and print nothing. Its settings are global to the process, so only one
/// world is read at a time.
class LibsdformatScope {
 public:
  LibsdformatScope();
  ~LibsdformatScope();
  LibsdformatScope(const LibsdformatScope&) = delete;
  LibsdformatScope& operator=(const LibsdformatScope&) = delete;

  sdf::ParserConfig& config() { return sdf::ParserConfig::GlobalConfig(); }

 private:
  std::scoped_lock<std::mutex> lock_;
  sdf::ParserConfig saved_;
};

/// Calls code that uses libsdformat, and returns the reason of a failure, or nothing. On a failed assertion,
/// libsdformat throws something that is no std::exception. Out-of-memory exceptions are passed on, since the file is
/// not their cause.
template <class Call>
std::optional<std::string> libsdformat_failure(Call&& call) {
  try {
    call();
    return std::nullopt;
  } catch (const sdf::Exception& error) {
    return error.GetErrorStr();
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    return error.what();
  }
}

}  // namespace cohort::parsing
