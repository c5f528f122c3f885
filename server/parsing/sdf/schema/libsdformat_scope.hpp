#pragma once

#include <mutex>
#include <new>
#include <optional>
#include <sdf/Exception.hh>
#include <sdf/ParserConfig.hh>
#include <stdexcept>
#include <string>

namespace cohort::parsing {

/// Makes libsdformat read by our rules and print nothing. Its settings are global to the process, so only one world is
/// read at a time.
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

/// Calls what uses libsdformat, and returns why it ended, or nothing if it did what it should. What libsdformat throws
/// where an assertion fails is no std::exception. Want of memory is nothing that a file is to blame for: it is thrown.
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
